// The outlines objects are shown with.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "services/perception/object_extraction.h"

namespace beckon::perception {

/// Most vertices of an outline.
inline constexpr int kMaxOutline = 64;

/// The largest outer contour of some pixels of an image (row-major, ascending), its ragged edge
/// smoothed and small gaps closed, simplified until it has few enough vertices. Clockwise as seen.
/// Smoothing keeps it steady: a pixel more or less opens or closes no gap by itself.
std::vector<std::array<int16_t, 2>> DrawOutline(int width, std::span<const uint32_t> pixels);

/// Keeps an object's outline for as long as its silhouette hardly changes.
class OutlineMemory {
 public:
  /// Fills in the outlines of objects whose ids are given; forgets all others.
  void Draw(int width, std::span<const int> ids, std::span<ExtractedObject> objects);

 private:
  struct Drawn {
    std::vector<uint32_t> silhouette;
    std::vector<std::array<int16_t, 2>> outline_px;
  };
  std::map<int, Drawn> drawn_;  // by id
  int width_ = 0;
};

}  // namespace beckon::perception
