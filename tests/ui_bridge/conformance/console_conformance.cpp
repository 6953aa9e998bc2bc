#include "tests/ui_bridge/conformance/conformance.h"
#include "tests/ui_bridge/conformance/console_hand.h"

namespace beckon::ui_bridge::conformance {

BECKON_FRONT_END_CONFORMANCE(ConsoleHand);

}  // namespace beckon::ui_bridge::conformance
