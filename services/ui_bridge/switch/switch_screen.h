// The switch user's screen: text on standard output, with a line that is rewritten as the pointer
// moves where that is a terminal.
#pragma once

#include <string>

#include "lcmtypes/messages.h"

namespace beckon::ui_bridge {

class SwitchScreen {
 public:
  SwitchScreen();
  ~SwitchScreen();
  SwitchScreen(const SwitchScreen&) = delete;
  SwitchScreen& operator=(const SwitchScreen&) = delete;

  void Show(const msg::Query& query);
  /// A line that stays.
  void Line(const std::string& text);
  /// The line of the pointer; on what is no terminal it is not shown.
  void Pointer(const std::string& text);

 private:
  const bool terminal_;
  std::string pointer_;
};

}  // namespace beckon::ui_bridge
