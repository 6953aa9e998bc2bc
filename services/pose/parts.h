// Several superquadrics for an object that one does not describe: a mug with its handle, a bottle
// with its neck.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "services/base/geometry.h"
#include "services/base/rim.h"
#include "services/pose/fit_adaptive.h"
#include "services/pose/fit_stage.h"
#include "services/pose/superquadric.h"

namespace beckon::pose {

struct PartsConfig {
  int most_parts = 3;  // the main body included; 1: never look for others
  // Points stick out where they lie farther outside the surface than any of these.
  double outside_m = 0.005;
  double outside_sigmas = 3;   // of the camera's noise
  double outside_medians = 3;  // of the median distance of all points
  // A part explains so many of the 512 points that are looked at, and this share of all.
  int min_points = 13;
  double min_share = 0.025;
  double min_protrusion_m =
      0.012;  // it reaches so far outside the main body: a lid's rim is no part
  // A neck: what is above is this much narrower than what is below, and so high at least.
  double neck_width = 0.72;
  double neck_height_m = 0.012;
  // Where the points lie this many times the camera's noise from the single shape, a part may have
  // led it astray though nothing sticks out.
  double astray_sigmas = 2.5;
  // Least share of the points that an upright round body holds.
  double round_share = 0.35;
  int rounds = 2;      // of assigning points to parts and refitting each
  int iterations = 6;  // of a part's refit
  double min_semi_axis_m = 0.003;
  int witnesses = 120;  // points that count, at most: neighbours in an image err together
};

/// The parts of an object whose points one superquadric, `single`, has been fitted to: the main
/// body first, two or more; empty where one does as well. Deterministic.
///
/// A part more has 11 parameters more and is taken where Schwarz's criterion says that it pays
/// (Schwarz 1978; Leonardis, Jaklic & Solina 1997 choose their superquadrics by the description
/// length, which is the same to this order):
///   n/2 log(s_k^2 / s_{k+1}^2) > 11/2 log n,
/// n being the number of witnesses, s_k^2 the camera's variance plus the mean squared distance of
/// the points from the surface of the union of k parts, each distance cut off where a point counts
/// as foreign.
///
/// Where a part may be is told by the points, not by gaps between them (occluders leave gaps):
/// - points that stick out of the surface, in one connected group;
/// - a neck: the outline's width falls in a step rather than evenly, and the points above it lie
///   within the body below it drawn out upwards. Where an occluder hides the upper corners of a box
///   they lie on its surface; a third may, and all where `rim_F` shows that nothing is hidden;
/// - what sticks out of the upright cylinder that most points lie on, as a handle may have
///   drawn the single shape out.
/// In the end most points of a part lie outside the main body, some of them well outside, and none
/// are seen through it or through the part (the far inside of a bowl), and the part's centre is not
/// within the main body.
std::vector<Superquadric> FindParts(const PointList& points_F, const std::optional<Plane>& table_F,
                                    const Eigen::Vector3d& viewpoint_F,
                                    std::span<const RimPoint> rim_F, const Superquadric& single,
                                    const AdaptiveConfig& fit, const PartsConfig& config);

}  // namespace beckon::pose
