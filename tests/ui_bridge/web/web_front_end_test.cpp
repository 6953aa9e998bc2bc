// Conversations led over HTTP alone: every endpoint, several pages, stops, restarts, scanning by
// the page, settings on trial.
#include "services/ui_bridge/web/web_front_end.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/draws.h"
#include "tests/ui_bridge/web/http_client.h"
#include "tests/ui_bridge/web/web_system.h"

namespace beckon::ui_bridge::web {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

bool HasQuestion(const Json& state) { return state["query"].is_object(); }
bool IsOpen(const Json& state) { return HasQuestion(state) && !state["query"]["answered"]; }

class WebFrontEndTest : public ::testing::Test {
 protected:
  int port() const { return system_.port(); }
  Reply Post(const std::string& path, const Json& body) { return Send(port(), "POST", path, body); }
  Reply Answer(const Json& state, int option) {
    return Post("/api/answer", {{"query_id", state["query"]["id"]}, {"option", option}});
  }
  Reply Request(const std::string& request) { return Post("/api/request", {{"request", request}}); }
  Reply Try(const Json& settings) {
    return Send(port(), "PUT", "/api/settings", {{"settings", settings}});
  }
  Json State() { return Get(port(), "/api/state").json(); }
  std::vector<msg::SessionKind> Requests() {
    std::vector<msg::SessionKind> kinds;
    system_.InLoop([&] {
      for (const auto& request : system_.intention().requests) kinds.push_back(request.kind);
    });
    return kinds;
  }
  int Starts() {
    int starts = 0;
    system_.InLoop([&] { starts = system_.intention().starts; });
    return starts;
  }

  WebSystem system_;
};

TEST_F(WebFrontEndTest, LeadsAWholeSession) {
  Stream page(port(), "?view=user");
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(page.Until(IsOpen));
    EXPECT_EQ(page.state()["phase"], "running");
    EXPECT_EQ(Answer(page.state(), i % 2).status, 200);
    const Json id = page.state()["query"]["id"];
    ASSERT_TRUE(
        page.Until([&](const Json& s) { return !HasQuestion(s) || s["query"]["id"] != id; }));
  }
  ASSERT_TRUE(page.Until([](const Json& s) { return s["event"]["kind"] == "confirmed"; }));
  ASSERT_TRUE(page.Until([](const Json& s) { return s["task"].is_object(); }));
  EXPECT_EQ(page.state()["task"]["category"], "Carton");
  EXPECT_EQ(page.state()["phase"], "idle");
  system_.InLoop([&] {
    msg::TaskStatus status;
    status.utime = SystemClock().Now();
    status.task_id = system_.intention().event.session_id;
    status.state = msg::TaskState::kRunning;
    ASSERT_TRUE(system_.bus().Publish(status));
    ASSERT_EQ(system_.intention().answers.size(), 3u);
    EXPECT_EQ(system_.intention().answers[0].likelihoods, (std::vector<double>{1, 0}));
    EXPECT_EQ(system_.intention().answers[1].likelihoods, (std::vector<double>{0, 1}));
    EXPECT_EQ(system_.intention().answers[0].device, "desk");
  });
  EXPECT_TRUE(page.Until([](const Json& s) { return s["task"]["state"] == "running"; }));
  EXPECT_EQ(Starts(), 1);
  EXPECT_EQ(Request("start").status, 200);
  EXPECT_TRUE(page.Until(IsOpen));
  EXPECT_TRUE(page.state()["task"].is_null());
  EXPECT_EQ(Starts(), 2);
}

