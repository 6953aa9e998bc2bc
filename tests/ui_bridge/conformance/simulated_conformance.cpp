#include "tests/ui_bridge/conformance/conformance.h"
#include "tests/ui_bridge/conformance/simulated_hand.h"

namespace beckon::ui_bridge::conformance {

BECKON_FRONT_END_CONFORMANCE(SimulatedHand);

}  // namespace beckon::ui_bridge::conformance
