// Which source the options ask for, and what is known of its ground truth.
#pragma once

#include <memory>

#include "services/capture/options.h"
#include "services/capture/scene_description.h"
#include "services/capture/source.h"

namespace beckon::capture {

/// The source of `options.input`, or the embedded scene. The first image is read here, so that what
/// cannot be read is told at once.
Result<std::unique_ptr<Source>> OpenSource(const Options& options);

/// Ground truth of the input: of the embedded scene from itself; of a file NAME.pcd from
/// NAME_truth.json beside it, else from its labels and a categories.json beside it (object = label
/// / 10, labels below 20 are none); otherwise a description that knows nothing.
Result<SceneDescription> DescribeInput(const Options& options);

}  // namespace beckon::capture
