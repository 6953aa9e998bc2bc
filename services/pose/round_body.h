// The upright round body that most of an object's points lie on, whatever else is attached to it.
#pragma once

#include <optional>

#include "services/pose/part_model.h"

namespace beckon::pose {

/// The cylinder along `view.up` whose wall holds the most points, standing on the table; found by
/// random circles through three points (RANSAC, Fischler & Bolles 1981). Empty without a table, or
/// where it holds less than `min_share` of them. Deterministic.
std::optional<Superquadric> FindRoundBody(const PartsView& view, double min_share);

}  // namespace beckon::pose
