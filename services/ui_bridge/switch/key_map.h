// Which keys of a device are which switch.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>

#include "services/base/result.h"
#include "services/ui_bridge/scan/scanner.h"
#include "services/ui_bridge/switch/input_stream.h"

namespace beckon::ui_bridge {

/// A key, every key, or none.
struct KeyChoice {
  static constexpr int kNone = -1;
  static constexpr int kAny = -2;
  int code = kNone;

  bool Takes(int key) const { return code == kAny || code == key; }
};

/// "any", "" (none), a name of linux/input-event-codes.h that a switch interface sends
/// ("KEY_SPACE", "BTN_0"), or a code, 1 .. 767.
Result<KeyChoice> ParseKey(const std::string& text);

/// Several keys of one switch are one switch: down while any of them is.
class KeyMap {
 public:
  KeyMap(KeyChoice main, KeyChoice select) : choices_{main, select} {}

  struct Edge {
    scan::Switch which;
    bool down;
  };
  /// What a key's change does to its switch, if anything. A key named for "select" is not taken for
  /// "main", where that is any.
  std::optional<Edge> OnKey(const InputEvent& key);
  /// All are up.
  void Reset();

 private:
  std::array<KeyChoice, 2> choices_;
  std::array<std::set<int>, 2> down_;
};

}  // namespace beckon::ui_bridge
