#include "tests/ui_bridge/conformance/bci_hand.h"
#include "tests/ui_bridge/conformance/conformance.h"

namespace beckon::ui_bridge::conformance {

BECKON_FRONT_END_CONFORMANCE(BciHand);

}  // namespace beckon::ui_bridge::conformance
