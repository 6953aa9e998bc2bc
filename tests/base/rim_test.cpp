// What lies beyond the rim of an object, on images drawn by hand.
#include "services/base/rim.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "services/base/rim_contour.h"

namespace beckon {
namespace {

/// A wall 1.2 m away, on which rectangles are drawn over each other.
struct Drawing {
  RgbdImage image;
  std::vector<uint16_t> labels;

  Drawing(int width = 160, int height = 120) {
    image.width = width;
    image.height = height;
    image.intrinsics = {140, 140, (width - 1) / 2.0, (height - 1) / 2.0};
    image.depth_m.assign(static_cast<size_t>(width) * height, 1.2f);
    labels.assign(image.depth_m.size(), 0);
  }
  /// Columns left .. right - 1, rows top .. bottom - 1; a depth of 0 is a shadow.
  void Fill(int left, int right, int top, int bottom, float depth_m, uint16_t label = 0) {
    for (int v = top; v < bottom; ++v) {
      for (int u = left; u < right; ++u) {
        image.depth_m[image.Index(u, v)] = depth_m;
        labels[image.Index(u, v)] = label;
      }
    }
  }
  std::vector<RimPoint> Rim(uint16_t label = 1, int most = kMaxRim) const {
    return FindRims(image, labels, 2, table_C, most)[label - 1u];
  }
  Eigen::Vector2d Pixel(const RimPoint& point) const {
    return image.intrinsics.Project(point.point.cast<double>());
  }

