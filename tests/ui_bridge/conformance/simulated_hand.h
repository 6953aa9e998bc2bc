// The simulated user needs no hand: it answers what it wants.
#pragma once

#include "tests/ui_bridge/conformance/hand.h"

namespace beckon::ui_bridge::conformance {
class SimulatedHand final : public Hand {
 public:
  std::string front_end() const override { return "simulated"; }
  /// Every question of the suite has what it wants as its first option.
  std::vector<std::string> flags() const override {
    return {"--want", "Open:Carton", "--sessions", "1000", "--think", "0.2"};
  }
  size_t Choose(const msg::Query&, size_t) override { return 0; }
  bool Stop() override { return false; }
  bool Resume() override { return false; }
};

}  // namespace beckon::ui_bridge::conformance
