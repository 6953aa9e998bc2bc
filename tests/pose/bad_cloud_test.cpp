// Hostile clouds, planes, viewpoints and rims through every method and through the whole estimate.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tests/pose/hostile_clouds.h"
#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using ::testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr Method kAllMethods[] = {Method::kAdaptive, Method::kMultiscale, Method::kClassic,
                                  Method::kHierarchical};

// `rounds` clouds of each damage, or of two at once.
void ForEachCloud(int rounds, unsigned seed,
                  const std::function<void(const HostileCloud&)>& check) {
  Draws draws(seed);
  for (int round = 0; round < rounds; ++round) {
    for (const auto& [name, damage] : Damages()) {
      const bool twice = round % 2 == 1;
      const auto& [other_name, other] = Damages()[draws.Index(Damages().size())];
      SCOPED_TRACE(std::string(name) + (twice ? std::string(" after ") + other_name : "") +
                   ", round " + std::to_string(round));
      HostileCloud cloud = SoundCloud(draws);
      if (twice) {
        // What was hopeless may no longer be.
        other(cloud, draws);
        cloud.hopeless = false;
        if (cloud.points.size() < 20 || !cloud.table) continue;
        damage(cloud, draws);
        cloud.hopeless = false;
      } else {
        damage(cloud, draws);
      }
      check(cloud);
      if (::testing::Test::HasFailure()) return;
    }
  }
}

class BadCloudTest : public ::testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(Methods, BadCloudTest, ::testing::ValuesIn(kAllMethods),
                         [](const auto& instance) { return std::string(Name(instance.param)); });

TEST_P(BadCloudTest, IsFittedOrRefusedWithAReason) {
  FitConfig config;
  config.method = GetParam();
  const bool slow = config.method != Method::kAdaptive;
  ForEachCloud(slow ? 4 : 40, 5, [&](const HostileCloud& cloud) {
    const FitResult fit = Fit(cloud.input(), config);
    EXPECT_EQ(Unsound(fit), "");
    EXPECT_FALSE(cloud.hopeless && fit.converged);
  });
}

TEST(BadCloud, GivesSoundGraspsOrNone) {
  ForEachCloud(20, 6, [&](const HostileCloud& cloud) {
    const Estimate estimate = EstimateObject(cloud.input(), {});
    EXPECT_EQ(Unsound(estimate), "");
    EXPECT_FALSE(cloud.hopeless && estimate.fit.converged);
  });
}

TEST_P(BadCloudTest, IsToldWhatIsWrongWithItsTable) {
  FitConfig config;
  config.method = GetParam();
  Draws draws(1);
  const HostileCloud sound = SoundCloud(draws);
  const auto reason = [&](const Plane& table) {
    const FitResult result = Fit({sound.points, table}, config);
    EXPECT_EQ(result.converged, result.reason.empty());
    return result.reason;
  };
  Plane table = *sound.table;
  EXPECT_EQ(reason(table), "");
  table.normal *= 2;
  EXPECT_THAT(reason(table), HasSubstr("its normal has length 2"));
  table.normal.setZero();
  EXPECT_THAT(reason(table), HasSubstr("its normal has length 0"));
  table.normal.setConstant(static_cast<double>(kNan));
  EXPECT_THAT(reason(table), HasSubstr("its normal has length"));
  table = *sound.table;
  table.offset_m = static_cast<double>(kNan);
  EXPECT_THAT(reason(table), HasSubstr("offset"));
  table = *sound.table;
  table.offset_m -= 0.12;  // cuts through the object
  EXPECT_THAT(reason(table), HasSubstr("below the table's plane"));
  config.max_below_share = 1;
  EXPECT_THAT(reason(table), ::testing::Not(HasSubstr("below the table's plane")));
}

TEST(BadCloud, OfMillimetresSaysSo) {
  Draws draws(2);
  HostileCloud cloud = SoundCloud(draws);
  for (auto& p : cloud.points) p *= 1000;
  EXPECT_THAT(Fit(cloud.input(), {}).reason, HasSubstr("millimetres"));
}

TEST(BadCloud, FarAwaySaysSo) {
  Draws draws(2);
  HostileCloud cloud = SoundCloud(draws);
  for (auto& p : cloud.points) p.z() += 5e4f;
  const FitResult fit = Fit(cloud.input(), {});
  EXPECT_THAT(fit.reason, HasSubstr("m away, more than 100 m"));
  EXPECT_LT(fit.shape.X_FO.translation().norm(), 600);  // a message carries it
}

TEST(BadCloud, RimPointsThatAreNotFiniteDoNotCount) {
  const TableView view = PixelViewOnTable(MakeShape({0.035, 0.035, 0.06}, 0.1, 1, {0, 0, 0.06}));
  std::vector<RimPoint> rim;
  for (size_t i = 0; i < view.points_C.size(); i += 50) {
    rim.push_back({view.points_C[i], Beyond::kFarther});
  }
  std::vector<RimPoint> dirty = rim;
  dirty.insert(dirty.begin() + 3, {Vector3f(kNan, 0, 1), Beyond::kFarther});
  dirty.push_back({Vector3f(0, kInf, 1), Beyond::kNearer});
  const FitResult a = Fit({view.points_C, view.table_C, Vector3d::Zero(), rim}, {});
  const FitResult b = Fit({view.points_C, view.table_C, Vector3d::Zero(), dirty}, {});
  EXPECT_EQ(a.shape.semi_axes, b.shape.semi_axes);
  EXPECT_EQ(a.shape.X_FO.matrix(), b.shape.X_FO.matrix());
}

}  // namespace
}  // namespace beckon::pose
