// How much memory OpenCV takes for an image, for tests of images that claim to be larger than they
// may be.
#pragma once

#include <algorithm>
#include <opencv2/core.hpp>

namespace beckon {

/// Watches OpenCV's images while it exists.
class LargestImage : private cv::MatAllocator {
 public:
  LargestImage() : before_(cv::Mat::getDefaultAllocator()) { cv::Mat::setDefaultAllocator(this); }
  ~LargestImage() override { cv::Mat::setDefaultAllocator(before_); }
  LargestImage(const LargestImage&) = delete;
  LargestImage& operator=(const LargestImage&) = delete;

  /// Of the largest so far.
  size_t bytes() const { return bytes_; }

 private:
  cv::UMatData* allocate(int dims, const int* sizes, int type, void* data, size_t* step,
                         cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
    size_t bytes = CV_ELEM_SIZE(type);
    for (int i = 0; i < dims; ++i) bytes *= static_cast<size_t>(sizes[i]);
    bytes_ = std::max(bytes_, bytes);
    return before_->allocate(dims, sizes, type, data, step, flags, usage);
  }
  bool allocate(cv::UMatData* data, cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
    return before_->allocate(data, flags, usage);
  }
  void deallocate(cv::UMatData* data) const override { before_->deallocate(data); }

  cv::MatAllocator* before_;
  mutable size_t bytes_ = 0;
};

}  // namespace beckon
