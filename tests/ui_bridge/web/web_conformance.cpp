#include "tests/ui_bridge/conformance/conformance.h"
#include "tests/ui_bridge/conformance/web_hand.h"

namespace beckon::ui_bridge::conformance {

BECKON_FRONT_END_CONFORMANCE(WebHand);

}  // namespace beckon::ui_bridge::conformance
