#include "services/ui_bridge/web/http_guard.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

namespace beckon::ui_bridge::web {
namespace {

std::string LowerCase(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
  }
  return text;
}

bool IsDigits(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

/// NAME, NAME:PORT, [v6] or [v6]:PORT, without the port; empty where it is none of them.
std::string HostName(const std::string& header) {
  const std::string host = LowerCase(header);
  const size_t end = host.starts_with('[') ? host.find(']') + 1 : host.find(':');
  const std::string name = host.substr(0, end);
  const std::string rest = end == std::string::npos ? "" : host.substr(end);
  if (!rest.empty() && (rest.size() > 6 || rest[0] != ':' || !IsDigits(rest.substr(1)))) return {};
  return name;
}

/// Four numbers with dots: no name server has a say in where that leads.
bool IsAddress4(std::string_view name) {
  int parts = 1;
  size_t digits = 0;
  for (const char c : name) {
    if (c == '.' && digits > 0) {
      ++parts;
      digits = 0;
    } else if (c >= '0' && c <= '9' && ++digits <= 3) {
      continue;
    } else {
      return false;
    }
  }
  return parts == 4 && digits > 0;
}

bool IsAddress6(std::string_view name) {
  constexpr std::string_view kAllowed = "0123456789abcdef:.[]";
  return name.starts_with('[') && name.ends_with(']') &&
         name.find_first_not_of(kAllowed) == std::string_view::npos;
}

bool IsThisMachine(const std::string& name, const AccessRules& rules) {
  if (name == "localhost" || name == "[::1]") return true;
  if (IsAddress4(name)) return !rules.loopback || name.starts_with("127.");
  if (IsAddress6(name)) return !rules.loopback;
  return !name.empty() && std::ranges::count(rules.hosts, name) > 0;
}

/// Told by the browser, and by no page it shows.
bool FromAnotherSite(const HttpRequest& request) {
  const std::string host = LowerCase(request.Header("host"));
  if (const std::string origin = LowerCase(request.Header("origin"));
      !origin.empty() && origin != "http://" + host && origin != "https://" + host)
    return true;
  const std::string site = request.Header("sec-fetch-site");
  if (site.empty() || site == "same-origin" || site == "none") return false;
  // A link on another site may lead to the page, which then asks for everything else itself.
  const bool navigation = request.Header("sec-fetch-mode") == "navigate" &&
                          (request.method == "GET" || request.method == "HEAD");
  return !navigation || request.path.starts_with("/api/");
}

std::string Cookie(const HttpRequest& request, const std::string& name) {
  const std::string header = request.Header("cookie");
  std::string_view rest = header;
  while (!rest.empty()) {
    const std::string_view part = rest.substr(0, rest.find(';'));
    rest.remove_prefix(std::min(rest.size(), part.size() + 1));
    const size_t begin = part.find_first_not_of(' ');
    if (begin == std::string_view::npos) continue;
    const std::string_view pair = part.substr(begin);
    if (pair.starts_with(name + "=")) return std::string(pair.substr(name.size() + 1));
  }
  return {};
}

std::string Bearer(const HttpRequest& request) {
  const std::string header = request.Header("authorization");
  return header.starts_with("Bearer ") ? header.substr(7) : std::string();
}

std::optional<HttpResponse> CheckToken(const HttpRequest& request, const AccessRules& rules) {
  if (rules.token.empty()) return {};
  if (request.query.contains("token") && request.path == "/") {
    if (!SameSecret(request.Query("token"), rules.token))
      return ErrorResponse(401, "this token is not the one: use the address that was printed last");
    HttpResponse response{.status = 302};
    const bool partner = request.Query("view") == "partner";
    response.headers = {
        {"Location", partner ? "/?view=partner" : "/"},
        {"Set-Cookie", rules.cookie + "=" + rules.token +
                           "; Path=/; Max-Age=31536000; HttpOnly; SameSite=Strict"}};
    AddSecurityHeaders(response);
    return response;
  }
  if (SameSecret(Cookie(request, rules.cookie), rules.token)) return {};
  if (SameSecret(Bearer(request), rules.token)) return {};
  return ErrorResponse(401, "open the address with the token that was printed at the start");
}

}  // namespace

std::optional<HttpResponse> Keep(const HttpRequest& request, const AccessRules& rules) {
  if (!IsThisMachine(HostName(request.Header("host")), rules))
    return ErrorResponse(421, "this server is not called that; use its address");
  if (FromAnotherSite(request)) return ErrorResponse(403, "this request was made by another site");
  return CheckToken(request, rules);
}

HttpResponse ErrorResponse(int status, const std::string& error) {
  HttpResponse response{.status = status, .content_type = "application/json"};
  const nlohmann::json body = {{"error", error}};
  response.body = std::make_shared<const std::string>(
      body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  response.headers = {{"Cache-Control", "no-store"}};
  AddSecurityHeaders(response);
  return response;
}

void AddSecurityHeaders(HttpResponse& response) {
  static const std::vector<std::pair<std::string, std::string>> kHeaders = {
      {"Content-Security-Policy",
       "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
       "connect-src 'self'; manifest-src 'self'; frame-ancestors 'none'; base-uri 'none'; "
       "form-action 'none'"},
      {"X-Content-Type-Options", "nosniff"},
      {"Referrer-Policy", "no-referrer"},
      {"Cross-Origin-Opener-Policy", "same-origin"},
      {"Cross-Origin-Resource-Policy", "same-origin"},
      {"Permissions-Policy",
       "camera=(), microphone=(), geolocation=(), payment=(), usb=(), serial=()"}};
  response.headers.insert(response.headers.end(), kHeaders.begin(), kHeaders.end());
}

bool SameSecret(const std::string& given, const std::string& secret) {
  unsigned different = given.size() == secret.size() ? 0 : 1;
  for (size_t i = 0; i < secret.size(); ++i) {
    const char c = i < given.size() ? given[i] : '\0';
    different |= static_cast<unsigned char>(c) ^ static_cast<unsigned char>(secret[i]);
  }
  return different == 0 && !secret.empty();
}

}  // namespace beckon::ui_bridge::web
