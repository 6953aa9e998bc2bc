// From an estimate in the camera's frame to a message in the table's.
#pragma once

#include "lcmtypes/messages.h"
#include "services/pose/estimate.h"

namespace beckon::pose {

/// The table's plane in C, its normal up, from the camera's pose in W (whose z = 0 is the table).
Plane TableInCamera(const Pose& X_WC);

/// `estimate_C` as a message: everything moved from C to W; of grasps and alternatives the best, as
/// many as a message may have; parts where they are no more than that.
msg::ObjectPose ToMessage(const Estimate& estimate_C, const Pose& X_WC, int object_id,
                          double fit_ms);

/// Leaves out what can best be missed until the encoded message fits one datagram: of every object
/// the least of its grasps down to four, then the unlikeliest alternatives, then all parts of the
/// last objects (a few of an object's parts would not be it), then grasps. Sixty-four objects fit
/// with four grasps and three alternatives each.
void FitDatagram(msg::Poses& poses);

}  // namespace beckon::pose
