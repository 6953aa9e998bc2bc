// SIFT of the crop, on the object.
#include "services/perception/cue_sift.h"

#include <opencv2/features2d.hpp>

#include "services/perception/cue_crop.h"

namespace beckon::perception {
namespace {
constexpr int kCrop_px = 128;
constexpr int kMaxKeypoints = 100;
}  // namespace

Descriptors SiftCue::Describe(const CueView& view) const {
  const cv::Mat grey = CropGrey(view, kCrop_px);
  const cv::Mat mask = CropMask(view, kCrop_px);
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat found;
  cv::SIFT::create(kMaxKeypoints, 3, 0.03)->detectAndCompute(grey, mask, keypoints, found);
  Descriptors out(found.rows, dimension());
  for (int row = 0; row < found.rows; ++row) {
    const Eigen::Map<const Eigen::RowVectorXf> d(found.ptr<float>(row), dimension());
    // RootSIFT (Arandjelovic and Zisserman 2012): Euclidean distance then compares histograms
    // fairly.
    out.row(row) = (d.array() / std::max(1e-6F, d.sum())).sqrt();
  }
  return out;
}

}  // namespace beckon::perception
