// Who may talk to the page's server: the rules that keep other web sites, other names for this
// machine and other people out.
//
// A browser on this machine is asked to send requests here by any page it shows. So a request must
// name this machine as its host (else a foreign name was made to point here: DNS rebinding), must
// not come from another site (Origin, Sec-Fetch-Site), and, where others can reach the server, must
// carry the token.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/ui_bridge/web/http_message.h"

namespace beckon::ui_bridge::web {

struct AccessRules {
  bool loopback = true;            // only this machine reaches the server
  std::vector<std::string> hosts;  // further names that are this machine, in lower case, no port
  std::string token;               // to be shown; empty = none
  std::string cookie = "beckon";   // name of the cookie that holds it
};

/// What keeps the request out, or nothing. A right `?token=` is answered by a redirect to the page,
/// with a cookie.
std::optional<HttpResponse> Keep(const HttpRequest& request, const AccessRules& rules);

/// An error for people as JSON.
HttpResponse ErrorResponse(int status, const std::string& error);

/// Adds what tells browsers to run nothing but the page's own files and to keep others away.
void AddSecurityHeaders(HttpResponse& response);

/// Takes the same time for every `given` of one length.
bool SameSecret(const std::string& given, const std::string& secret);

}  // namespace beckon::ui_bridge::web
