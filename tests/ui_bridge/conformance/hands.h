// The hands for our own front ends, by name; one front end may be had in several ways.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/ui_bridge/conformance/console_hand.h"
#include "tests/ui_bridge/conformance/hand.h"
#include "tests/ui_bridge/conformance/paced_hands.h"

namespace beckon::ui_bridge::conformance {

using NamedHand = std::pair<std::string, std::unique_ptr<Hand> (*)()>;

template <typename HandClass>
std::unique_ptr<Hand> Make() {
  return std::make_unique<HandClass>();
}

inline std::vector<NamedHand> AllHands() {
  return {{"console", Make<ConsoleHand>},
          {"web", Make<WebHand>},
          {"switch", Make<PacedSwitch>},
          {"switch, rows", Make<RowColumnSwitch>},
          {"switch, halves", Make<BinarySwitch>},
          {"switch, by steps", Make<StepSwitch>},
          {"switch, inverse", Make<InverseSwitch>},
          {"speech", Make<PacedSpeech>},
          {"bci", Make<PacedBci>}};
}

}  // namespace beckon::ui_bridge::conformance
