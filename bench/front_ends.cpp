// What the same ten intentions take at each front end: the real intention service and the real
// front end on an in-process bus, and a hand in the person's place. Wall-clock time: speech is
// spoken, a scan is waited for.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <variant>

#include "services/base/app.h"
#include "services/intention/service.h"
#include "services/ui_bridge/service.h"
#include "services/ui_bridge/simulated_user.h"
#include "tests/ui_bridge/conformance/hands.h"

namespace {

using namespace beckon;
using ui_bridge::conformance::Hand;

constexpr Utime kScenePeriod = kSecond / 5;
constexpr Utime kNotice_us = kSecond / 2;
constexpr double kGiveUp_s = 180;  // an intention

struct Intention {
  const char* action;
  const char* category;
};
/// A day: some things again and again, some once.
constexpr Intention kIntentions[] = {{"Open", "Carton"}, {"Drink", "Mug"},   {"Open", "Carton"},
                                     {"Grasp", "Bowl"},  {"Pour", "Bottle"}, {"Drink", "Mug"},
                                     {"Move", "Box"},    {"Open", "Carton"}, {"Squeeze", "Tube"},
                                     {"Drink", "Mug"}};

struct Thing {
  const char* category;
  double x, y;  // m, in W
};
constexpr Thing kTable[] = {{"Carton", 0, .5},  {"Mug", .2, .4},    {"Mug", -.2, .6},
                            {"Bowl", -.1, .35}, {"Bottle", .3, .6}, {"Box", -.3, .5},
                            {"Tube", .1, .7},   {"Can", -.35, .7}};

struct Session {
  bool right = false;
  int questions = 0;
  double seconds = 0;  // from asking for it to the task
};

/// One front end through all intentions.
class Day {
 public:
  Day(std::unique_ptr<Hand> hand, double think_s) : hand_(std::move(hand)), think_s_(think_s) {}

  Result<std::vector<Session>> Live() {
    loop_.AddFd(bus_->fd(), [this] { bus_->HandleReadable(); });
    Listen();
    const auto folder =
        std::filesystem::temp_directory_path() / ("beckon-front-ends-" + std::to_string(getpid()));
    intention::ServiceConfig config;
    config.db = (folder / (hand_->front_end() + ".db")).string();
    std::filesystem::remove_all(folder);
    intention::FillDefaults(config);
    auto intention = intention::Service::Start(config, *bus_, loop_, clock_);
    if (!intention) return intention.error();
    if (auto begun = BeginFrontEnd(); !begun) return begun.error();
    NextIntention();
    loop_.Every(kScenePeriod, [this] { ShowScene(); });
    loop_.Run();
    bridge_.reset();
    std::filesystem::remove_all(folder);
    if (!failure_.empty()) return Error{hand_->front_end() + ": " + failure_};
    return sessions_;
  }

  const msg::Interface& interface() const { return interface_; }

