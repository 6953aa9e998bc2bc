// HOG blocks of the crop.
#include "services/perception/cue_hog.h"

#include <algorithm>
#include <opencv2/objdetect.hpp>

#include "services/perception/cue_crop.h"

namespace beckon::perception {
namespace {

constexpr int kBag_px = 64;
constexpr int kDense_px = 48;
constexpr float kHalfRange_m = 0.12F;
constexpr float kPlaceWeight =
    0.5F;  // how much a block's place counts against its gradients (norm 1)

std::vector<float> Hog(const cv::Mat& crop, int block, int stride) {
  const cv::HOGDescriptor hog(crop.size(), {block, block}, {stride, stride}, {8, 8}, 9);
  std::vector<float> values;
  hog.compute(crop, values);
  return values;
}

}  // namespace

Descriptors HogCue::Describe(const CueView& view) const {
  const std::vector<float> outline = Hog(CropMask(view, kBag_px), 16, 8);
  const std::vector<float> grey = Hog(CropGrey(view, kBag_px), 16, 8);
  constexpr int kBlock = 36;
  constexpr int kSide = kBag_px / 8 - 1;  // blocks along a side
  Descriptors out(kSide * kSide, dimension());
  for (int i = 0; i < kSide * kSide; ++i) {
    for (int j = 0; j < kBlock; ++j) {
      out(i, j) = outline[static_cast<size_t>(i) * kBlock + j];
      out(i, kBlock + j) = 0.5F * grey[static_cast<size_t>(i) * kBlock + j];
    }
    // OpenCV walks the blocks column by column.
    out(i, 2 * kBlock) = kPlaceWeight * static_cast<float>(i / kSide) / (kSide - 1);
    out(i, 2 * kBlock + 1) = kPlaceWeight * static_cast<float>(i % kSide) / (kSide - 1);
  }
  return out;
}

Descriptors DepthHogCue::Describe(const CueView& view) const {
  const std::vector<float> depth = Hog(CropDepth(view, kDense_px, kHalfRange_m), 8, 8);
  const std::vector<float> outline = Hog(CropMask(view, kDense_px), 8, 8);
  Descriptors out(1, dimension());
  for (size_t i = 0; i < depth.size(); ++i) {
    out(0, static_cast<int>(i)) = std::clamp(depth[i], 0.0F, 1.0F);
    out(0, static_cast<int>(depth.size() + i)) = 0.5F * std::clamp(outline[i], 0.0F, 1.0F);
  }
  return out;
}

}  // namespace beckon::perception
