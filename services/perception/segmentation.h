// What segmentation is given and gives: the table's plane and outline, and a label per pixel.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "services/base/geometry.h"
#include "services/base/rgbd.h"
#include "services/perception/sensor_noise.h"

namespace beckon::perception {

enum class SegmentationMethod { kFast, kReference };

/// "fast", "reference".
const char* Name(SegmentationMethod method);
/// The method of a name; fails for one that does not exist.
Result<SegmentationMethod> ParseSegmentationMethod(const std::string& name);

/// Section [segmentation] of the configuration. Defaults after the dissertation's chapter 3, but
/// for min_height_m (there 0.02): 0.01 keeps flat objects and scored better on real scenes. What
/// voxels, normals and clusters are is of the reference method only.
struct SegmentationConfig {
  SegmentationMethod method = SegmentationMethod::kFast;
  SensorNoise sensor;             // fast only: its thresholds follow from this
  double min_object_m2 = 0.0003;  // fast only: across the line of sight, less is no object
  double min_range_m = 0.3;       // depth that is used, along the optical axis
  double max_range_m = 3.0;
  double reference_min_range_m = 0.5;  // reference only, for min_range_m: the dissertation's
  double voxel_m = 0.002;              // edge length of the voxels
  bool use_normals = false;            // a plane by points and normals: slower by a factor of 50
  int normal_neighbours = 30;          // points a normal is estimated from
  double normal_weight = 0.1;          // 0..1, of angles against distances, where normals are used
  double plane_distance_m = 0.01;      // points this close to a plane lie on it
  int plane_iterations = 1000;         // most hypotheses of RANSAC
  int plane_min_points = 2000;         // voxels (fast: pixels), fewer are no table
  double table_max_tilt_deg = 80;  // between the table's normal and up in the image; more is a wall
  double table_gap_m = 0.10;       // pieces of a table that are this close belong together
  double min_height_m = 0.01;      // above the table, of what is an object
  double max_height_m = 0.50;
  double cluster_tolerance_m = 0.01;  // points this close belong to one object
  int cluster_min_points = 150;       // voxels, fewer are no object
  double border_m = 0.03;             // what stays this close to the table's border is no object
  int max_objects = 64;               // the largest are kept
};

/// One image segmented. Objects are numbered from 1, the one with most pixels first.
struct Segmentation {
  std::optional<Plane> table_C;  // normal towards the camera
  std::string reason;            // why there is no table, in words; empty where there is one
  std::vector<Eigen::Vector3d>
      hull_C;  // the table's convex hull, on its plane, counter-clockwise from above
  std::vector<uint16_t> labels;  // width * height; 0 = no object, k = object k
  int n_objects = 0;

  int n_points = 0;  // pixels in range
  int n_voxels = 0;
  int n_table_points = 0;  // voxels (fast: pixels) of the table
  int n_prism_points = 0;  // voxels above the table
  int n_left_out = 0;      // objects beyond max_objects
};

/// A step that is done. `regions`, where the step has any to show, numbers the parts that the image
/// is in by now: per cell of `cell_px` x `cell_px` pixels, row-major, what remains at the right and
/// lower border left out; 0 = in none. It costs time only where it is called, and may be called
/// only while the observer is.
struct StepDone {
  const char* name;
  int cell_px = 1;
  std::function<std::vector<uint32_t>()> regions = {};
};

/// Told each step when it is done, for whoever measures time or draws pictures.
using StepObserver = std::function<void(const StepDone& step)>;

/// Segments by the configured method.
Segmentation Segment(const RgbdImage& image, const SegmentationConfig& config,
                     const StepObserver& done = {});

}  // namespace beckon::perception
