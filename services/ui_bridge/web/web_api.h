// The page's HTTP interface (docs/front-ends/web-api.md): which request means what. Knows the rules
// of requests; what is asked for is done by a PageActions.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "lcmtypes/messages.h"
#include "services/base/result.h"
#include "services/ui_bridge/web/http_guard.h"
#include "services/ui_bridge/web/http_message.h"
#include "services/ui_bridge/web/page_files.h"

namespace beckon::ui_bridge::web {

using Json = nlohmann::ordered_json;

/// What became of something that a page asked for.
struct Outcome {
  int status = 200;
  Json body = Json::object();

  static Outcome Failed(int status, const std::string& error) {
    return {status, {{"error", error}}};
  }
};

struct PageImage {
  std::string content_type;
  std::shared_ptr<const std::string> bytes;  // null: there is none
};

/// All calls in the loop's thread.
class PageActions {
 public:
  virtual ~PageActions() = default;
  /// The state as JSON; what event streams are told has been brought up to date.
  virtual std::shared_ptr<const std::string> StateJson() = 0;
  virtual PageImage Image() = 0;
  virtual Json Profile() = 0;
  virtual Json Settings() = 0;
  /// A page opens its event stream; `first`: it was just loaded, for the user.
  virtual void Opened(bool first) = 0;
  virtual Outcome Answer(int64_t query_id, int64_t option) = 0;
  /// `request`: a REQUEST_* of session_t; resuming was confirmed.
  virtual Outcome Request(msg::SessionKind request) = 0;
  virtual Outcome Press(int which, bool down) = 0;
  virtual Outcome ChooseUser(const std::string& user) = 0;
  virtual Outcome TrySettings(const Json& settings) = 0;
  virtual Outcome KeepSettings() = 0;
};

class WebApi {
 public:
  /// `actions` outlives it.
  WebApi(AccessRules rules, PageFiles files, PageActions& actions);
  WebApi(const WebApi&) = delete;
  WebApi& operator=(const WebApi&) = delete;

  HttpResponse operator()(const HttpRequest& request) const;

 private:
  using Read = std::function<HttpResponse(const HttpRequest&)>;
  using Change = std::function<Outcome(const Json&)>;
  struct Route {
    std::map<std::string, Read> read;      // by method
    std::map<std::string, Change> change;  // likewise
  };

  void AddReads();
  void AddChanges();
  HttpResponse Serve(const HttpRequest& request) const;
  HttpResponse ServeFile(const HttpRequest& request, const PageFile& file) const;
  HttpResponse ServeRoute(const HttpRequest& request, const Route& route) const;

  const AccessRules rules_;
  const PageFiles files_;
  PageActions& actions_;
  std::map<std::string, Route> routes_;
};

/// A request's body: an object, not nested deeper than 8.
Result<Json> ParseBody(const std::string& body);

}  // namespace beckon::ui_bridge::web
