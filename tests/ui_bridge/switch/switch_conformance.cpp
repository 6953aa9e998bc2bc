// The switch front end under the rules of every front end.
#include "tests/ui_bridge/conformance/conformance.h"
#include "tests/ui_bridge/conformance/switch_hand.h"

namespace beckon::ui_bridge::conformance {
namespace {

BECKON_FRONT_END_CONFORMANCE(SwitchHand);

}  // namespace
}  // namespace beckon::ui_bridge::conformance
