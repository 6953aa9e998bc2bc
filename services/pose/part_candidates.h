// Where an object may have a part of its own: points that stick out, and necks.
#pragma once

#include <optional>
#include <vector>

#include "services/pose/part_model.h"
#include "services/pose/parts.h"

namespace beckon::pose {

/// How many points make a part.
int FewestPoints(const PartsView& view, const PartsConfig& config);

/// Whether enough points stick out of the single shape for a part, connected or not.
bool SomethingSticksOut(const PartModel& model, const PartsView& view, const PartsConfig& config);

/// The model and a part for the largest connected group of points that stick out of it; empty
/// without one.
std::vector<Superquadric> WithProtrudingPart(const PartModel& model, const PartsView& view,
                                             const AdaptiveConfig& fit, const PartsConfig& config);

/// The height along `view.up` at which the outline of the object steps to a narrower one above.
std::optional<double> NeckHeight(const PartsView& view, const PartsConfig& config);

/// Body and neck; empty where the points above `height` are the body's own.
std::vector<Superquadric> BodyAndNeck(const Superquadric& single, double height,
                                      const PartsView& view, const AdaptiveConfig& fit,
                                      const PartsConfig& config);

}  // namespace beckon::pose
