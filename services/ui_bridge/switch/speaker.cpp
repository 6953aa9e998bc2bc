#include "services/ui_bridge/switch/speaker.h"

#include <utility>

namespace beckon::ui_bridge {
namespace {

constexpr Utime kLook_us = 100'000;
constexpr size_t kLongest = 2000;  // bytes of a sentence

}  // namespace

Speaker::Speaker(std::vector<std::string> command, RunLoop& loop,
                 std::function<void(const std::string&)> tell)
    : command_(std::move(command)), loop_(loop), tell_(std::move(tell)) {}

Speaker::~Speaker() { CutOff(); }

void Speaker::Say(const std::string& text) {
  CutOff();
  if (missing_ || command_.empty() || text.empty()) return;
  std::vector<std::string> words = command_;
  words.push_back("--");  // a sentence is no option, whatever it begins with
  words.push_back(text.substr(0, kLongest));
  auto child = Child::Start(words, {});
  if (!child) {
    missing_ = true;
    return Tell(child.error().message);
  }
  child_ = *std::move(child);
  timer_ = loop_.Every(kLook_us, [this] { Look(); });
}

void Speaker::Look() {
  if (!child_->Ended()) return;
  const int code = child_->Wait();
  CutOff();
  if (code != 0) Tell(command_[0] + ": it ended with " + std::to_string(code));
}

void Speaker::CutOff() {
  child_.reset();
  if (timer_) loop_.Cancel(*std::exchange(timer_, std::nullopt));
}

void Speaker::Tell(const std::string& why) {
  if (std::exchange(told_, true)) return;
  tell_("There is no voice: " + why + ". It goes on without.");
}

}  // namespace beckon::ui_bridge
