#include "services/ui_bridge/switch/key_map.h"

#include <linux/input-event-codes.h>

#include <charconv>
#include <utility>

namespace beckon::ui_bridge {
namespace {

/// What switch interfaces and their likes send.
constexpr std::pair<const char*, int> kNames[] = {
    {"KEY_SPACE", KEY_SPACE},
    {"KEY_ENTER", KEY_ENTER},
    {"KEY_TAB", KEY_TAB},
    {"KEY_ESC", KEY_ESC},
    {"KEY_LEFT", KEY_LEFT},
    {"KEY_RIGHT", KEY_RIGHT},
    {"KEY_UP", KEY_UP},
    {"KEY_DOWN", KEY_DOWN},
    {"KEY_1", KEY_1},
    {"KEY_2", KEY_2},
    {"KEY_3", KEY_3},
    {"KEY_4", KEY_4},
    {"KEY_F1", KEY_F1},
    {"KEY_F2", KEY_F2},
    {"KEY_F3", KEY_F3},
    {"KEY_F4", KEY_F4},
    {"KEY_VOLUMEUP", KEY_VOLUMEUP},
    {"BTN_0", BTN_0},
    {"BTN_1", BTN_1},
    {"BTN_2", BTN_2},
    {"BTN_3", BTN_3},
    {"BTN_LEFT", BTN_LEFT},
    {"BTN_RIGHT", BTN_RIGHT},
    {"BTN_MIDDLE", BTN_MIDDLE},
    {"BTN_TRIGGER", BTN_TRIGGER},
    {"BTN_THUMB", BTN_THUMB},
    {"BTN_SOUTH", BTN_SOUTH},
    {"BTN_EAST", BTN_EAST},
    {"BTN_TRIGGER_HAPPY1", BTN_TRIGGER_HAPPY1},
    {"BTN_TRIGGER_HAPPY2", BTN_TRIGGER_HAPPY2},
};

}  // namespace

Result<KeyChoice> ParseKey(const std::string& text) {
  if (text.empty()) return KeyChoice{};
  if (text == "any") return KeyChoice{KeyChoice::kAny};
  for (const auto& [name, code] : kNames) {
    if (text == name) return KeyChoice{code};
  }
  int code = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), code);
  if (error == std::errc() && end == text.data() + text.size() && code >= 1 && code <= KEY_MAX) {
    return KeyChoice{code};
  }
  return Error{"key '" + text +
               "': expected \"any\", a name such as KEY_SPACE or BTN_0, or a code " + "from 1 to " +
               std::to_string(KEY_MAX) + " (evtest shows what a switch sends)"};
}

std::optional<KeyMap::Edge> KeyMap::OnKey(const InputEvent& key) {
  for (const size_t i : {size_t{1}, size_t{0}}) {
    const bool named = choices_[i].code == key.code;
    const bool other_named = choices_[1 - i].code == key.code;
    if (!choices_[i].Takes(key.code) || (other_named && !named)) continue;
    const bool was = !down_[i].empty();
    key.down ? (void)down_[i].insert(key.code) : (void)down_[i].erase(key.code);
    const bool is = !down_[i].empty();
    if (was == is) return {};
    return Edge{i == 0 ? scan::Switch::kMain : scan::Switch::kSelect, is};
  }
  return {};
}

void KeyMap::Reset() {
  for (auto& down : down_) down.clear();
}

}  // namespace beckon::ui_bridge
