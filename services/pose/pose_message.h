// From an estimate in the camera's frame to a message in the table's.
#pragma once

#include "lcmtypes/messages.h"
#include "services/pose/estimate.h"

namespace beckon::pose {

/// The table's plane in C, its normal up, from the camera's pose in W (whose z = 0 is the table).
Plane TableInCamera(const Pose& X_WC);

/// `estimate_C` as a message: everything moved from C to W.
msg::ObjectPose ToMessage(const Estimate& estimate_C, const Pose& X_WC, int object_id,
                          double fit_ms);

}  // namespace beckon::pose
