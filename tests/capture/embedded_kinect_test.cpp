// The depth camera's noise: its steps, its strength, its correlation, where it sees nothing.
#include "services/capture/embedded_kinect.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <set>

namespace beckon::capture {
namespace {

constexpr int kWidth = 320, kHeight = 240;

/// A table seen at a slant: disparity is linear in the image.
Rendering Slanted() {
  Rendering r;
  r.window = {0, 0, kWidth, kHeight};
  const size_t n = r.window.Size();
  r.labels.assign(n, 1);
  r.incidence.assign(n, 0.7f);
  r.metal.assign(n, 0);
  r.unlit.assign(n, 0);
  r.colour.assign(n, Eigen::Vector3f::Constant(100));
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u)
      r.depth_m.push_back(static_cast<float>(1 / (1.1 + 0.0022 * (v - 120))));
  }
  return r;
}

/// Deviation of the disparity from a plane within patches, median of all, in px.
double PlaneResidual(const std::vector<float>& depth_m, const DepthNoise& noise, int half) {
  std::vector<double> all;
  for (int v = half; v < kHeight - half; v += 2 * half + 1) {
    for (int u = half; u < kWidth - half; u += 2 * half + 1) {
      const int side = 2 * half + 1, n = side * side;
      Eigen::MatrixXd a(n, 3);
      Eigen::VectorXd b(n);
      for (int i = 0; i < n; ++i) {
        const int x = i % side - half, y = i / side - half;
        a.row(i) << 1, x, y;
        b[i] = noise.baseline_focal_m_px / depth_m[size_t(v + y) * kWidth + u + x];
      }
      all.push_back(std::sqrt((b - a * a.colPivHouseholderQr().solve(b)).squaredNorm() / n));
    }
  }
  std::nth_element(all.begin(), all.begin() + all.size() / 2, all.end());
  return all[all.size() / 2];
}

TEST(KinectDepthTest, NoiseIsAsMeasuredOnTables) {
  // 45 frames of tables: .072 px within 13x13 px and .080 within 25x25 where a px is of 39.4 m px,
  // that is .078 and .087 here; 72 % of neighbours in a row are equal.
  const DepthNoise noise;
  Random random(3);
  const auto depth = SimulateDepth(Slanted(), noise, random).depth_m;
  EXPECT_NEAR(PlaneResidual(depth, noise, 6), 0.078, 0.008);
  EXPECT_NEAR(PlaneResidual(depth, noise, 12), 0.087, 0.008);
  int equal = 0, pairs = 0;
  for (size_t i = 0; i + 1 < depth.size(); ++i) equal += depth[i] == depth[i + 1], ++pairs;
  EXPECT_NEAR(static_cast<double>(equal) / pairs, 0.72, 0.03);
}

/// How sharp the crease of a roof is: second differences of disparity at 3 and 12 px, by their
/// ratio.
double CreaseSharpness(double smoothing_px) {
  Rendering roof = Slanted();
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      roof.depth_m[size_t(v) * kWidth + u] = float(1 / (1.4 - 0.0025 * std::abs(v - kHeight / 2)));
    }
  }
  DepthNoise noise;
  noise.smoothing_px = smoothing_px;
  Random random(5);
  const auto depth = SimulateDepth(roof, noise, random).depth_m;
  const auto row = [&](int v) {
    double sum = 0;
    for (int u = 20; u < kWidth - 20; ++u)
      sum += noise.baseline_focal_m_px / depth[size_t(v) * kWidth + u];
    return sum;
  };
  const int top = kHeight / 2;
  const auto bend = [&](int by) { return 2 * row(top) - row(top - by) - row(top + by); };
  return bend(3) / bend(12);
}

TEST(KinectDepthTest, RoundsCreasesAsThoseOfRealBoxesAre) {
  // .25 without smoothing; .13 on the front edges of the boxes in 45 frames of tables.
  EXPECT_GT(CreaseSharpness(0.1), 0.22);
  EXPECT_NEAR(CreaseSharpness(DepthNoise{}.smoothing_px), 0.13, 0.02);
}

TEST(KinectDepthTest, EveryCameraIsOfAKnownKind) {
  Random random(6);
  int with_steps = 0, with_flying = 0;
  constexpr int kCameras = 200;
  for (int i = 0; i < kCameras; ++i) {
    const DepthCamera camera = RandomDepthCamera(random);
    EXPECT_GT(camera.intrinsics.fx, 340);
    EXPECT_LT(camera.intrinsics.fx, 630);
    with_steps += camera.noise.step_px == DepthNoise{}.step_px;
    with_flying += camera.noise.flying > 0;
  }
  EXPECT_GT(with_steps, kCameras / 3);
  EXPECT_GT(with_flying, kCameras / 10);
}

