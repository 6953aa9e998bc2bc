// Who is kept out: foreign names, foreign sites, and who has no token.
#include "services/ui_bridge/web/http_guard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace beckon::ui_bridge::web {
namespace {

using ::testing::HasSubstr;

HttpRequest Request(const std::string& host, const std::string& method = "GET") {
  HttpRequest request;
  request.method = method;
  request.path = "/api/state";
  request.headers["host"] = host;
  return request;
}

/// 200 where nothing keeps it out.
int StatusOf(const HttpRequest& request, const AccessRules& rules) {
  const auto kept_out = Keep(request, rules);
  return kept_out ? kept_out->status : 200;
}

std::string HeaderOf(const HttpResponse& response, const std::string& name) {
  for (const auto& [key, value] : response.headers) {
    if (key == name) return value;
  }
  return {};
}

TEST(Guard, TakesOnlyNamesOfThisMachine) {
  const AccessRules loopback;
  for (const char* host :
       {"127.0.0.1:8765", "127.0.0.1", "localhost", "LocalHost:1", "[::1]:8765", "127.1.2.3:80"})
    EXPECT_EQ(StatusOf(Request(host), loopback), 200) << host;
  for (const char* host :
       {"", "evil.example", "evil.example:8765", "127.0.0.1.evil.example", "localhost.evil",
        "192.168.0.7:8765", "[fe80::1]:8765", "127.0.0.1:x", "127.0.0.1:8765:1", "127.0.0.1@evil",
        "127.0.0", "127.0.0.1.", "1277.0.0.1", "[::1", "kitchen:8765", "127.0.0.1:123456"})
    EXPECT_EQ(StatusOf(Request(host), loopback), 421) << host;
  EXPECT_EQ(StatusOf(HttpRequest{.method = "GET", .path = "/"}, loopback), 421);
}

TEST(Guard, TakesAddressesAndKnownNamesWhereOthersReachIt) {
  const AccessRules open{.loopback = false, .hosts = {"kitchen", "kitchen.local"}};
  for (const char* host : {"192.168.0.7:8765", "[fe80::1]:8765", "Kitchen:8765", "kitchen.local"})
    EXPECT_EQ(StatusOf(Request(host), open), 200) << host;
  for (const char* host : {"evil.example:8765", "kitchen.evil", "999x.0.0.1"})
    EXPECT_EQ(StatusOf(Request(host), open), 421) << host;
}

TEST(Guard, KeepsOtherSitesOut) {
  const AccessRules rules;
  const auto with = [](const char* name, const std::string& value) {
    HttpRequest request = Request("127.0.0.1:8765", "POST");
    request.headers[name] = value;
    return request;
  };
  EXPECT_EQ(StatusOf(with("origin", "http://127.0.0.1:8765"), rules), 200);
  for (const char* origin : {"http://127.0.0.1:8766", "http://localhost:8765", "null",
                             "http://evil.example", "http://127.0.0.1:8765.evil", "file://"})
    EXPECT_EQ(StatusOf(with("origin", origin), rules), 403) << origin;
  EXPECT_EQ(StatusOf(with("sec-fetch-site", "same-origin"), rules), 200);
  EXPECT_EQ(StatusOf(with("sec-fetch-site", "none"), rules), 200);
  EXPECT_EQ(StatusOf(with("sec-fetch-site", "cross-site"), rules), 403);
  EXPECT_EQ(StatusOf(with("sec-fetch-site", "same-site"), rules), 403);
}

TEST(Guard, LetsALinkElsewhereLeadToThePageButToNothingElse) {
  HttpRequest request = Request("127.0.0.1:8765");
  request.headers["sec-fetch-site"] = "cross-site";
  request.headers["sec-fetch-mode"] = "navigate";
  EXPECT_EQ(StatusOf(request, {}), 403);
  request.path = "/";
  EXPECT_EQ(StatusOf(request, {}), 200);
  request.method = "POST";
  EXPECT_EQ(StatusOf(request, {}), 403);
  request.method = "GET";
  request.headers["sec-fetch-mode"] = "no-cors";
  EXPECT_EQ(StatusOf(request, {}), 403);
}

TEST(Guard, AsksForTheTokenByCookieOrBearer) {
  const AccessRules rules{.loopback = false, .token = "0123456789abcdef", .cookie = "beckon_1"};
  HttpRequest request = Request("192.168.0.7");
  EXPECT_EQ(StatusOf(request, rules), 401);
  for (const char* cookie :
       {"beckon_1=", "beckon_1=wrong", "beckon_1=0123456789abcdeg", "beckon_1=0123456789abcdef0",
        "xbeckon_1=0123456789abcdef", "; ;", "beckon_2=0123456789abcdef"}) {
    request.headers["cookie"] = cookie;
    EXPECT_EQ(StatusOf(request, rules), 401) << cookie;
  }
  for (const char* cookie : {"beckon_1=0123456789abcdef", "a=b; beckon_1=0123456789abcdef; c=d"}) {
    request.headers["cookie"] = cookie;
    EXPECT_EQ(StatusOf(request, rules), 200) << cookie;
  }
  request.headers.erase("cookie");
  request.headers["authorization"] = "Bearer 0123456789abcdef";
  EXPECT_EQ(StatusOf(request, rules), 200);
  request.headers["authorization"] = "Basic 0123456789abcdef";
  EXPECT_EQ(StatusOf(request, rules), 401);
}

TEST(Guard, TradesTheTokenInTheAddressForACookie) {
  const AccessRules rules{.loopback = false, .token = "0123456789abcdef", .cookie = "beckon_1"};
  HttpRequest request = Request("192.168.0.7");
  request.path = "/";
  request.query = {{"token", "0123456789abcdef"}, {"view", "partner"}};
  const auto response = Keep(request, rules);
  ASSERT_TRUE(response);
  EXPECT_EQ(response->status, 302);
  EXPECT_EQ(HeaderOf(*response, "Location"), "/?view=partner");
  EXPECT_THAT(HeaderOf(*response, "Set-Cookie"), HasSubstr("beckon_1=0123456789abcdef;"));
  EXPECT_THAT(HeaderOf(*response, "Set-Cookie"), HasSubstr("HttpOnly; SameSite=Strict"));
  request.query["token"] = "wrong";
  EXPECT_EQ(StatusOf(request, rules), 401);
  request.query["token"] = "";
  EXPECT_EQ(StatusOf(request, rules), 401);
  request.path = "/api/state";
  request.query["token"] = "0123456789abcdef";
  EXPECT_EQ(StatusOf(request, rules), 401) << "only the page itself takes it from the address";
}

TEST(Guard, ComparesWholeSecretsAndTakesNoEmptyOne) {
  EXPECT_TRUE(SameSecret("abc", "abc"));
  for (const char* given : {"", "ab", "abcd", "abd", "Abc"}) EXPECT_FALSE(SameSecret(given, "abc"));
  EXPECT_FALSE(SameSecret("", ""));
}

TEST(Guard, TellsBrowsersToRunNothingElse) {
  HttpResponse response;
  AddSecurityHeaders(response);
  const std::string policy = HeaderOf(response, "Content-Security-Policy");
  EXPECT_THAT(policy, HasSubstr("default-src 'none'"));
  EXPECT_THAT(policy, HasSubstr("frame-ancestors 'none'"));
  EXPECT_THAT(policy, ::testing::Not(HasSubstr("unsafe")));
  EXPECT_EQ(HeaderOf(response, "X-Content-Type-Options"), "nosniff");
  EXPECT_EQ(HeaderOf(response, "Referrer-Policy"), "no-referrer");
  EXPECT_EQ(HeaderOf(response, "Cross-Origin-Resource-Policy"), "same-origin");
}

}  // namespace
}  // namespace beckon::ui_bridge::web
