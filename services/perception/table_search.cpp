// RANSAC planes by PCL, one after the other, until one can be the table.
#include "services/perception/table_search.h"

#include <pcl/console/print.h>
#include <pcl/features/normal_3d.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

namespace beckon::perception {
namespace {

using PointCloud = pcl::PointCloud<pcl::PointXYZ>;
using NormalCloud = pcl::PointCloud<pcl::Normal>;
using Indices = std::vector<int>;

constexpr int kMostPlanes = 5;
constexpr double kParallel = 0.985;  // cosine of 10 degrees

struct FoundPlane {
  Plane plane_C;  // normal towards the camera
  Indices inliers;
};

/// The largest planes of a cloud.
class PlaneFinder {
 public:
  PlaneFinder(std::span<const Eigen::Vector3f> points_C, const SegmentationConfig& config)
      : config_(config), cloud_(new PointCloud) {
    cloud_->reserve(points_C.size());
    for (const auto& p : points_C) cloud_->push_back({p.x(), p.y(), p.z()});
    if (config.use_normals) EstimateNormals();
  }

  /// Among the points of `among`; nothing where that has fewer than the least points.
  std::optional<FoundPlane> Find(const Indices& among) const {
    if (static_cast<int>(among.size()) < config_.plane_min_points) return std::nullopt;
    pcl::SACSegmentationFromNormals<pcl::PointXYZ, pcl::Normal> with_normals(false);
    pcl::SACSegmentation<pcl::PointXYZ> plain(false);  // false: fixed seed
    auto& ransac = config_.use_normals ? with_normals : plain;
    if (config_.use_normals) {
      with_normals.setInputNormals(normals_);
      with_normals.setNormalDistanceWeight(config_.normal_weight);
    }
    ransac.setModelType(config_.use_normals ? pcl::SACMODEL_NORMAL_PLANE : pcl::SACMODEL_PLANE);
    ransac.setMethodType(pcl::SAC_RANSAC);
    ransac.setDistanceThreshold(config_.plane_distance_m);
    ransac.setMaxIterations(config_.plane_iterations);
    ransac.setOptimizeCoefficients(true);
    ransac.setInputCloud(cloud_);
    ransac.setIndices(pcl::make_shared<const Indices>(among));
    pcl::PointIndices inliers;
    pcl::ModelCoefficients c;
    ransac.segment(inliers, c);
    if (static_cast<int>(inliers.indices.size()) < config_.plane_min_points ||
        c.values.size() != 4) {
      return std::nullopt;
    }
    return FoundPlane{TowardsCamera(c.values), std::move(inliers.indices)};
  }

 private:
  void EstimateNormals() {
    normals_.reset(new NormalCloud);
    pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
    estimation.setInputCloud(cloud_);
    estimation.setKSearch(config_.normal_neighbours);
    estimation.compute(*normals_);
  }

  static Plane TowardsCamera(const std::vector<float>& c) {
    Plane plane;
    plane.normal = Eigen::Vector3d(c[0], c[1], c[2]);
    const double norm = plane.normal.norm();
    const double sign = c[3] < 0 ? -1 : 1;  // the camera is at the origin: n·0 + d > 0
    plane.normal *= sign / norm;
    plane.offset_m = sign * c[3] / norm;
    return plane;
  }

  const SegmentationConfig& config_;
  PointCloud::Ptr cloud_;
  NormalCloud::Ptr normals_;
};

/// Between the plane's normal and up in the image.
double TiltDeg(const Plane& plane_C) {
  return std::acos(std::clamp(-plane_C.normal.y(), -1.0, 1.0)) * 180 / std::numbers::pi;
}

/// `among` without `without`; both ascending.
Indices Difference(const Indices& among, const Indices& without) {
  Indices rest;
  std::set_difference(among.begin(), among.end(), without.begin(), without.end(),
                      std::back_inserter(rest));
  return rest;
}

/// Where much lies higher above `floor` than any object: a table over it.
std::optional<FoundPlane> FindTableOver(const FoundPlane& floor, const PlaneFinder& finder,
                                        std::span<const Eigen::Vector3f> points_C,
                                        const SegmentationConfig& config) {
  Indices high;
  for (size_t i = 0; i < points_C.size(); ++i) {
    if (floor.plane_C.Distance(points_C[i].cast<double>()) > config.max_height_m) {
      high.push_back(static_cast<int>(i));
    }
  }
  for (int i = 0; i < kMostPlanes && high.size() * 20 > points_C.size(); ++i) {
    auto plane = finder.Find(high);
    if (!plane) break;
    if (plane->plane_C.normal.dot(floor.plane_C.normal) > kParallel) return plane;
    high = Difference(high, plane->inliers);
  }
  return std::nullopt;
}

std::string NoTable(int walls, double last_tilt_deg, const SegmentationConfig& config) {
  std::ostringstream text;
  if (walls == 0) {
    text << "no plane with at least " << config.plane_min_points << " points (voxels of "
         << config.voxel_m * 1000 << " mm)";
  } else {
    text << walls << (walls == 1 ? " plane" : " planes")
         << ", but none that can be a table: the last "
         << "is tilted " << std::lround(last_tilt_deg) << " degrees from up in the image, at most "
         << config.table_max_tilt_deg << " are allowed";
  }
  return text.str();
}

}  // namespace

TableSearch FindTable(std::span<const Eigen::Vector3f> points_C, const SegmentationConfig& config,
                      const StepObserver& done) {
  pcl::console::setVerbosityLevel(
      pcl::console::L_ALWAYS);  // a missing plane is no news for a terminal
  TableSearch result;
  PlaneFinder finder(points_C, config);
  if (done && config.use_normals) done({"normals"});
  Indices among(points_C.size());
  for (size_t i = 0; i < among.size(); ++i) among[i] = static_cast<int>(i);

  double tilt_deg = 0;
  for (; result.planes_tried < kMostPlanes; ++result.planes_tried) {
    auto plane = finder.Find(among);
    if (!plane) break;
    if (TiltDeg(plane->plane_C) <= config.table_max_tilt_deg) {
      if (auto higher = FindTableOver(*plane, finder, points_C, config)) plane = std::move(higher);
      std::sort(plane->inliers.begin(), plane->inliers.end());
      result.table_C = plane->plane_C;
      result.inliers.assign(plane->inliers.begin(), plane->inliers.end());
      return result;
    }
    tilt_deg = TiltDeg(plane->plane_C);
    std::sort(plane->inliers.begin(), plane->inliers.end());
    among = Difference(among, plane->inliers);
  }
  result.reason = NoTable(result.planes_tried, tilt_deg, config);
  return result;
}

}  // namespace beckon::perception
