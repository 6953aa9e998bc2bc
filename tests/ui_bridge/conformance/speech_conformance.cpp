#include "tests/ui_bridge/conformance/conformance.h"
#include "tests/ui_bridge/conformance/speech_hand.h"

namespace beckon::ui_bridge::conformance {

BECKON_FRONT_END_CONFORMANCE(SpeechHand);

}  // namespace beckon::ui_bridge::conformance