 private:
  Status BeginFrontEnd() {
    for (auto& factory : ui_bridge::MakeFrontEndFactories()) {
      if (factory->name() == hand_->front_end()) factory_ = std::move(factory);
    }
    if (!factory_) return Error{"there is no front end " + hand_->front_end()};
    CLI::App app;
    factory_->AddOptions(app);
    auto flags = hand_->flags();
    std::ranges::reverse(flags);
    app.parse(flags);
    auto config = ConfigTable::Parse(hand_->config(), "hand");
    if (!config) return config.error();
    factory_->Configure(config->Section(hand_->front_end()));
    if (auto right = config->Finish(); !right) return right;
    device_ = ui_bridge::DefaultDevice(hand_->front_end());
    bridge_ = std::make_unique<ui_bridge::Service>(
        ui_bridge::ServiceConfig{.user = "ann", .device = device_, .listen_us = 50'000}, *bus_,
        loop_, clock_, steady_);
    if (auto added = bridge_->Add(*factory_); !added) return added;
    bridge_->Begin();
    bus_->Subscribe<msg::Query>([this](const msg::Query& query) { OnQuery(query); });
    hand_->Begin({.bus = *bus_, .loop = loop_, .device = device_});
    return {};
  }

  void Listen() {
    bus_->Subscribe<msg::Interface>([this](const msg::Interface& i) { interface_ = i; });
    bus_->Subscribe<msg::Task>([this](const msg::Task& task) {
      if (task.task_id == last_task_) return;
      last_task_ = task.task_id;
      OnTask(task);
    });
  }

  void NextIntention() {
    if (sessions_.size() == std::size(kIntentions)) return loop_.Stop();
    const Intention& wanted = kIntentions[sessions_.size()];
    user_ = std::make_unique<ui_bridge::SimulatedUser>(
        ui_bridge::SimulatedUserConfig{.action = wanted.action, .category = wanted.category});
    ShowScene();
    began_ = steady_.Now();
    if (give_up_) loop_.Cancel(*give_up_);
    give_up_ = loop_.After(static_cast<Utime>(kGiveUp_s * kSecond), [this, &wanted] {
      failure_ = std::string(wanted.action) + " " + wanted.category + ": no task in time";
      loop_.Stop();
    });
    // Some front ends go on by themselves; the others are told once the last task was shown.
    loop_.After(kNotice_us, [this] { hand_->Start(); });
  }

  void OnQuery(const msg::Query& query) {
    if (query.id == last_query_) return;
    last_query_ = query.id;
    loop_.After(static_cast<Utime>(think_s_ * kSecond), [this, query] {
      if (query.id != last_query_) return;
      const auto response = user_->Respond(query);
      const auto* choice = std::get_if<ui_bridge::Choose>(&response);
      // "None of these" is the last option of whatever has one.
      hand_->Choose(query, choice != nullptr ? choice->option : query.options.size() - 1);
    });
  }

  void OnTask(const msg::Task& task) {
    if (sessions_.size() == std::size(kIntentions)) return;
    const Intention& wanted = kIntentions[sessions_.size()];
    msg::TaskStatus done;
    done.utime = clock_.Now();
    done.task_id = task.task_id;
    done.state = msg::TaskState::kDone;
    (void)bus_->Publish(done);
    sessions_.push_back({.right = task.action == wanted.action &&
                                  task.object.category == wanted.category &&
                                  task.object.instance == 1,
                         .questions = task.questions,
                         .seconds = static_cast<double>(steady_.Now() - began_) / kSecond});
    NextIntention();
  }

  void ShowScene() {
    msg::Scene scene;
    scene.utime = clock_.Now();
    scene.seq = scene.frame_seq = ++scenes_;
    scene.source = "bench";
    scene.width = 640;
    scene.height = 480;
    scene.has_table = true;
    for (const Thing& thing : kTable) {
      msg::SceneObject object;
      object.id = static_cast<int>(scene.objects.size()) + 1;
      object.category = thing.category;
      object.confidence = 0.95f;
      object.probabilities = {{thing.category, 1.0f}};
      object.centroid_W = {thing.x, thing.y, 0.05};
      object.extent_W = {0.06, 0.06, 0.1};
      object.n_points = 100;
      scene.objects.push_back(object);
    }
    user_->SeeScene(scene);
    msg::Poses poses;
    poses.utime = scene.utime;
    poses.seq = poses.scene_seq = scene.seq;
    if (!bus_->Publish(scene) || !bus_->Publish(poses)) failure_ = "the table cannot be shown";
  }

  const std::unique_ptr<Hand> hand_;
  const double think_s_;
  SystemClock clock_;
  SteadyClock steady_;
  RunLoop loop_;
  std::unique_ptr<Bus> bus_ = std::move(*Bus::Open("memq://"));
  std::unique_ptr<ui_bridge::FrontEndFactory> factory_;
  std::unique_ptr<ui_bridge::Service> bridge_;
  std::unique_ptr<ui_bridge::SimulatedUser> user_;
  std::string device_;
  msg::Interface interface_;
  std::optional<RunLoop::TimerId> give_up_;
  int64_t scenes_ = 0;
  int64_t last_query_ = 0;
  std::string last_task_;
  Utime began_ = 0;
  std::vector<Session> sessions_;
  std::string failure_;
};

nlohmann::json Summary(const std::string& name, const msg::Interface& interface,
                       const std::vector<Session>& sessions) {
  std::vector<double> seconds;
  double sum = 0, questions = 0;
  int right = 0;
  for (const Session& session : sessions) {
    seconds.push_back(session.seconds);
    sum += session.seconds;
    questions += session.questions;
    right += session.right;
  }
  std::ranges::sort(seconds);
  const auto n = static_cast<double>(sessions.size());
  static const char* const kinds[] = {"", "yes/no", "choice", "scan", "vector"};
  return {{"front_end", name},
          {"asked_by", kinds[static_cast<int>(interface.kind)]},
          {"right", right},
          {"intentions", sessions.size()},
          {"questions_mean", questions / n},
          {"seconds_mean", sum / n},
          {"seconds_median", seconds[seconds.size() / 2]},
          {"seconds_longest", seconds.back()}};
}

struct Options {
  AppOptions app;
  std::vector<std::string> only;
  double think_s = 1.0;
  std::string json;
  std::string readme;
  std::vector<std::string> measured;
};

std::string Readme(const nlohmann::json& rows, double think_s) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1)
       << "# The same ten intentions at each front end\n\n"
          "Written by `beckon-bench-front-ends --readme FILE`. The real intention service and the "
          "real front end on an\n"
          "in-process bus, in real time, each with a memory of its own that starts empty: a "
          "carton, two mugs, a bowl, a\n"
          "bottle, a box, a tube and a can on the table; open the carton (three times), drink from "
          "the mug (three times),\n"
          "grasp the bowl, pour from the bottle, move the box, squeeze the tube.\n"
          "In the person's place is a hand that knows the right answer "
       << think_s
       << " s after the question came and never errs.\n"
          "It presses a switch 0.45 s after what it wants is lit; speaks into a FIFO in the "
          "microphone's place, without\n"
          "waiting for the end of a prompt that it knows; clicks the page at once. The decoder of "
          "brain signals takes 3 s a\n"
          "trial and gives what is meant 0.7 of four classes. Settings are the front ends' own.\n\n"
          "| front end | asked by | right | questions | s, mean | s, median | s, longest |\n"
          "|---|---|---|---|---|---|---|\n";
  for (const auto& row : rows) {
    text << "| " << row["front_end"].get<std::string>() << " | "
         << row["asked_by"].get<std::string>() << " | " << row["right"] << " of "
         << row["intentions"] << " | " << row["questions_mean"].get<double>() << " | "
         << row["seconds_mean"].get<double>() << " | " << row["seconds_median"].get<double>()
         << " | " << row["seconds_longest"].get<double>() << " |\n";
  }
  text << "\nA session counts from the task before it, half a second for asking for the next one "
          "included. Each front\n"
          "end is asked what costs *its* user the least time, so they differ in questions as "
          "well.\n";
  return text.str();
}

