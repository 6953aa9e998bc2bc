#include "services/ui_bridge/switch/switch_screen.h"

#include <unistd.h>

#include <cstdio>

namespace beckon::ui_bridge {
namespace {

constexpr char kClearLine[] = "\r\x1b[2K";
constexpr size_t kWidest = 78;  // a line that wraps could not be rewritten

}  // namespace

SwitchScreen::SwitchScreen() : terminal_(isatty(STDOUT_FILENO) == 1) {}

SwitchScreen::~SwitchScreen() {
  if (terminal_ && !pointer_.empty()) std::fputs("\n", stdout);
}

void SwitchScreen::Show(const msg::Query& query) {
  std::string text = "\n" + query.text;
  for (const auto& option : query.options) text += "\n   " + option.text;
  Line(text);
}

void SwitchScreen::Line(const std::string& text) {
  std::string lines = terminal_ && !pointer_.empty() ? kClearLine : "";
  lines += text + "\n";
  if (terminal_) lines += pointer_;
  std::fputs(lines.c_str(), stdout);
  std::fflush(stdout);
}

void SwitchScreen::Pointer(const std::string& text) {
  if (!terminal_) return;
  pointer_ = text.substr(0, kWidest);
  while (pointer_.size() < text.size() && !pointer_.empty() &&
         (static_cast<unsigned char>(text[pointer_.size()]) & 0xC0) == 0x80) {
    pointer_.pop_back();  // not within a character
  }
  std::fputs((kClearLine + pointer_).c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace beckon::ui_bridge
