#include "services/capture/scene_description.h"

namespace beckon::capture {

std::vector<DescribedObject> DescribeLabels(const RgbdImage& image,
                                            const std::vector<uint32_t>& labels,
                                            const std::map<int, std::string>& categories) {
  struct Sum {
    Eigen::Vector3d points = Eigen::Vector3d::Zero();
    Eigen::AlignedBox3d box;
    int n = 0;
  };
  std::map<int, Sum> sums;
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const auto label = static_cast<int>(labels[image.Index(u, v)]);
      if (label == 0 || !image.HasDepth(u, v) || !categories.contains(label)) continue;
      Sum& sum = sums[label];
      const Eigen::Vector3d p_C = image.Point(u, v);
      sum.points += p_C;
      sum.box.extend(p_C);
      ++sum.n;
    }
  }
  std::vector<DescribedObject> objects;
  for (const auto& [label, sum] : sums) {
    DescribedObject object;
    object.label = label;
    object.category = categories.at(label);
    object.centroid_C = sum.points / sum.n;
    object.box_C = sum.box;
    object.visible_points = sum.n;
    objects.push_back(object);
  }
  return objects;
}

}  // namespace beckon::capture
