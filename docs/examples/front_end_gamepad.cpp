// Front end "gamepad": the four buttons of a game pad, through Linux's joystick interface. Button 0
// is yes, 1 is no, 2 takes the last answer back, 3 stops everything; after a stop, 0 goes on.
#include <fcntl.h>
#include <linux/joystick.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>

#include "services/base/run_loop.h"
#include "services/ui_bridge/front_end.h"

namespace beckon::ui_bridge {
namespace {

class Gamepad final : public FrontEnd {
 public:
  Gamepad(int fd, const FrontEndSetup& setup) : fd_(fd), setup_(setup) {}
  ~Gamepad() override { Unplug(); }

  msg::Interface Announce() const override {
    msg::Interface interface;  // yes/no questions
    interface.seconds_per_question = 3;
    interface.false_yes = interface.false_no = 0.01f;
    return interface;
  }
  void Begin() override {
    setup_.loop.AddFd(fd_, [this] { Read(); });
    setup_.sink.Request(msg::SessionKind::kRequestStart);
  }
  void Present(const msg::Query& query) override {
    query_ = query;
    std::printf("%s\n", query.text.c_str());
  }
  void Withdraw() override { query_.reset(); }
  void ShowSession(const msg::Session& event) override {
    stopped_ = event.kind == msg::SessionKind::kStopped;
    if (!event.text.empty()) std::printf("%s\n", event.text.c_str());
  }
  void ShowNotice(const std::string& text) override { std::printf("%s\n", text.c_str()); }
  std::string State() const override { return fd_ < 0 ? "the game pad is gone" : "listens"; }

 private:
  void Read() {
    js_event event{};
    if (read(fd_, &event, sizeof event) != sizeof event) return Unplug();
    if (event.type != JS_EVENT_BUTTON || event.value == 0) return;  // a release, a stick
    if (event.number == 3) return setup_.sink.Request(msg::SessionKind::kRequestStop);
    if (event.number == 2) return setup_.sink.Request(msg::SessionKind::kRequestUndo);
    if (stopped_ && event.number == 0) return setup_.sink.Request(msg::SessionKind::kRequestResume);
    if (!query_ && event.number == 0) return setup_.sink.Request(msg::SessionKind::kRequestStart);
    if (!query_ || event.number > 1) return;
    // No is the last option of every question: "No", or "None of these".
    const size_t n = query_->options.size();
    setup_.sink.Answer(query_->id, OneHot(event.number == 0 ? 0 : n - 1, n));
  }
  void Unplug() {
    if (fd_ < 0) return;
    setup_.loop.RemoveFd(fd_);
    close(std::exchange(fd_, -1));
  }

  int fd_;
  const FrontEndSetup setup_;
  std::optional<msg::Query> query_;
  bool stopped_ = false;
};

class GamepadFactory final : public FrontEndFactory {
 public:
  std::string name() const override { return "gamepad"; }
  std::string summary() const override { return "four buttons of a game pad"; }
  void AddOptions(CLI::App& app) override {
    app.add_option("--gamepad", device_, "The game pad (default: /dev/input/js0)");
  }
  Result<std::unique_ptr<FrontEnd>> Create(const FrontEndSetup& setup) override {
    const int fd = open(device_.c_str(), O_RDONLY | O_CLOEXEC);
    if (fd < 0) return Error{device_ + ": cannot be read; plug it in, or see --gamepad"};
    return std::unique_ptr<FrontEnd>(std::make_unique<Gamepad>(fd, setup));
  }

 private:
  std::string device_ = "/dev/input/js0";
};

const FrontEndRegistration kRegistration([]() -> std::unique_ptr<FrontEndFactory> {
  return std::make_unique<GamepadFactory>();
});

}  // namespace
}  // namespace beckon::ui_bridge
