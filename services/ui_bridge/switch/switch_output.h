// What the switch user sees and hears: screen and voice together, drawn anew only where something
// changed.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/messages.h"
#include "services/base/run_loop.h"
#include "services/ui_bridge/scan/scanner.h"
#include "services/ui_bridge/switch/speaker.h"
#include "services/ui_bridge/switch/switch_screen.h"

namespace beckon::ui_bridge {

class SwitchOutput {
 public:
  /// Speaks by `voice` (Speaker's command) where `audio`.
  SwitchOutput(bool audio, const std::vector<std::string>& voice, RunLoop& loop);

  /// A question, spoken before what is lit next.
  void Ask(const msg::Query& query);
  /// A line for the eye only.
  void Line(const std::string& text) { screen_.Line(text); }
  /// A line at once; spoken with the next Draw, before what is lit.
  void Tell(const std::string& text);
  /// Whether `view` was not what was drawn last; speaks and shows it if so. `query` is the one
  /// whose page is scanned, or null.
  bool Draw(const scan::View& view, const msg::Query* query);

 private:
  SwitchScreen screen_;
  std::unique_ptr<Speaker> speaker_;  // where there is a voice
  std::optional<scan::View> drawn_;
  std::string lit_;     // the words drawn last
  std::string to_say_;  // before the next ones
};

}  // namespace beckon::ui_bridge