  std::optional<Plane> table_C;
};

using Counts = std::map<Beyond, int>;

/// Of the rim's points whose pixels lie in [left, right) x [top, bottom).
Counts Count(const Drawing& drawing, const std::vector<RimPoint>& rim, double left = -1e9,
             double right = 1e9, double top = -1e9, double bottom = 1e9) {
  Counts counts;
  for (const RimPoint& point : rim) {
    const Eigen::Vector2d p = drawing.Pixel(point);
    if (p.x() >= left && p.x() < right && p.y() >= top && p.y() < bottom) ++counts[point.beyond];
  }
  return counts;
}

TEST(Rim, OfABoxBeforeAWallIsAllItsOwn) {
  Drawing drawing;
  drawing.Fill(60, 100, 40, 80, 0.8f, 1);
  const auto rim = drawing.Rim();
  EXPECT_EQ(rim.size(), 96u);
  EXPECT_EQ(Count(drawing, rim), (Counts{{Beyond::kFarther, 96}}));
  for (const RimPoint& point : rim) {
    const Eigen::Vector2d p = drawing.Pixel(point);
    EXPECT_NEAR(point.point.z(), 0.8, 1e-6);
    EXPECT_NEAR(std::max(std::abs(p.x() - 79.5), std::abs(p.y() - 59.5)), 19.5, 1e-3)
        << "on the border of the square";
  }
  for (double side : {0.0, 80.0}) {  // 156 pixels around, evenly shared by the sides
    EXPECT_NEAR(Count(drawing, rim, side, side + 80)[Beyond::kFarther], 48, 2);
    EXPECT_NEAR(Count(drawing, rim, -1e9, 1e9, side - 20, side + 60)[Beyond::kFarther], 48, 2);
  }
}

TEST(Rim, HasNoMorePointsThanAskedForAndGoesClockwise) {
  Drawing drawing;
  drawing.Fill(60, 100, 40, 80, 0.8f, 1);
  for (int most : {0, 1, 2, 7, 24}) {
    EXPECT_EQ(drawing.Rim(1, most).size(), static_cast<size_t>(most));
  }
  const auto rim = drawing.Rim(1, 24);
  double twice_area = 0;
  for (size_t i = 0; i < rim.size(); ++i) {
    const Eigen::Vector2d a = drawing.Pixel(rim[i]), b = drawing.Pixel(rim[(i + 1) % rim.size()]);
    twice_area += a.x() * b.y() - b.x() * a.y();
  }
  EXPECT_GT(twice_area, 2 * 0.8 * 39 * 39);
}

TEST(Rim, IsCutOffByANearerBar) {
  Drawing drawing;
  drawing.Fill(60, 100, 40, 80, 0.8f, 1);
  drawing.Fill(0, 160, 70, 76, 0.6f);  // leaves a strip of the box below it
  const auto rim = drawing.Rim();
  EXPECT_EQ(Count(drawing, rim, 62, 98, 68, 78)[Beyond::kFarther], 0);
  EXPECT_GT(Count(drawing, rim, 62, 98, 68, 70)[Beyond::kNearer], 10) << "the piece above it";
  EXPECT_GT(Count(drawing, rim, 62, 98, 76, 77)[Beyond::kNearer], 10) << "the piece below it";
  EXPECT_EQ(Count(drawing, rim, 0, 160, 0, 67)[Beyond::kNearer], 0);
  EXPECT_GT(Count(drawing, rim, 0, 160, 0, 67)[Beyond::kFarther], 20);
}

TEST(Rim, IsCutOffByTheEndOfTheImageAndOfItsDepth) {
  for (int margin : {0, 8}) {  // registered depth lacks some columns at the side
    Drawing drawing;
    drawing.Fill(0, 30, 40, 80, 0.8f, 1);
    drawing.Fill(0, margin, 0, 120, 0);
    const auto rim = drawing.Rim();
    const Counts side = Count(drawing, rim, margin - 0.5, margin + 0.5, 43, 77);
    EXPECT_EQ(side.size(), 1u) << margin;
    EXPECT_GT(side.at(Beyond::kImageBorder), 15) << margin;
    EXPECT_EQ(Count(drawing, rim, margin + 2.5)[Beyond::kImageBorder], 0) << margin;
    EXPECT_GT(Count(drawing, rim, margin + 2.5)[Beyond::kFarther], 40) << margin;
  }
}

TEST(Rim, IsLevelWithWhatTouchesIt) {
  Drawing drawing;
  drawing.Fill(60, 80, 40, 80, 0.8f, 1);
  drawing.Fill(80, 100, 40, 80, 0.803f, 2);
  const auto left = drawing.Rim(1), right = drawing.Rim(2);
  EXPECT_GT(Count(drawing, left, 78.5, 80, 42, 78)[Beyond::kLevel], 15);
  EXPECT_EQ(Count(drawing, left, 78.5, 80, 42, 78).size(), 1u);
  EXPECT_EQ(Count(drawing, left, 0, 77)[Beyond::kLevel], 0);
  EXPECT_GT(Count(drawing, right, 79.5, 81, 42, 78)[Beyond::kLevel], 15);
  EXPECT_EQ(Count(drawing, right, 82)[Beyond::kLevel], 0);
}

TEST(Rim, LooksAcrossAShadowButNotAcrossAChasm) {
  for (int shadow : {5, 20, 21, 40}) {
    Drawing drawing;
    drawing.Fill(60, 100, 40, 80, 0.8f, 1);
    drawing.Fill(100, 100 + shadow, 0, 120, 0);
    const Counts right = Count(drawing, drawing.Rim(), 98.5, 100, 43, 77);
    EXPECT_EQ(right.size(), 1u) << shadow;
    EXPECT_EQ(right.begin()->first, shadow <= 20 ? Beyond::kFarther : Beyond::kUnknown) << shadow;
  }
}

TEST(Rim, DoesNotGoAroundHoles) {
  Drawing whole;
  whole.Fill(60, 100, 40, 80, 0.8f, 1);
  Drawing holed = whole;
  holed.Fill(70, 90, 50, 60, 0, 1);  // no depth
  holed.Fill(70, 90, 65, 72, 1.2f);  // the wall seen through a handle
  EXPECT_EQ(holed.Rim(), whole.Rim());
  Drawing slit = whole;  // no depth from the middle to the side
  slit.Fill(75, 100, 58, 62, 0);
  EXPECT_EQ(Count(slit, slit.Rim(), 78, 96, 50, 70), Counts{});
}

TEST(Rim, IsNotMovedByFlyingPixels) {
  Drawing drawing;
  drawing.Fill(60, 100, 40, 80, 0.8f, 1);
  for (int v = 40; v < 80; v += 2) {  // mixed of object and wall, beyond and in the object
    drawing.Fill(100, 101, v, v + 1, 0.801f);
    drawing.Fill(99, 100, v, v + 1, 1.1f, 1);
  }
  const auto rim = drawing.Rim();
  EXPECT_EQ(Count(drawing, rim), (Counts{{Beyond::kFarther, 96}}));
  for (const RimPoint& point : rim) EXPECT_NEAR(point.point.z(), 0.8, 1e-6);
}

TEST(Rim, IsToldFromNoise) {
  Drawing drawing(320, 240);
  drawing.Fill(100, 200, 80, 180, 1.0f, 1);
  drawing.Fill(200, 300, 80, 180, 1.0f);  // as deep
  drawing.Fill(0, 100, 80, 180, 1.04f);   // 4 cm behind
  std::mt19937 engine(3);
  std::normal_distribution<float> noise(0, 0.002f);
  for (float& z : drawing.image.depth_m) z += noise(engine);
  const auto rim = drawing.Rim();
  const Counts left = Count(drawing, rim, 0, 102, 85, 175),
               right = Count(drawing, rim, 198, 320, 85, 175);
  EXPECT_GT(left.at(Beyond::kFarther), 15);
  EXPECT_EQ(left.size(), 1u);
  EXPECT_GT(right.at(Beyond::kLevel), 15);
  EXPECT_EQ(right.size(), 1u);
}

/// A box with a vertical front on a table, seen from 40 degrees above; what is not box is table.
Drawing BoxOnTable(int shadow_px) {
  Drawing drawing(320, 240);
  drawing.image.intrinsics = {262, 262, 159.5, 119.5};
  const Eigen::Vector3d up(0, -std::cos(0.7), -std::sin(0.7)),
      front(0, -std::sin(0.7), std::cos(0.7));
  drawing.table_C = Plane{up, 0.8 * std::sin(0.7)};  // through the optical axis at 0.8 m
  const Plane face{-front, 0.75 * std::cos(0.7)};
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      const Eigen::Vector3d ray = drawing.image.intrinsics.Unproject(u, v, 1);
      const double table_m = -drawing.table_C->offset_m / up.dot(ray);
      const double face_m = face.offset_m / front.dot(ray);
      const bool box = u >= 130 && u < 190 && v > 60 && face_m < table_m;
      drawing.image.depth_m[drawing.image.Index(u, v)] = static_cast<float>(box ? face_m : table_m);
      drawing.labels[drawing.image.Index(u, v)] = box;
    }
  }
  for (int u = 130; u < 190; ++u) {  // a shadow under its foot
    int v = 239;
    while (drawing.labels[drawing.image.Index(u, v)] == 0) --v;
    for (int i = 1; i <= shadow_px; ++i) drawing.image.depth_m[drawing.image.Index(u, v + i)] = 0;
  }
  return drawing;
}

