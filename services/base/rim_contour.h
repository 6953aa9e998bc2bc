// Outer contours of labelled pixels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace beckon {

/// A pixel of an image, u to the right, v down.
struct Pixel {
  int u = 0;
  int v = 0;
  bool operator==(const Pixel&) const = default;
};

/// A connected piece of a label's pixels (8 neighbours).
struct Piece {
  uint16_t label = 0;
  Pixel first;  // the leftmost of its topmost row
  int n_pixels = 0;
};

/// Row-major labels of an image of `width` columns. Only pixels with depth count, and labels 1 ..
/// `n_labels`.
struct LabelImage {
  std::span<const uint16_t> labels;
  std::span<const float> depth_m;  // one a label; 0 = no depth
  int width = 0;
  int height = 0;
  int n_labels = 0;

  bool Inside(Pixel p) const { return p.u >= 0 && p.v >= 0 && p.u < width && p.v < height; }
  size_t Index(Pixel p) const { return static_cast<size_t>(p.v) * width + p.u; }
  /// 0 where there is no depth, and outside.
  uint16_t At(Pixel p) const { return Inside(p) ? At(Index(p)) : uint16_t{0}; }
  uint16_t At(size_t i) const {
    return labels[i] <= n_labels && depth_m[i] > 0 ? labels[i] : uint16_t{0};
  }
};

/// The pieces of all labels, in the order of their first pixels.
std::vector<Piece> FindPieces(const LabelImage& image);

/// The outer border of the piece that begins at `first`, clockwise as seen; where the piece is one
/// pixel thin a pixel comes twice (Moore's neighbour tracing).
std::vector<Pixel> TraceOuterContour(const LabelImage& image, Pixel first);

}  // namespace beckon