Status Run(const Options& options) {
  nlohmann::json all = nlohmann::json::array();
  for (const auto& file : options.measured) {
    const auto rows = nlohmann::json::parse(std::ifstream(file), nullptr, false);
    if (!rows.is_array()) return Error{"--measured " + file + ": expected what --json writes"};
    all.insert(all.end(), rows.begin(), rows.end());
  }
  const bool page_only = !options.measured.empty() && options.only.empty();
  std::fprintf(stderr, "%-22s %-8s %6s %10s %8s %8s %8s\n", "front end", "asked by", "right",
               "questions", "mean s", "median", "longest");
  for (const auto& [name, make] : ui_bridge::conformance::AllHands()) {
    if (page_only) break;
    if (!options.only.empty() && std::ranges::find(options.only, name) == options.only.end())
      continue;
    Day day(make(), options.think_s);
    auto sessions = day.Live();
    if (!sessions) return sessions.error();
    const auto row = Summary(name, day.interface(), *sessions);
    std::fprintf(stderr, "%-22s %-8s %3d/%-3zu %9.1f %8.1f %8.1f %8.1f\n", name.c_str(),
                 row["asked_by"].get<std::string>().c_str(), row["right"].get<int>(),
                 sessions->size(), row["questions_mean"].get<double>(),
                 row["seconds_mean"].get<double>(), row["seconds_median"].get<double>(),
                 row["seconds_longest"].get<double>());
    all.push_back(row);
  }
  if (!options.json.empty() && !(std::ofstream(options.json) << all.dump(1) << "\n"))
    return Error{"--json " + options.json + ": cannot be written"};
  if (!options.readme.empty() && !(std::ofstream(options.readme) << Readme(all, options.think_s)))
    return Error{"--readme " + options.readme + ": cannot be written"};
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("The same ten intentions at each front end: questions and seconds.",
               "beckon-bench-front-ends");
  Options options;
  AddAppOptions(app, options.app);
  app.add_option("--only", options.only, "These front ends alone")->type_name("NAME");
  app.add_option("--think", options.think_s, "Seconds from a question to what the person does")
      ->check(Within(0.0, 60.0));
  app.add_option("--json", options.json, "Write the figures")->type_name("OUT");
  app.add_option(
         "--measured", options.measured,
         "What --json wrote before, to be in the page; without --only nothing else is measured")
      ->type_name("JSON");
  app.add_option("--readme", options.readme, "Write them as a page")->type_name("OUT");
  return RunApp(app, argc, argv, options.app, [&] { return Run(options); });
}