TEST(Rim, OfAnObjectsFootIsLevelWithTheTableHoweverWideTheShadow) {
  for (int shadow : {0, 6, 15}) {
    const Drawing drawing = BoxOnTable(shadow);
    const auto rim = drawing.Rim();
    double foot = 0;
    for (const RimPoint& point : rim) foot = std::max(foot, drawing.Pixel(point).y());
    const Counts below = Count(drawing, rim, 133, 187, foot - 0.5);
    EXPECT_EQ(below.size(), 1u) << shadow;
    EXPECT_GT(below.at(Beyond::kLevel), 15) << shadow;
    EXPECT_EQ(Count(drawing, rim)[Beyond::kNearer], 0) << shadow;
    const Counts above = Count(drawing, rim, 0, 320, 0, foot - 12);
    EXPECT_EQ(above.size(), 1u) << shadow;
    EXPECT_GT(above.at(Beyond::kFarther), 40) << shadow;
  }
}

TEST(Rim, OfEveryObjectIsFoundInOnePassTheSameEachTime) {
  Drawing drawing;
  drawing.Fill(20, 50, 40, 80, 0.8f, 2);
  drawing.Fill(90, 130, 40, 80, 0.7f, 1);
  drawing.Fill(140, 150, 40, 80, 0.7f, 3);  // beyond the number of objects
  const auto rims = FindRims(drawing.image, drawing.labels, 2, std::nullopt);
  ASSERT_EQ(rims.size(), 2u);
  EXPECT_GT(rims[0].front().point.x(), 0);
  EXPECT_LT(rims[1].front().point.x(), 0);
  EXPECT_EQ(rims, FindRims(drawing.image, drawing.labels, 2, std::nullopt));
}

