#include "services/ui_bridge/web/web_api.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace beckon::ui_bridge::web {
namespace {

constexpr int kDeepest = 8;

HttpResponse JsonResponse(int status, std::shared_ptr<const std::string> text) {
  HttpResponse response{.status = status, .content_type = "application/json"};
  response.headers = {{"Cache-Control", "no-store"}};
  response.body = std::move(text);
  return response;
}

HttpResponse JsonResponse(int status, const Json& body) {
  return JsonResponse(status, std::make_shared<const std::string>(
                                  body.dump(-1, ' ', false, Json::error_handler_t::replace)));
}

bool IsJson(const std::string& content_type) {
  std::string type = content_type.substr(0, content_type.find(';'));
  while (type.ends_with(' ')) type.pop_back();
  std::ranges::transform(type, type.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
  });
  return type == "application/json";
}

bool IsTooDeep(std::string_view text) {
  int depth = 0;
  bool quoted = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\') {
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && (c == '{' || c == '[')) {
      if (++depth > kDeepest) return true;
    } else if (!quoted && (c == '}' || c == ']')) {
      --depth;
    }
  }
  return false;
}

Outcome Missing(const std::string& key, const std::string& expected) {
  return Outcome::Failed(400, "'" + key + "': expected " + expected);
}

bool IsInteger(const Json& body, const char* key) {
  const auto found = body.find(key);
  return found != body.end() && found->is_number_integer() &&
         !(found->is_number_unsigned() &&
           found->get<uint64_t>() > static_cast<uint64_t>(INT64_MAX));
}

bool IsString(const Json& body, const char* key) {
  const auto found = body.find(key);
  return found != body.end() && found->is_string();
}

bool IsTrue(const Json& body, const char* key) {
  const auto found = body.find(key);
  return found != body.end() && found->is_boolean() && found->get<bool>();
}

Outcome Request(const Json& body, PageActions& actions) {
  static const std::map<std::string, msg::SessionKind> kRequests = {
      {"start", msg::SessionKind::kRequestStart},
      {"cancel", msg::SessionKind::kRequestCancel},
      {"undo", msg::SessionKind::kRequestUndo},
      {"none_of_these", msg::SessionKind::kRequestNoneOfThese},
      {"stop", msg::SessionKind::kRequestStop},
      {"resume", msg::SessionKind::kRequestResume}};
  constexpr char kExpected[] = "start, cancel, undo, none_of_these, stop or resume";
  if (!IsString(body, "request")) return Missing("request", kExpected);
  const auto request = kRequests.find(body["request"].get<std::string>());
  if (request == kRequests.end()) return Missing("request", kExpected);
  if (request->second == msg::SessionKind::kRequestResume && !IsTrue(body, "confirm"))
    return Missing("confirm", "true: nothing leads out of a stop by accident");
  return actions.Request(request->second);
}

std::string Allowed(const std::vector<std::string>& methods) {
  std::string allowed;
  for (const auto& method : methods) {
    allowed += (allowed.empty() ? "" : ", ") + method;
    if (method == "GET") allowed += ", HEAD";
  }
  return allowed;
}

HttpResponse WrongMethod(const std::vector<std::string>& methods) {
  HttpResponse response = ErrorResponse(405, "this is asked for by " + Allowed(methods));
  response.headers.emplace_back("Allow", Allowed(methods));
  return response;
}

}  // namespace

WebApi::WebApi(AccessRules rules, PageFiles files, PageActions& actions)
    : rules_(std::move(rules)), files_(std::move(files)), actions_(actions) {
  AddReads();
  AddChanges();
}

void WebApi::AddReads() {
  const auto json = [this](const char* path, Json (PageActions::*get)()) {
    routes_[path].read["GET"] = [this, get](const HttpRequest&) {
      return JsonResponse(200, (actions_.*get)());
    };
  };
  json("/api/profile", &PageActions::Profile);
  json("/api/settings", &PageActions::Settings);
  routes_["/api/state"].read["GET"] = [this](const HttpRequest&) {
    return JsonResponse(200, actions_.StateJson());
  };
  routes_["/api/frame"].read["GET"] = [this](const HttpRequest&) {
    PageImage image = actions_.Image();
    if (!image.bytes) return ErrorResponse(404, "the camera gives no picture");
    HttpResponse response = JsonResponse(200, std::move(image.bytes));
    response.content_type = image.content_type;
    return response;
  };
  routes_["/api/events"].read["GET"] = [this](const HttpRequest& request) {
    HttpResponse response{.content_type = "text/event-stream"};
    response.headers = {{"Cache-Control", "no-store"}};
    if (request.method == "HEAD") return response;
    // A page that comes back says so, or its browser does.
    const bool again = request.query.contains("again") || !request.Header("last-event-id").empty();
    actions_.Opened(request.Query("view") == "user" && !again);
    response.event_stream = true;
    return response;
  };
}

