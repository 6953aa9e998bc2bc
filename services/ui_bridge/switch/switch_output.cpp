#include "services/ui_bridge/switch/switch_output.h"

#include <utility>

#include "services/ui_bridge/switch/switch_pages.h"

namespace beckon::ui_bridge {
namespace {

std::string PointerLine(const scan::View& view, const std::string& lit) {
  std::string line = view.stopped ? "STOPPED  " : "";
  if (view.paused) return line + "(resting; press to go on)";
  if (view.confirming) line += "Are you sure?  ";
  return lit.empty() ? line : line + "> " + lit;
}

}  // namespace

SwitchOutput::SwitchOutput(bool audio, const std::vector<std::string>& voice, RunLoop& loop) {
  if (!audio) return;
  speaker_ = std::make_unique<Speaker>(voice, loop,
                                       [this](const std::string& text) { screen_.Line(text); });
}

void SwitchOutput::Ask(const msg::Query& query) {
  screen_.Show(query);
  if (speaker_) to_say_ = query.text;
}

void SwitchOutput::Tell(const std::string& text) {
  screen_.Line(text);
  if (speaker_) to_say_ += (to_say_.empty() ? "" : " ") + text;
}

bool SwitchOutput::Draw(const scan::View& view, const msg::Query* query) {
  const bool changed = !drawn_ || view != *drawn_;
  if (!changed && to_say_.empty()) return false;
  drawn_ = view;
  const std::string lit = LitWords(view, query);
  if (changed) screen_.Pointer(PointerLine(view, lit));
  std::string text = std::exchange(to_say_, {});
  if (!lit.empty() && (lit != lit_ || !text.empty())) text += (text.empty() ? "" : " ") + lit;
  lit_ = lit;
  if (speaker_ && !text.empty()) speaker_->Say(text);
  return changed;
}

}  // namespace beckon::ui_bridge