TEST(Rim, OfNothingIsEmpty) {
  Drawing drawing;
  EXPECT_EQ(drawing.Rim(), std::vector<RimPoint>{});
  drawing.Fill(60, 100, 40, 80, 0, 1);  // labelled, without depth
  EXPECT_EQ(drawing.Rim(), std::vector<RimPoint>{});
  drawing.labels.pop_back();
  EXPECT_EQ(drawing.Rim(), std::vector<RimPoint>{});
  EXPECT_TRUE(FindRims(RgbdImage{}, {}, 0, std::nullopt).empty());
  Drawing pixel;
  pixel.Fill(60, 61, 40, 41, 0.8f, 1);
  ASSERT_EQ(pixel.Rim().size(), 1u);
  EXPECT_EQ(pixel.Rim()[0].beyond, Beyond::kFarther);
}

TEST(RimContour, FindsPiecesAsAFloodFillDoes) {
  std::mt19937 engine(5);
  for (int round = 0; round < 200; ++round) {
    const int width = 1 + static_cast<int>(engine() % 12),
              height = 1 + static_cast<int>(engine() % 12);
    std::vector<uint16_t> labels(static_cast<size_t>(width * height));
    for (auto& label : labels) label = static_cast<uint16_t>(engine() % 3);
    const std::vector<float> depth_m(labels.size(), 1.0f);
    const LabelImage image{labels, depth_m, width, height, 2};
    std::vector<uint16_t> left = labels;  // what no piece has claimed yet
    for (const Piece& piece : FindPieces(image)) {
      EXPECT_EQ(left[static_cast<size_t>(piece.first.v * width + piece.first.u)], piece.label);
      std::vector<Pixel> open{piece.first};
      int n_pixels = 0;
      while (!open.empty()) {
        const Pixel p = open.back();
        open.pop_back();
        if (!image.Inside(p)) continue;
        auto& label = left[static_cast<size_t>(p.v * width + p.u)];
        if (label != piece.label) continue;
        label = 0;
        ++n_pixels;
        for (int dv = -1; dv <= 1; ++dv) {
          for (int du = -1; du <= 1; ++du) open.push_back({p.u + du, p.v + dv});
        }
      }
      EXPECT_EQ(piece.n_pixels, n_pixels);
      // The contour is a closed walk along pixels of the piece with a neighbour outside of it.
      const auto contour = TraceOuterContour(image, piece.first);
      for (size_t i = 0; i < contour.size(); ++i) {
        const Pixel a = contour[i], b = contour[(i + 1) % contour.size()];
        EXPECT_LE(std::max(std::abs(a.u - b.u), std::abs(a.v - b.v)), 1);
        EXPECT_EQ(image.At(a), piece.label);
        EXPECT_TRUE(
            image.At({a.u - 1, a.v}) != piece.label || image.At({a.u + 1, a.v}) != piece.label ||
            image.At({a.u, a.v - 1}) != piece.label || image.At({a.u, a.v + 1}) != piece.label);
      }
    }
    EXPECT_EQ(std::count(left.begin(), left.end(), 0), width * height);
  }
}

}  // namespace
}  // namespace beckon