void WebApi::AddChanges() {
  routes_["/api/answer"].change["POST"] = [this](const Json& body) {
    if (!IsInteger(body, "query_id")) return Missing("query_id", "the number of the question");
    if (!IsInteger(body, "option")) return Missing("option", "the index of one of its options");
    return actions_.Answer(body["query_id"], body["option"]);
  };
  routes_["/api/request"].change["POST"] = [this](const Json& body) {
    return Request(body, actions_);
  };
  routes_["/api/press"].change["POST"] = [this](const Json& body) {
    if (!IsInteger(body, "switch") || (body["switch"] != 0 && body["switch"] != 1))
      return Missing("switch", "0 or 1");
    const auto down = body.find("down");
    if (down == body.end() || !down->is_boolean()) return Missing("down", "true or false");
    return actions_.Press(body["switch"], *down);
  };
  routes_["/api/user"].change["POST"] = [this](const Json& body) {
    if (!IsString(body, "user")) return Missing("user", "a name");
    return actions_.ChooseUser(body["user"]);
  };
  routes_["/api/settings"].change["PUT"] = [this](const Json& body) {
    const auto settings = body.find("settings");
    if (settings == body.end() || !settings->is_object())
      return Missing("settings", "an object of settings");
    return actions_.TrySettings(*settings);
  };
  routes_["/api/settings/keep"].change["POST"] = [this](const Json&) {
    return actions_.KeepSettings();
  };
}

HttpResponse WebApi::operator()(const HttpRequest& request) const {
  if (auto kept_out = Keep(request, rules_)) return *std::move(kept_out);
  return Serve(request);
}

HttpResponse WebApi::Serve(const HttpRequest& request) const {
  HttpResponse response;
  if (const auto file = files_.find(request.path); file != files_.end()) {
    if (request.method != "GET" && request.method != "HEAD") return WrongMethod({"GET"});
    response = ServeFile(request, file->second);
  } else if (const auto route = routes_.find(request.path); route != routes_.end()) {
    response = ServeRoute(request, route->second);
  } else {
    return ErrorResponse(404, "there is nothing of that name here");
  }
  return response;
}

HttpResponse WebApi::ServeFile(const HttpRequest& request, const PageFile& file) const {
  HttpResponse response{.content_type = file.content_type};
  response.headers = {{"Cache-Control", "no-cache"}, {"ETag", file.etag}};
  AddSecurityHeaders(response);
  if (request.Header("if-none-match") == file.etag) {
    response.status = 304;
    response.content_type.clear();
  } else {
    response.body = file.bytes;
  }
  return response;
}

HttpResponse WebApi::ServeRoute(const HttpRequest& request, const Route& route) const {
  const std::string method = request.method == "HEAD" ? "GET" : request.method;
  if (const auto read = route.read.find(method); read != route.read.end()) {
    HttpResponse response = read->second(request);
    if (response.status == 200) AddSecurityHeaders(response);
    return response;
  }
  const auto change = route.change.find(method);
  if (change == route.change.end()) {
    std::vector<std::string> methods;
    for (const auto& [name, read] : route.read) methods.push_back(name);
    for (const auto& [name, other] : route.change) methods.push_back(name);
    return WrongMethod(methods);
  }
  if (!IsJson(request.Header("content-type")))
    return ErrorResponse(415, "expected Content-Type: application/json");
  const auto body = ParseBody(request.body);
  if (!body) return ErrorResponse(400, body.error().message);
  const Outcome outcome = change->second(*body);
  HttpResponse response = JsonResponse(outcome.status, outcome.body);
  AddSecurityHeaders(response);
  return response;
}

Result<Json> ParseBody(const std::string& body) {
  if (IsTooDeep(body)) return Error{"the body is nested too deeply"};
  Json json = Json::parse(body, nullptr, /*allow_exceptions=*/false);
  if (json.is_discarded()) return Error{"the body is no JSON"};
  if (!json.is_object()) return Error{"the body is no JSON object"};
  return json;
}

}  // namespace beckon::ui_bridge::web
