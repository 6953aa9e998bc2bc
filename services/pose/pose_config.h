// The pose service's configuration file.
#pragma once

#include "services/base/config.h"
#include "services/pose/estimate.h"

namespace beckon::pose {

/// Defaults with the file's keys over them: `method`, [limits], [adaptive], [multiscale],
/// [classic], [hierarchical], [gripper].
Result<PoseConfig> ReadPoseConfig(ConfigTable table);

}  // namespace beckon::pose