TEST_F(WebFrontEndTest, BeginsOneSessionForAPageThatIsLoadedAndNoneForOneThatComesBackOrOnlyLooks) {
  Stream partner(port(), "?view=partner");
  Stream again(port(), "?view=user&again=1");
  ASSERT_TRUE(partner.Until([](const Json& s) { return s["user"] == "ann"; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(600));  // longer than the dialogue listens
  EXPECT_EQ(Starts(), 0) << "that nothing happens has no event";
  Stream page(port(), "?view=user");
  ASSERT_TRUE(page.Until(IsOpen, 1.0)) << "the first question within a second";
  Stream second(port(), "?view=user");
  ASSERT_TRUE(second.Until(IsOpen));
  EXPECT_EQ(second.state()["query"]["id"], page.state()["query"]["id"]);
  EXPECT_EQ(Starts(), 1);
}

TEST_F(WebFrontEndTest, TakesTheFirstOfTwoPagesAnswers) {
  Stream first(port(), "?view=user"), second(port(), "?view=user");
  ASSERT_TRUE(first.Until(IsOpen));
  ASSERT_TRUE(second.Until(IsOpen));
  const Json state = second.state();
  system_.InLoop([&] { system_.intention().deaf = true; });
  EXPECT_EQ(Answer(state, 0).status, 200);
  const Reply late = Answer(state, 1);
  EXPECT_EQ(late.status, 409);
  EXPECT_EQ(late.json()["reason"], "answered");
  EXPECT_TRUE(second.Until([](const Json& s) { return HasQuestion(s) && s["query"]["answered"]; }));
  system_.InLoop([&] { system_.intention().deaf = false; });
  ASSERT_TRUE(
      second.Until([&](const Json& s) { return s["query"]["id"] != state["query"]["id"]; }));
  const Reply stale = Answer(state, 1);
  EXPECT_EQ(stale.status, 409);
  EXPECT_EQ(stale.json()["reason"], "stale");
  system_.InLoop([&] {
    ASSERT_EQ(system_.intention().answers.size(), 1u);
    EXPECT_EQ(system_.intention().answers[0].likelihoods, (std::vector<double>{1, 0}));
  });
}

TEST_F(WebFrontEndTest, StopsAtAnyMomentAndResumesOnlyWhenThatIsConfirmed) {
  Stream page(port(), "?view=user");
  ASSERT_TRUE(page.Until(IsOpen));
  EXPECT_EQ(Request("resume").status, 400);
  EXPECT_EQ(Post("/api/request", {{"request", "resume"}, {"confirm", true}}).status, 409);
  EXPECT_EQ(Request("stop").status, 200);
  ASSERT_TRUE(page.Until([](const Json& s) { return s["stopped"] == true; }));
  EXPECT_FALSE(HasQuestion(page.state()));
  EXPECT_EQ(page.state()["stopping"], false);
  for (const char* request : {"start", "undo", "none_of_these", "cancel"})
    EXPECT_EQ(Request(request).status, 409) << request;
  EXPECT_EQ(Request("stop").status, 200) << "again, to be sure";
  Stream another(port(), "?view=user");
  ASSERT_TRUE(another.Until([](const Json& s) { return s["stopped"] == true; }));
  EXPECT_EQ(Request("resume").status, 400);
  EXPECT_EQ(Post("/api/request", {{"request", "resume"}, {"confirm", "yes"}}).status, 400);
  EXPECT_EQ(Post("/api/request", {{"request", "resume"}, {"confirm", true}}).status, 200);
  ASSERT_TRUE(page.Until([](const Json& s) { return s["phase"] == "idle"; }));
  EXPECT_EQ(Starts(), 1) << "what was stopped does not begin by itself";
}

TEST_F(WebFrontEndTest, SendsAStopWhileIntentionIsAwayAndSaysThatItIsOnItsWay) {
  Stream page(port(), "?view=user");
  ASSERT_TRUE(page.Until(IsOpen));
  int stops = 0;
  system_.InLoop([&] {
    system_.intention().deaf = true;
    system_.bus().Subscribe<msg::Session>([&stops](const msg::Session& request) {
      if (request.kind == msg::SessionKind::kRequestStop) ++stops;
    });
  });
  EXPECT_EQ(Request("stop").status, 200);
  EXPECT_TRUE(page.Until([](const Json& s) { return s["stopping"] == true; }));
  EXPECT_TRUE(system_.Until([&] { return stops >= 2; })) << "it is repeated";
  EXPECT_EQ(Post("/api/request", {{"request", "resume"}, {"confirm", true}}).status, 409);
  ASSERT_TRUE(page.Until([](const Json& s) { return s["intention_silent"] == true; }, 8));
  system_.InLoop([&] { system_.intention().deaf = false; });
  EXPECT_TRUE(page.Until([](const Json& s) {
    return s["stopped"] == true && s["intention_silent"] == false && s["notice"] == "";
  }));
}

TEST_F(WebFrontEndTest, UndoesAndRefuses) {
  Stream page(port(), "?view=user");
  ASSERT_TRUE(page.Until(IsOpen));
  EXPECT_EQ(Answer(page.state(), 0).status, 200);
  ASSERT_TRUE(page.Until(
      [](const Json& s) { return HasQuestion(s) && s["query"]["questions_asked"] == 1; }));
  EXPECT_EQ(Request("undo").status, 200);
  ASSERT_TRUE(
      page.Until([](const Json& s) { return IsOpen(s) && s["query"]["questions_asked"] == 0; }));
  EXPECT_EQ(Request("none_of_these").status, 200);
  EXPECT_TRUE(system_.Until([&] {
    return system_.intention().requests.back().kind == msg::SessionKind::kRequestNoneOfThese;
  }));
  EXPECT_EQ(Request("cancel").status, 200);
  ASSERT_TRUE(page.Until([](const Json& s) { return s["event"]["kind"] == "abandoned"; }));
}

TEST_F(WebFrontEndTest, GoesOnAfterARestartOfItsOwn) {
  Json before;
  {
    Stream page(port(), "?view=user");
    ASSERT_TRUE(page.Until(IsOpen));
    before = page.state();
    system_.StopBridge();
    while (page.Next()) {
    }
  }
  EXPECT_EQ(Get(port(), "/").status, 0) << "nobody is there";
  system_.StartBridge();
  Stream page(port(), "?view=user&again=1");
  ASSERT_TRUE(page.Until(IsOpen));
  EXPECT_EQ(page.state()["query"]["id"], before["query"]["id"]);
  EXPECT_EQ(Answer(page.state(), 0).status, 200);
  EXPECT_TRUE(page.Until(
      [&](const Json& s) { return HasQuestion(s) && s["query"]["questions_asked"] == 1; }));
  EXPECT_EQ(Starts(), 1);
}

TEST_F(WebFrontEndTest, BeginsAgainAfterARestartOfIntention) {
  Stream page(port(), "?view=user");
  ASSERT_TRUE(page.Until(IsOpen));
  const Json id = page.state()["query"]["id"];
  system_.InLoop([&] { system_.intention().Forget(); });
  ASSERT_TRUE(page.Until([&](const Json& s) { return IsOpen(s) && s["query"]["id"] != id; }));
  EXPECT_EQ(Answer(page.state(), 0).status, 200);
  EXPECT_EQ(Starts(), 2);
}

TEST_F(WebFrontEndTest, ChangesTheUserAndTheirSettings) {
  Stream page(port(), "?view=user");
  ASSERT_TRUE(page.Until(IsOpen));
  ASSERT_EQ(Try({{"theme", "dark"}}).status, 200);
  ASSERT_EQ(Post("/api/settings/keep", Json::object()).status, 200);
  for (const char* wrong : {"", "an n", "../x"})
    EXPECT_EQ(Post("/api/user", {{"user", wrong}}).status, 400) << wrong;
  EXPECT_EQ(Post("/api/user", {{"user", "bob"}}).status, 200);
  ASSERT_TRUE(page.Until([](const Json& s) { return s["user"] == "bob"; }));
  EXPECT_EQ(Get(port(), "/api/settings").json()["settings"]["theme"], "auto");
  EXPECT_EQ(Get(port(), "/api/profile").json()["user"], "bob");
  EXPECT_THAT(Requests(), Contains(msg::SessionKind::kRequestCancel));
  EXPECT_EQ(Request("start").status, 200);
  ASSERT_TRUE(page.Until(IsOpen));
  EXPECT_EQ(Post("/api/user", {{"user", "ann"}}).status, 200);
  ASSERT_TRUE(page.Until([](const Json& s) { return s["user"] == "ann"; }));
  EXPECT_EQ(Get(port(), "/api/settings").json()["settings"]["theme"], "dark");
}

TEST_F(WebFrontEndTest, ShowsThePast) {
  Stream page(port(), "?view=user");
  ASSERT_TRUE(system_.Until([&] {
    for (const auto& request : system_.intention().requests) {
      if (request.kind == msg::SessionKind::kRequestProfile) return true;
    }
    return false;
  }));
  const Json rev = State()["profile_rev"];
  system_.InLoop([&] {
    msg::Profile profile{.utime = 1, .user = "ann", .users = {"ann", "bob"}, .n_sessions = 1};
    profile.recent = {{.utime = 1, .action = "Open", .category = "Can", .questions = 3}};
    ASSERT_TRUE(system_.bus().Publish(profile));
  });
  ASSERT_TRUE(page.Until([&](const Json& s) { return s["profile_rev"] != rev; }));
  const Json profile = Get(port(), "/api/profile").json();
  EXPECT_EQ(profile["users"], Json::parse(R"(["ann", "bob"])"));
  EXPECT_EQ(profile["recent"][0]["category"], "Can");
}

TEST_F(WebFrontEndTest, ShowsWhatTheCameraSees) {
  EXPECT_EQ(Get(port(), "/api/frame").status, 404);
  Stream page(port(), "?view=partner");
  EXPECT_TRUE(State()["scene"].is_null());
  system_.InLoop([&] {
    msg::Scene scene{.utime = 1, .seq = 4, .frame_seq = 9, .width = 640, .height = 480};
    scene.intrinsics = {525, 525, 319.5, 239.5};
    scene.source = "test";
    const auto sent = system_.bus().Publish(scene);
    ASSERT_TRUE(sent) << sent.error().message;
  });
  ASSERT_TRUE(page.Until([](const Json& s) { return s["scene"].is_object(); }));
  EXPECT_EQ(page.state()["scene"]["seq"], 4);
}

TEST_F(WebFrontEndTest, PointsToWhatAnotherFrontEndOfTheUserScans) {
  Stream page(port(), "?view=partner");
  const auto scan = [&](const std::string& user, int option) {
    system_.InLoop([&] {
      msg::Highlight highlight{.utime = 1, .device = "switch@desk", .user = user, .query_id = 5};
      highlight.options = {option};
      ASSERT_TRUE(system_.bus().Publish(highlight));
    });
  };
  scan("bob", 0);
  scan("ann", 1);
  ASSERT_TRUE(page.Until([](const Json& s) { return s["highlight"].is_object(); }));
  EXPECT_EQ(page.state()["highlight"]["options"], Json::parse("[1]"));
  EXPECT_EQ(page.state()["scanning"], false);
  EXPECT_TRUE(page.Until([](const Json& s) { return s["highlight"].is_null(); }, 8))
      << "who no longer says so no longer points";
}

TEST_F(WebFrontEndTest, IsScannedWithTheSwitchOfThePage) {
  EXPECT_EQ(Post("/api/press", {{"switch", 0}, {"down", true}}).status, 409);
  Json settings = {{"access", "one_switch"}};
  settings["scan"] = {{"scan_time_s", 0.3}, {"first_item_delay_s", 0}, {"ignore_repeat_s", 0.05}};
  Stream page(port(), "?view=user");
  ASSERT_EQ(Try(settings).status, 200);
  const auto press = [&] {
    EXPECT_EQ(Post("/api/press", {{"switch", 0}, {"down", true}}).status, 200);
    EXPECT_EQ(Post("/api/press", {{"switch", 0}, {"down", true}}).status, 200) << "key repeat";
    EXPECT_EQ(Post("/api/press", {{"switch", 0}, {"down", false}}).status, 200);
  };
  const auto lit = [](const char* key, const Json& what) {
    return [=](const Json& s) { return s["highlight"].is_object() && s["highlight"][key] == what; };
  };
  for (const char* name : {"keep", "revert", "keep"})  // at once it would be too soon to be meant
    ASSERT_TRUE(page.Until(lit("controls", Json::array({name}))));
  press();
  ASSERT_TRUE(page.Until([](const Json& s) { return s["settings_trial"].is_null(); }));
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(page.Until(IsOpen));
    EXPECT_EQ(page.state()["scanning"], true);
    const Json id = page.state()["query"]["id"];
    ASSERT_TRUE(page.Until(lit("options", Json::parse("[1]"))));
    press();
    ASSERT_TRUE(
        page.Until([&](const Json& s) { return !HasQuestion(s) || s["query"]["id"] != id; }));
  }
  ASSERT_TRUE(page.Until([](const Json& s) { return s["event"]["kind"] == "confirmed"; }));
  system_.InLoop([&] {
    ASSERT_EQ(system_.intention().answers.size(), 3u);
    for (const auto& answer : system_.intention().answers)
      EXPECT_EQ(answer.likelihoods, (std::vector<double>{0, 1}));
    EXPECT_GE(system_.intention().highlights.size(), 6u) << "for other screens";
  });
  EXPECT_TRUE(system_.Until(
      [&] { return system_.intention().interfaces.back().kind == msg::InterfaceKind::kScan; }));
}

TEST_F(WebFrontEndTest, StopsByHoldingTheSwitchOfThePage) {
  Json settings = {{"access", "one_switch"}, {"scan", {{"stop_hold_s", 0.5}}}};
  Stream page(port(), "?view=user");
  ASSERT_EQ(Try(settings).status, 200);
  ASSERT_EQ(Post("/api/settings/keep", Json::object()).status, 200);
  ASSERT_TRUE(page.Until(IsOpen));
  ASSERT_EQ(Post("/api/press", {{"switch", 0}, {"down", true}}).status, 200);
  ASSERT_TRUE(page.Until([](const Json& s) { return s["stopped"] == true; }));
  ASSERT_EQ(Post("/api/press", {{"switch", 0}, {"down", false}}).status, 200);
  EXPECT_TRUE(page.Until([](const Json& s) {
    return s["highlight"].is_object() && s["highlight"]["controls"] == Json::parse(R"(["resume"])");
  }));
}

TEST_F(WebFrontEndTest, ForgetsASwitchWhosePageIsGone) {
  Json settings = {{"access", "one_switch"}, {"scan", {{"stop_hold_s", 3}}}};
  {
    Stream page(port(), "?view=user");
    ASSERT_EQ(Try(settings).status, 200);
    ASSERT_EQ(Post("/api/settings/keep", Json::object()).status, 200);
    ASSERT_EQ(Post("/api/press", {{"switch", 0}, {"down", true}}).status, 200);
    ASSERT_TRUE(page.Until([](const Json& s) {
      return s["highlight"].is_object() && s["highlight"]["pressed"] == true;
    }));
  }
  EXPECT_TRUE(system_.Until([&] { return !system_.intention().highlights.back().pressed; }));
}

TEST_F(WebFrontEndTest, TriesSettingsAndKeepsThemOverARestart) {
  Stream page(port(), "?view=partner");
  const Json rev = State()["settings_rev"];
  EXPECT_EQ(Try({{"text_percent", 175}}).status, 200);
  ASSERT_TRUE(page.Until([&](const Json& s) { return s["settings_rev"] != rev; }));
  EXPECT_EQ(page.state()["settings_trial"]["seconds_left"], 20);
  const Json reply = Get(port(), "/api/settings").json();
  EXPECT_EQ(reply["settings"]["text_percent"], 175);
  EXPECT_EQ(reply["presets"].size(), 5u);
  EXPECT_EQ(Post("/api/settings/keep", Json::object()).status, 200);
  EXPECT_EQ(Post("/api/settings/keep", Json::object()).status, 409);
  system_.StopBridge();
  system_.StartBridge();
  EXPECT_EQ(Get(port(), "/api/settings").json()["settings"]["text_percent"], 175);
}

TEST_F(WebFrontEndTest, ForgetsSettingsOnTrialInARestart) {
  EXPECT_EQ(Try({{"text_percent", 175}}).status, 200);
  system_.StopBridge();
  system_.StartBridge();
  EXPECT_EQ(Get(port(), "/api/settings").json()["settings"]["text_percent"], 100);
}

TEST_F(WebFrontEndTest, ChangesNothingForWrongSettingsAndSaysWhich) {
  const Reply reply = Try({{"scan", {{"rounds", -1}}}});
  EXPECT_EQ(reply.status, 400);
  EXPECT_THAT(reply.json()["error"].get<std::string>(), HasSubstr("'scan.rounds'"));
  EXPECT_TRUE(State()["settings_trial"].is_null());
}

TEST_F(WebFrontEndTest, UsesTheUsualSettingsWhereTheFileIsTornAndSaysSo) {
  Try({{"text_percent", 175}});
  Post("/api/settings/keep", Json::object());
  system_.InLoop([&] { system_.front_end().FlushSettings(); });
  system_.StopBridge();
  std::ofstream(system_.folder().data() + "/ann.json") << "{\"theme\": \"da";
  system_.StartBridge();
  EXPECT_EQ(Get(port(), "/api/settings").json()["settings"]["text_percent"], 100);
  EXPECT_THAT(State()["notice"].get<std::string>(), HasSubstr("settings could not be read"));
}

TEST_F(WebFrontEndTest, ServesThePageAndNothingElse) {
  const Reply page = Get(port(), "/");
  EXPECT_EQ(page.status, 200);
  EXPECT_THAT(page.body, HasSubstr("<title>page"));
  EXPECT_THAT(page.headers.at("content-security-policy"), HasSubstr("default-src 'none'"));
  EXPECT_EQ(Ask(port(), "GET", "/", {{"If-None-Match", page.headers.at("etag")}}).status, 304);
  for (const char* path :
       {"/index.html", "/../data/ann.json", "/..%2fdata%2fann.json", "/%2e%2e/data/ann.json",
        "//etc/passwd", "/main.js/", "/main.js%00.html", "/./main.js", "/api", "/api/",
        "/api/state/", "/etc/passwd", "/\\..\\data", "/data/ann.json"})
    EXPECT_EQ(Get(port(), path).status, 404) << path;
}

TEST_F(WebFrontEndTest, TakesEachRequestByItsMethodOnly) {
  for (const char* path : {"/", "/api/state", "/api/frame", "/api/profile", "/api/events"}) {
    const Reply reply = Send(port(), "POST", path, Json::object());
    EXPECT_EQ(reply.status, 405) << path;
    EXPECT_EQ(reply.headers.at("allow"), "GET, HEAD");
  }
  for (const char* path : {"/api/answer", "/api/request", "/api/press", "/api/user"})
    EXPECT_EQ(Get(port(), path).status, 405) << path;
  EXPECT_EQ(Ask(port(), "DELETE", "/api/settings").headers.at("allow"), "GET, HEAD, PUT");
  EXPECT_EQ(Ask(port(), "OPTIONS", "/api/request").status, 405) << "no other site is let in";
}

TEST_F(WebFrontEndTest, RefusesBodiesThatMeanNothing) {
  const struct {
    const char* path;
    const char* body;
  } cases[] = {
      {"/api/answer", ""},
      {"/api/answer", "[]"},
      {"/api/answer", "{"},
      {"/api/answer", "{}"},
      {"/api/answer", "\xff"},
      {"/api/answer", R"({"query_id": "1", "option": 0})"},
      {"/api/answer", R"({"query_id": 1.5, "option": 0})"},
      {"/api/answer", R"({"query_id": 18446744073709551615, "option": 0})"},
      {"/api/answer", R"({"query_id": 1e999, "option": 0})"},
      {"/api/answer", R"({"query_id": 1, "option": null})"},
      {"/api/request", R"({"request": 1})"},
      {"/api/request", R"({"request": "fly"})"},
      {"/api/request", R"({"request": "profile"})"},
      {"/api/press", R"({"switch": 2, "down": true})"},
      {"/api/press", R"({"switch": 0, "down": 1})"},
      {"/api/press", R"({"switch": 0})"},
      {"/api/user", R"({"user": 1})"},
      {"/api/user", R"({"user": "a b"})"},
  };
  for (const auto& [path, body] : cases) {
    const Reply reply = Ask(port(), "POST", path, {{"Content-Type", "application/json"}}, body);
    EXPECT_EQ(reply.status, 400) << path << ' ' << body;
    EXPECT_TRUE(reply.json()["error"].is_string());
  }
  const std::string deep = std::string(8000, '[') + std::string(8000, ']');
  EXPECT_EQ(Ask(port(), "POST", "/api/user", {{"Content-Type", "application/json"}},
                "{\"user\": " + deep + "}")
                .status,
            400);
  EXPECT_EQ(Ask(port(), "POST", "/api/request", {{"Content-Type", "text/plain"}},
                R"({"request": "stop"})")
                .status,
            415);
  EXPECT_EQ(Ask(port(), "POST", "/api/request", {}, R"({"request": "stop"})").status, 415);
  EXPECT_THAT(Requests(), Each(::testing::Ne(msg::SessionKind::kRequestStop)));
}

TEST_F(WebFrontEndTest, RefusesOtherSitesAndNames) {
  const HeaderList json = {{"Content-Type", "application/json"}};
  const std::string stop = R"({"request": "stop"})";
  auto headers = json;
  headers.emplace_back("Origin", "http://evil.example");
  EXPECT_EQ(Ask(port(), "POST", "/api/request", headers, stop).status, 403);
  headers = json;
  headers.emplace_back("Host", "evil.example");
  EXPECT_EQ(Ask(port(), "POST", "/api/request", headers, stop).status, 421);
  EXPECT_EQ(Ask(port(), "GET", "/api/events?view=user", {{"Sec-Fetch-Site", "cross-site"}}).status,
            403);
  EXPECT_EQ(Starts(), 0);
  headers = json;
  headers.emplace_back("Origin", "http://127.0.0.1:" + std::to_string(port()));
  EXPECT_EQ(Ask(port(), "POST", "/api/request", headers, stop).status, 200);
}

TEST(WebTrial, GoesBackToTheEarlierSettingsByItself) {
  WebSystem system({}, /*trial_s=*/0.3);
  Stream page(system.port(), "?view=user");
  ASSERT_TRUE(page.Until([](const Json& s) { return s["settings_trial"].is_null(); }));
  const Json before = page.state()["settings_rev"];
  ASSERT_EQ(Send(system.port(), "PUT", "/api/settings",
                 {{"settings", {{"access", "one_switch"}, {"scan", {{"scan_time_s", 0.2}}}}}})
                .status,
            200);
  ASSERT_TRUE(page.Until([](const Json& s) { return s["scanning"] == true; }));
  const Json during = page.state()["settings_rev"];
  EXPECT_NE(during, before);
  ASSERT_TRUE(page.Until([](const Json& s) { return s["settings_trial"].is_null(); }, 10));
  EXPECT_EQ(page.state()["scanning"], false);
  EXPECT_NE(page.state()["settings_rev"], during);
  EXPECT_EQ(Get(system.port(), "/api/settings").json()["settings"]["access"], "pointer");
}

TEST(WebToken, OpensThePageAndEverythingElseStaysClosed) {
  WebSystem system({.loopback = false, .token = "00112233445566778899aabbccddeeff", .cookie = "b"});
  for (const char* path : {"/", "/main.js", "/api/state", "/api/events", "/api/frame", "/?token=x"})
    EXPECT_EQ(Get(system.port(), path).status, 401) << path;
  EXPECT_EQ(Send(system.port(), "POST", "/api/request", {{"request", "start"}}).status, 401);
  const Reply reply = Get(system.port(), "/?token=00112233445566778899aabbccddeeff");
  EXPECT_EQ(reply.status, 302);
  EXPECT_EQ(reply.headers.at("location"), "/");
  const std::string cookie = reply.headers.at("set-cookie").substr(0, 34);
  EXPECT_EQ(Ask(system.port(), "GET", "/", {{"Cookie", cookie}}).status, 200);
  EXPECT_EQ(Ask(system.port(), "GET", "/api/state", {{"Cookie", cookie}}).status, 200);
}

/// Any request to any endpoint: an answer of the kind that was promised, and a stop still works.
TEST_F(WebFrontEndTest, IsSoundForAnyRequest) {
  Stream page(port(), "?view=user");
  ASSERT_TRUE(page.Until(IsOpen));
  static const std::string kMethods[] = {"GET", "POST", "PUT", "PATCH", "DELETE"};
  static const std::string kPaths[] = {
      "/api/answer",        "/api/press",   "/api/user",  "/api/settings",
      "/api/settings/keep", "/api/profile", "/api/frame", "/"};
  static const std::string kValues[] = {"null",
                                        "true",
                                        "-1",
                                        "0",
                                        "1",
                                        "1e400",
                                        "\"ann\"",
                                        "{}",
                                        "[[]]",
                                        "\"\\ud800\"",
                                        "\"one_switch\"",
                                        "{\"access\":\"gaze\"}"};
  static const std::string kKeys[] = {"query_id", "option", "switch", "down", "user", "settings"};
  for (unsigned round = 0; round < 1000; ++round) {
    Draws draws(round);
    std::string body = "{";
    for (int i = draws.Between(0, 3); i > 0; --i)
      body += (body.size() > 1 ? "," : "") + ("\"" + draws.Any(kKeys) + "\":") + draws.Any(kValues);
    body += draws.OneIn(10) ? "" : "}";
    if (draws.OneIn(10)) body[draws.Index(body.size())] = static_cast<char>(draws());
    const Reply reply = Ask(port(), draws.Any(kMethods), draws.Any(kPaths),
                            {{"Content-Type", "application/json"}, {"Connection", "close"}}, body);
    ASSERT_TRUE(reply.status >= 200 && reply.status < 500) << round << ' ' << body;
  }
  EXPECT_EQ(Request("stop").status, 200);
  EXPECT_TRUE(page.Until([](const Json& s) { return s["stopped"] == true; }));
}

}  // namespace
}  // namespace beckon::ui_bridge::web
