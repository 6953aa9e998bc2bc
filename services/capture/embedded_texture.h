// Procedural pictures on objects, table, floor and wall: packaging with blocks of text, logos and
// pictures, patterned crockery, wood.
#pragma once

#include <vector>

#include "services/base/rgbd.h"
#include "services/capture/embedded_random.h"

namespace beckon::capture {

/// A picture, row-major, first row at v = 1. A single pixel is a plain colour.
struct Texture {
  int width = 1;
  int height = 1;
  std::vector<Rgb> pixels;

  /// Bilinear, repeating in u, clamped in v; r g b in 0 .. 255.
  Eigen::Vector3f Sample(float u, float v) const;
};

Texture PlainTexture(const Rgb& colour);
/// A colour as things are sold in: mostly saturated, sometimes white, black or pastel.
Rgb PackagingColour(Random& random);
/// A colour of crockery and plastic: mostly white or pastel.
Rgb CrockeryColour(Random& random);

/// The printed face of a package; `width_mm` x `height_mm` set its proportions and resolution.
Texture PackagingTexture(Random& random, const Rgb& base, double width_mm, double height_mm);
/// Plain, or with bands, dots or a printed motif.
Texture CrockeryTexture(Random& random, const Rgb& base);
/// Wood, plain laminate, checked cloth.
Texture TableTexture(Random& random);

}  // namespace beckon::capture
