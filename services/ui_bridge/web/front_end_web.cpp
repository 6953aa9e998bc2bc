// Front end "web": a page in the browser.
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cctype>
#include <cstdio>
#include <utility>

#include "services/base/app.h"
#include "services/base/status_reporter.h"
#include "services/ui_bridge/web/access_token.h"
#include "services/ui_bridge/web/listen_socket.h"
#include "services/ui_bridge/web/web_front_end.h"

namespace beckon::ui_bridge::web {
namespace {

std::string LowerCase(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// Who may talk to a server on this socket.
Result<AccessRules> Rules(const WebConfig& config, const ListenSocket& socket) {
  AccessRules rules{.loopback = socket.loopback};
  for (const auto& host : config.hosts) rules.hosts.push_back(LowerCase(host));
  rules.cookie = "beckon_" + std::to_string(socket.port);
  if (socket.loopback) return rules;
  rules.hosts.push_back(LowerCase(HostName()));
  rules.hosts.push_back(LowerCase(HostName()) + ".local");
  const std::string file = config.data.empty() ? DataFile("web/token") : config.data + "/token";
  auto token = LoadOrMakeToken(file);
  if (!token) return token.error();
  rules.token = *std::move(token);
  spdlog::warn(
      "web: {} can be reached from other machines; the token is kept in {}. What travels "
      "is not encrypted.",
      socket.Url(), file);
  return rules;
}

class WebFactory final : public FrontEndFactory {
 public:
  std::string name() const override { return "web"; }
  std::string summary() const override {
    return "a page in the browser, at http://127.0.0.1:8765/";
  }

  void AddOptions(CLI::App& app) override {
    auto* group = app.add_option_group("web", "Options of the web front end");
    port_ = group->add_option("--port", flag_, "Where the page is served; 0 = any that is free")
                ->check(CLI::Range(0, 65535));
  }

  void Configure(ConfigTable table) override {
    table.Get("address", config_.address);
    table.Get("port", config_.port, 0, 65535);
    table.Get("hosts", config_.hosts);
    table.Get("page", config_.page);
    table.Get("data", config_.data);
    table.Get("max_options", config_.max_options, 2, 64);
    table.Get("seconds_per_question", config_.seconds_per_question, 0.001, 3600);
    table.Get("seconds_per_option", config_.seconds_per_option, 0, 3600);
    table.Get("false_yes", config_.false_yes, 0, 0.5);
    table.Get("false_no", config_.false_no, 0, 0.5);
    table.Get("switch_errors", config_.switch_errors, 0, 0.5);
    table.Get("trial", config_.trial_s, 1, 600);
    if (port_ != nullptr && port_->count() > 0) config_.port = flag_;
  }

  Result<std::unique_ptr<FrontEnd>> Create(const FrontEndSetup& setup) override {
    auto files = ReadPageFiles(config_.page.empty() ? SharedFile("web") : config_.page);
    if (!files) return files.error();
    const bool inherited = IsSocketInherited();
    auto socket = inherited ? TakeInheritedSocket() : Listen(config_.address, config_.port);
    if (!socket) return socket.error();
    auto rules = Rules(config_, *socket);
    if (!rules) {
      close(socket->fd);
      return rules.error();
    }
    // Whoever made the socket tells people of it; but nobody else knows the token.
    if (!inherited || !rules->token.empty()) {
      const std::string token = rules->token.empty() ? "" : "?token=" + rules->token;
      std::printf("The page: %s/%s\n", socket->Url().c_str(), token.c_str());
      std::fflush(stdout);
    }
    return std::unique_ptr<FrontEnd>(std::make_unique<WebFrontEnd>(
        config_, setup, socket->fd, *std::move(rules), *std::move(files)));
  }

 private:
  WebConfig config_;
  int flag_ = 0;
  CLI::Option* port_ = nullptr;
};

const FrontEndRegistration kRegistration([]() -> std::unique_ptr<FrontEndFactory> {
  return std::make_unique<WebFactory>();
});

}  // namespace
}  // namespace beckon::ui_bridge::web
