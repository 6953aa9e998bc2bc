// What the front end says it can do: INTERFACE, from what is known of the decoder.
#pragma once

#include "lcmtypes/messages.h"
#include "services/ui_bridge/bci/calibration.h"
#include "services/ui_bridge/bci/trials.h"

namespace beckon::ui_bridge::bci {

/// `trial_s`: s, > 0, from the start of a trial to its decoding. Errors are those of fused answers,
/// not of single trials: whoever asks hears fused ones, whose likelihoods already say how sure they
/// are. Time and errors of two and of most options are simulated at the accuracy of `calibration`;
/// between them time is taken to grow evenly. `utime` and `device` are left out.
msg::Interface Announce(const TrialsConfig& config, const Calibration& calibration, double trial_s);

}  // namespace beckon::ui_bridge::bci