TEST(KinectDepthTest, TimeOfFlightMixesDepthsAtOutlines) {
  Rendering step = Slanted();
  for (size_t i = 0; i < step.depth_m.size(); ++i) {
    step.depth_m[i] = i % kWidth < kWidth / 2 ? 0.8f : 1.6f;
    step.labels[i] = i % kWidth < kWidth / 2 ? 1 : 2;
  }
  const auto between = [&](double flying) {
    DepthNoise noise;
    noise.flying = flying;
    noise.edge_dropout = 0;
    Random random(7);
    const auto depth = SimulateDepth(step, noise, random).depth_m;
    return std::count_if(depth.begin(), depth.end(), [](float z) { return z > 0.9f && z < 1.4f; });
  };
  EXPECT_EQ(between(0), 0);
  EXPECT_GT(between(0.5), kHeight / 4);
}

TEST(KinectDepthTest, DepthComesInWholeMillimetresAndFewSteps) {
  Random random(4);
  std::set<float> near_a_metre;
  for (float z : SimulateDepth(Slanted(), {}, random).depth_m) {
    EXPECT_NEAR(z * 1000, std::round(z * 1000), 1e-3);
    if (z > 0.9 && z < 1.0) near_a_metre.insert(z);
  }
  EXPECT_LE(near_a_metre.size(), 39u);  // the sensor has 38 values there
  EXPECT_GE(near_a_metre.size(), 36u);
}

TEST(KinectDepthTest, SeesNothingWhereThePatternIsLost) {
  const auto share = [](const Rendering& r) {
    Random random(5);
    const auto depth = SimulateDepth(r, {}, random).depth_m;
    return static_cast<double>(std::count(depth.begin(), depth.end(), 0.0f)) /
           static_cast<double>(depth.size());
  };
  Rendering r = Slanted();
  EXPECT_EQ(share(r), 0);
  r.unlit.assign(r.unlit.size(), 1);
  EXPECT_NEAR(share(r), DepthNoise{}.shadow_dropout, 0.05);
  r = Slanted();
  r.incidence.assign(r.incidence.size(), 0.05f);
  EXPECT_GT(share(r), 0.95);
  r = Slanted();
  r.metal.assign(r.metal.size(), 0.5f);
  EXPECT_GT(share(r), 0.1);
  r = Slanted();
  r.depth_m.assign(r.depth_m.size(), 0.0f);
  EXPECT_EQ(share(r), 1);
}

TEST(KinectDepthTest, LosesSomeOfWhatIsBlack) {
  const auto lost = [](float brightness) {
    Rendering r = Slanted();
    r.colour.assign(r.window.Size(), Eigen::Vector3f::Constant(brightness));
    Random random(8);
    const auto depth = SimulateDepth(r, {}, random).depth_m;
    return static_cast<double>(std::count(depth.begin(), depth.end(), 0.0f)) /
           static_cast<double>(depth.size());
  };
  EXPECT_EQ(lost(100), 0);
  EXPECT_NEAR(lost(10), 0.086, 0.03);
}

TEST(KinectDepthTest, LabelsGoWithTheDepthTheyWereTakenFrom) {
  Rendering r = Slanted();
  for (int v = 60; v < 180; ++v) {
    for (int u = 100; u < 200; ++u) {
      r.depth_m[size_t(v) * kWidth + u] = 0.5f;
      r.labels[size_t(v) * kWidth + u] = 2;
    }
  }
  Random random(6);
  const auto out = SimulateDepth(r, {}, random);
  int strayed = 0;
  for (size_t i = 0; i < out.depth_m.size(); ++i) {
    if (out.depth_m[i] == 0) {
      EXPECT_EQ(out.labels[i], 0);
      continue;
    }
    EXPECT_EQ(out.labels[i] == 2, out.depth_m[i] < 0.55f);
    strayed += out.labels[i] != r.labels[i];
  }
  EXPECT_GT(strayed, 20) << "outlines are ragged";
  EXPECT_LT(strayed, 440) << "by about a pixel";
}

TEST(SmoothNoiseTest, HasUnitVariance) {
  Random random(8);
  for (const auto& [u, v] : {std::pair{0.1, 0.1}, {0.7, 0.6}, {3.2, 1.5}, {8.0, 4.0}}) {
    double sum = 0, squares = 0;
    const auto noise = SmoothNoise(512, 512, u, v, random);
    for (float x : noise) sum += x, squares += x * x;
    const double n = static_cast<double>(noise.size());
    EXPECT_NEAR(sum / n, 0, 0.05);
    EXPECT_NEAR(squares / n, 1, 0.08);
  }
}

}  // namespace
}  // namespace beckon::capture
