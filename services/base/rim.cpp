// The rim of an object in an image, and what lies beyond it.
#include "services/base/rim.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "services/base/rim_contour.h"

namespace beckon {
namespace {

constexpr int kWidestGap_px = 20;     // without depth, that is looked across
constexpr int kNearBorder_px = 2;     // a rim this near the end of the image is cut off by it
constexpr int kWidestMargin_px = 16;  // columns and rows without depth along the image's border
constexpr int kBeyond = 3;            // pixels beyond a gap whose median tells the depth there
constexpr int kTangent_px = 3;        // along the contour to either side, for its direction
constexpr int kRays = 2;              // to either side of a point, that decide with its own
constexpr size_t kMostRays = 256;     // of one contour, evenly spread
constexpr int kSmallestPart = 20;     // a piece of an object with a smaller part of it is noise

/// What one ray sees.
struct Look {
  Pixel rim;
  float rim_m = 0;  // depth of the object there
  enum Kind { kStep, kNothing, kBorder, kItself } kind = kNothing;
  float step_m = 0;  // how much farther than the rim the surface beyond is
};

/// Columns and rows in which the camera has depth.
struct Field {
  int left = 0, right = 0, top = 0, bottom = 0;  // inclusive
  bool Contains(Pixel p) const {
    return p.u >= left && p.u <= right && p.v >= top && p.v <= bottom;
  }
};

bool RowHasDepth(const RgbdImage& image, int v) {
  const auto begin = image.depth_m.begin() + static_cast<long>(v) * image.width;
  return std::any_of(begin, begin + image.width, [](float z) { return z > 0; });
}

bool ColumnHasDepth(const RgbdImage& image, int u) {
  for (int v = 0; v < image.height; ++v) {
    if (image.HasDepth(u, v)) return true;
  }
  return false;
}

Field FieldOf(const RgbdImage& image) {
  Field field{0, image.width - 1, 0, image.height - 1};
  const auto trim = [](int& edge, int step, int end, const auto& has_depth) {
    for (int i = 0, at = edge; i <= kWidestMargin_px && at != end; ++i, at += step) {
      if (has_depth(at)) {
        edge = at;
        return;
      }
    }
  };
  const auto column = [&](int u) { return ColumnHasDepth(image, u); };
  const auto row = [&](int v) { return RowHasDepth(image, v); };
  trim(field.left, 1, image.width, column);
  trim(field.right, -1, -1, column);
  trim(field.top, 1, image.height, row);
  trim(field.bottom, -1, -1, row);
  return field;
}

/// Looks outward from the contours of one image.
class Lookout {
 public:
  Lookout(const RgbdImage& image, const LabelImage& labels, const std::optional<Plane>& table_C)
      : image_(image), labels_(labels), table_C_(table_C), field_(FieldOf(image)) {}

  /// The median depth of the object's pixels around one of them; of two the nearer.
  float DepthOfObject(Pixel p) const;
  Look Outward(const std::vector<Pixel>& contour, size_t at) const;

 private:
  Eigen::Vector2f Direction(const std::vector<Pixel>& contour, size_t at) const;
  float DepthAtRimsRay(Pixel rim, Pixel beyond) const;
  float DepthAt(Pixel p) const { return image_.depth_m[image_.Index(p.u, p.v)]; }

