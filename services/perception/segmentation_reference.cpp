// The six steps one after the other; planes and clusters are PCL's.
#include "services/perception/segmentation_reference.h"

#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>

#include <algorithm>
#include <numeric>
#include <sstream>

#include "services/perception/table_outline.h"
#include "services/perception/table_search.h"
#include "services/perception/voxel_grid.h"

namespace beckon::perception {
namespace {

/// Indices of the points above the table, within its outline.
std::vector<uint32_t> Prism(std::span<const Eigen::Vector3f> points_C, const Plane& table_C,
                            std::span<const Eigen::Vector2d> outline,
                            const SegmentationConfig& config) {
  const PlaneAxes axes(table_C);
  std::vector<uint32_t> inside;
  for (uint32_t i = 0; i < points_C.size(); ++i) {
    const Eigen::Vector3d p_C = points_C[i].cast<double>();
    const double height_m = table_C.Distance(p_C);
    if (height_m < config.min_height_m || height_m > config.max_height_m) continue;
    if (Contains(outline, axes(p_C))) inside.push_back(i);
  }
  return inside;
}

/// The cluster of each point of `points_C`, from 1; 0 for points in none. Returns how many there
/// are.
int Cluster(std::span<const Eigen::Vector3f> points_C, std::span<const uint32_t> among,
            const SegmentationConfig& config, std::vector<uint32_t>& cluster_of_point) {
  cluster_of_point.assign(points_C.size(), 0);
  if (static_cast<int>(among.size()) < config.cluster_min_points) return 0;
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  cloud->reserve(among.size());
  for (uint32_t i : among) cloud->push_back({points_C[i].x(), points_C[i].y(), points_C[i].z()});
  pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(new pcl::search::KdTree<pcl::PointXYZ>(false));
  tree->setInputCloud(cloud);
  pcl::EuclideanClusterExtraction<pcl::PointXYZ> extraction;
  extraction.setClusterTolerance(config.cluster_tolerance_m);
  extraction.setMinClusterSize(config.cluster_min_points);
  extraction.setSearchMethod(tree);
  extraction.setInputCloud(cloud);
  std::vector<pcl::PointIndices> clusters;
  extraction.extract(clusters);
  for (size_t k = 0; k < clusters.size(); ++k) {
    for (int i : clusters[k].indices) cluster_of_point[among[i]] = static_cast<uint32_t>(k + 1);
  }
  return static_cast<int>(clusters.size());
}

/// Takes away the clusters that only line the table's border: a wall behind it, say, whose noise
/// reaches over the edge. Fewer than a fifth of their points lie deeper in than border_m.
void DropBorderClusters(std::span<const Eigen::Vector3f> points_C, const Plane& table_C,
                        std::span<const Eigen::Vector2d> outline, const SegmentationConfig& config,
                        std::vector<uint32_t>& cluster_of_point, int n_clusters) {
  const PlaneAxes axes(table_C);
  std::vector<int> n_points(n_clusters + 1, 0), n_deep(n_clusters + 1, 0);
  for (size_t i = 0; i < points_C.size(); ++i) {
    const uint32_t k = cluster_of_point[i];
    if (k == 0) continue;
    ++n_points[k];
    n_deep[k] += DepthInside(outline, axes(points_C[i].cast<double>())) > config.border_m;
  }
  for (uint32_t& k : cluster_of_point) {
    if (n_deep[k] * 5 < n_points[k]) k = 0;
  }
}

/// Gives every pixel the number of its voxel's cluster, renumbered by the clusters' pixels, most
/// first.
void LabelPixels(const VoxelGrid& grid, std::span<const uint32_t> cluster_of_voxel, int n_clusters,
                 const SegmentationConfig& config, Segmentation& result) {
  std::vector<int> n_pixels(n_clusters + 1, 0);
  for (uint32_t voxel : grid.voxel_of_pixel) {
    if (voxel != VoxelGrid::kNone) ++n_pixels[cluster_of_voxel[voxel]];
  }
  std::vector<int> order(n_clusters);
  for (int k = 0; k < n_clusters; ++k) order[k] = k + 1;
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return n_pixels[a] > n_pixels[b]; });
  std::erase_if(order, [&](int k) { return n_pixels[k] == 0; });
  n_clusters = static_cast<int>(order.size());
  result.n_objects = std::min(n_clusters, config.max_objects);
  result.n_left_out = n_clusters - result.n_objects;
  std::vector<uint16_t> label_of_cluster(n_pixels.size(), 0);
  for (int k = 0; k < result.n_objects; ++k)
    label_of_cluster[order[k]] = static_cast<uint16_t>(k + 1);
  for (size_t pixel = 0; pixel < result.labels.size(); ++pixel) {
    const uint32_t voxel = grid.voxel_of_pixel[pixel];
    if (voxel != VoxelGrid::kNone) result.labels[pixel] = label_of_cluster[cluster_of_voxel[voxel]];
  }
}

