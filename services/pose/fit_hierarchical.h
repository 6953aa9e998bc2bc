// A hierarchical RANSAC search for a superquadric with ranked voting, after the abstract of
// Biegelbauer & Vincze, "Efficient 3D object detection by fitting superquadrics to range image data
// for robot's object manipulation" (ICRA 2007).
#pragma once

#include <vector>

#include "services/pose/fit_stage.h"

namespace beckon::pose {

struct HierarchicalConfig {
  std::vector<double> voxels_m{0.015, 0.0075};  // coarse to fine
  int hypotheses = 40;                          // drawn on the coarsest level
  double keep = 0.25;                           // the part of them that goes on to the next level
  double min_region = 0.5;  // radius of a sample's region, in parts of the cloud's, at least
  int sample_points = 40;   // points that a hypothesis is fitted to, at most
  int sample_iterations = 10;
  int level_iterations = 10;
  int fine_points = 500;  // at most about so many are fitted in the end
  int fine_iterations = 30;
  double inlier_m = 0.004;  // a point this near the surface votes for it
  int seed = 1;
  double min_semi_axis_m = 0.005;
  double axis_margin_m = 0.005;  // a semi-axis is at most the points' half extent + this
  double min_epsilon = 0.1;
  double max_epsilon = 1.0;
};

/// Fits a superquadric to at least 20 points that are not coplanar. Deterministic by the seed;
/// neither table nor viewpoint are used.
///   1. Hypotheses: random points near a random seed point of the coarsest voxel grid; an ellipsoid
///      along their principal axes (each in turn as z); a few steps of Levenberg-Marquardt on
///      SolinaProblem.
///   2. Verification by all points of the level: points that are missed, mean radial distance,
///      points deep inside, volume. Less is better in each.
///   3. Ranked voting: the hypotheses are sorted by each criterion, the places a hypothesis takes
///      are summed, and those with the smallest sums go on to the next finer level, where they are
///      refined on all its points and verified again (2). The last level is the cloud itself.
///
/// Of the paper this follows the abstract only: RANSAC from coarse to fine, and criteria of fit
/// that are sorted and voted on by rank. The paper's text and the authors' later one (2010) were
/// not at hand; that seed points have neighbourhoods and that second moments pre-align is common
/// knowledge of such methods, not checked against them. All else is chosen here: all eleven
/// parameters are free, so the neighbourhood's radius is random and sizes are limited by
/// BoundsByExtent; the criteria, with volume to prefer the less deep of two shapes that explain the
/// points; and all numbers. The authors' results need not hold for it.
MethodOutcome FitHierarchical(const PointList& points_F, const HierarchicalConfig& config);

}  // namespace beckon::pose