  const RgbdImage& image_;
  const LabelImage& labels_;
  const std::optional<Plane>& table_C_;
  const Field field_;
};

/// Many times faster than std::lround.
int Round(float x) { return static_cast<int>(x + (x < 0 ? -0.5f : 0.5f)); }

float Median(float* begin, float* end) {
  float* middle = begin + (end - begin - 1) / 2;
  std::nth_element(begin, middle, end);
  return *middle;
}

float Lookout::DepthOfObject(Pixel p) const {
  std::array<float, 9> depths;
  float* end = depths.data();
  const uint16_t label = labels_.At(p);
  for (int v = p.v - 1; v <= p.v + 1; ++v) {
    for (int u = p.u - 1; u <= p.u + 1; ++u) {
      if (labels_.At({u, v}) == label) *end++ = DepthAt({u, v});
    }
  }
  return Median(depths.data(), end);
}

/// Unit normal of the contour, away from the object.
Eigen::Vector2f Lookout::Direction(const std::vector<Pixel>& contour, size_t at) const {
  const size_t n = contour.size();
  const size_t reach = std::min<size_t>(kTangent_px, (n - 1) / 2);
  const Pixel before = contour[(at + n - reach) % n], after = contour[(at + reach) % n];
  Eigen::Vector2f normal(static_cast<float>(after.v - before.v),
                         static_cast<float>(before.u - after.u));
  if (normal.isZero()) {  // at the tip of a thin piece
    const uint16_t label = labels_.At(contour[at]);
    for (const Pixel d : {Pixel{0, -1}, Pixel{1, 0}, Pixel{-1, 0}, Pixel{0, 1}}) {
      if (labels_.At({contour[at].u + d.u, contour[at].v + d.v}) == label) continue;
      normal += Eigen::Vector2f(static_cast<float>(d.u), static_cast<float>(d.v));
    }
    if (normal.isZero()) normal = -Eigen::Vector2f::UnitY();
  }
  return normal.normalized();
}

/// The depth of what is seen at `beyond`, continued to the ray of `rim` where it is the table.
float Lookout::DepthAtRimsRay(Pixel rim, Pixel beyond) const {
  const float depth = DepthAt(beyond);
  if (!table_C_) return depth;
  const double height_m = table_C_->Distance(image_.Point(beyond.u, beyond.v));
  if (std::abs(height_m) > ClearStep(depth)) return depth;
  const double fall = table_C_->normal.dot(image_.intrinsics.Unproject(rim.u, rim.v, 1));
  const double continued = -table_C_->offset_m / fall;
  return continued > 0 && std::isfinite(continued) ? static_cast<float>(continued) : depth;
}

Look Lookout::Outward(const std::vector<Pixel>& contour, size_t at) const {
  const Pixel rim = contour[at];
  const uint16_t label = labels_.At(rim);
  Look look{rim, DepthOfObject(rim), Look::kNothing};
  const Eigen::Vector2f direction = Direction(contour, at);
  std::array<float, kBeyond> depths;
  int seen = 0;
  bool outside = false, cut_off = false;
  for (int i = 1; i <= kWidestGap_px + 1 + seen && seen < kBeyond; ++i) {
    const float s = static_cast<float>(i);
    const Pixel p{rim.u + Round(s * direction.x()), rim.v + Round(s * direction.y())};
    if (!field_.Contains(p)) {
      cut_off = i <= kNearBorder_px + 1;
      break;
    }
    if (labels_.At(p) == label) {
      if (outside || i > kTangent_px) {
        look.kind = Look::kItself;
        return look;
      }
      continue;  // a step of the contour
    }
    outside = true;
    if (DepthAt(p) > 0) depths[static_cast<size_t>(seen++)] = DepthAtRimsRay(rim, p);
  }
  look.kind = cut_off ? Look::kBorder : Look::kNothing;
  if (seen == 0) return look;
  look.step_m = Median(depths.data(), depths.data() + seen) - look.rim_m;
  if (!cut_off || std::abs(look.step_m) > ClearStep(look.rim_m)) look.kind = Look::kStep;
  return look;
}

/// What most of the rays around one contour pixel say; steps by their median.
Beyond Decide(const std::vector<Look>& looks, size_t at) {
  std::array<float, 2 * kRays + 1> steps;
  int n_steps = 0, n_nothing = 0, n_border = 0;
  const size_t n = looks.size();
  for (size_t i = at + n * kRays - kRays; i <= at + n * kRays + kRays; ++i) {
    const Look& look = looks[i % n];
    if (look.kind == Look::kStep) steps[static_cast<size_t>(n_steps++)] = look.step_m;
    n_nothing += look.kind == Look::kNothing;
    n_border += look.kind == Look::kBorder;
  }
  if (n_border > std::max(n_steps, n_nothing)) return Beyond::kImageBorder;
  if (n_nothing > n_steps || n_steps == 0) return Beyond::kUnknown;
  const float step_m = Median(steps.data(), steps.data() + n_steps);
  if (std::abs(step_m) <= ClearStep(looks[at].rim_m)) return Beyond::kLevel;
  return step_m > 0 ? Beyond::kFarther : Beyond::kNearer;
}

/// What is seen from the contours of one object's pieces.
struct Outline {
  struct Place {
    size_t contour = 0, at = 0;
  };
  std::vector<std::vector<Look>> contours;
  std::vector<Place> places;  // beside which something other than the object lies
};

void AddContour(const Lookout& lookout, const std::vector<Pixel>& contour, Outline& outline) {
  const size_t stride = (contour.size() + kMostRays - 1) / kMostRays;
  std::vector<Look>& looks = outline.contours.emplace_back();
  for (size_t i = 0; i < contour.size(); i += stride) {
    looks.push_back(lookout.Outward(contour, i));
    if (looks.back().kind == Look::kItself) continue;
    outline.places.push_back({outline.contours.size() - 1, looks.size() - 1});
  }
}

std::vector<RimPoint> Spread(const RgbdImage& image, const Outline& outline, size_t most) {
  const size_t n = std::min(most, outline.places.size());
  std::vector<RimPoint> rim;
  rim.reserve(n);
  for (size_t k = 0; k < n; ++k) {
    const auto [contour, at] = outline.places[(2 * k + 1) * outline.places.size() / (2 * n)];
    const Look& look = outline.contours[contour][at];
    rim.push_back({image.intrinsics.Unproject(look.rim.u, look.rim.v, look.rim_m).cast<float>(),
                   Decide(outline.contours[contour], at)});
  }
  return rim;
}

}  // namespace

float ClearStep(float z_m) {
  const float from_best_m = z_m - 0.4f;
  return std::max(0.008f, 3 * (0.0012f + 0.0019f * from_best_m * from_best_m));
}

std::vector<std::vector<RimPoint>> FindRims(const RgbdImage& image,
                                            std::span<const uint16_t> labels, int n_objects,
                                            const std::optional<Plane>& table_C, int most) {
  std::vector<std::vector<RimPoint>> rims(static_cast<size_t>(std::max(n_objects, 0)));
  const size_t n_pixels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  if (labels.size() != n_pixels || image.depth_m.size() != n_pixels || most <= 0) return rims;
  const LabelImage label_image{labels, image.depth_m, image.width, image.height, n_objects};
  const std::vector<Piece> pieces = FindPieces(label_image);
  std::vector<int> size(rims.size() + 1, 0);
  for (const Piece& piece : pieces) size[piece.label] += piece.n_pixels;

  const Lookout lookout(image, label_image, table_C);
  std::vector<Outline> outlines(rims.size());
  for (const Piece& piece : pieces) {
    if (piece.n_pixels * kSmallestPart < size[piece.label]) continue;
    AddContour(lookout, TraceOuterContour(label_image, piece.first), outlines[piece.label - 1u]);
  }
  for (size_t i = 0; i < rims.size(); ++i) {
    rims[i] = Spread(image, outlines[i], static_cast<size_t>(most));
  }
  return rims;
}

}  // namespace beckon