std::vector<Eigen::Vector2d> Outline(std::span<const Eigen::Vector3f> points_C,
                                     const TableSearch& table, double gap_m) {
  const PlaneAxes axes(*table.table_C);
  std::vector<Eigen::Vector2d> on_table;
  on_table.reserve(table.inliers.size());
  for (uint32_t i : table.inliers) on_table.push_back(axes(points_C[i].cast<double>()));
  return ConvexHull(LargestPiece(on_table, gap_m));
}

/// A number per voxel as one per pixel.
std::vector<uint32_t> OfPixels(const VoxelGrid& grid, std::span<const uint32_t> of_voxel) {
  std::vector<uint32_t> of_pixel(grid.voxel_of_pixel.size(), 0);
  for (size_t i = 0; i < of_pixel.size(); ++i) {
    const uint32_t voxel = grid.voxel_of_pixel[i];
    if (voxel != VoxelGrid::kNone) of_pixel[i] = of_voxel[voxel];
  }
  return of_pixel;
}

/// Per voxel: 1 = among those listed.
std::vector<uint32_t> Marked(const VoxelGrid& grid, std::span<const uint32_t> voxels) {
  std::vector<uint32_t> marked(grid.points_C.size(), 0);
  for (uint32_t voxel : voxels) marked[voxel] = 1;
  return marked;
}

/// The voxels of the table's plane within its outline.
std::vector<uint32_t> Within(const VoxelGrid& grid, const TableSearch& table,
                             std::span<const Eigen::Vector2d> outline) {
  if (outline.size() < 3) return {};
  const PlaneAxes axes(*table.table_C);
  std::vector<uint32_t> within = table.inliers;
  std::erase_if(within, [&](uint32_t voxel) {
    return !Contains(outline, axes(grid.points_C[voxel].cast<double>()));
  });
  return within;
}

std::string TooFewPoints(const Segmentation& result, const SegmentationConfig& config) {
  std::ostringstream text;
  text << "only " << result.n_points << " pixels have depth between "
       << config.reference_min_range_m << " and " << config.max_range_m
       << " m, too few for a table";
  return text.str();
}

}  // namespace

Segmentation SegmentReference(const RgbdImage& image, const SegmentationConfig& config,
                              const StepObserver& done) {
  auto finished = [&done](const char* step, std::function<std::vector<uint32_t>()> regions = {}) {
    if (done) done({step, 1, std::move(regions)});
  };
  Segmentation result;
  result.labels.assign(image.depth_m.size(), 0);

  const VoxelGrid grid =
      MakeVoxelGrid(image, config.voxel_m, config.reference_min_range_m, config.max_range_m);
  result.n_points = grid.n_pixels;
  result.n_voxels = static_cast<int>(grid.points_C.size());
  finished("range_voxels", [&] {
    std::vector<uint32_t> number(grid.points_C.size());
    std::iota(number.begin(), number.end(), 1);
    return OfPixels(grid, number);
  });
  if (result.n_voxels < config.plane_min_points) {
    result.reason = TooFewPoints(result, config);
    return result;
  }

  const TableSearch table = FindTable(grid.points_C, config, done);
  finished("plane", [&] { return OfPixels(grid, Marked(grid, table.inliers)); });
  if (!table.table_C) {
    result.reason = table.reason;
    return result;
  }

  const auto outline = Outline(grid.points_C, table, config.table_gap_m);
  finished("hull", [&] { return OfPixels(grid, Marked(grid, Within(grid, table, outline))); });
  if (outline.size() < 3) {
    result.reason = "the points of the largest plane lie on a line";
    return result;
  }
  result.table_C = table.table_C;
  result.n_table_points = static_cast<int>(table.inliers.size());
  const PlaneAxes axes(*table.table_C);
  for (const auto& p : outline) {
    result.hull_C.push_back(axes.x * p.x() + axes.y * p.y() -
                            table.table_C->normal * table.table_C->offset_m);
  }

  const auto above = Prism(grid.points_C, *table.table_C, outline, config);
  result.n_prism_points = static_cast<int>(above.size());
  finished("prism", [&] { return OfPixels(grid, Marked(grid, above)); });
  std::vector<uint32_t> cluster_of_voxel;
  const int n_clusters = Cluster(grid.points_C, above, config, cluster_of_voxel);
  DropBorderClusters(grid.points_C, *table.table_C, outline, config, cluster_of_voxel, n_clusters);
  finished("clusters", [&] { return OfPixels(grid, cluster_of_voxel); });
  LabelPixels(grid, cluster_of_voxel, n_clusters, config, result);
  finished("labels",
           [&] { return std::vector<uint32_t>(result.labels.begin(), result.labels.end()); });
  return result;
}

}  // namespace beckon::perception
