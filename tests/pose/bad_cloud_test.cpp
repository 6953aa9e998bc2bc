// Hostile clouds, planes, viewpoints and rims through every method and through the whole estimate.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "services/pose/estimate.h"
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

struct Cloud {
  std::vector<Vector3f> points;
  std::optional<Plane> table;
  Vector3d viewpoint = Vector3d::Zero();
  std::vector<RimPoint> rim;
  bool hopeless = false;  // must not converge

  FitInput input() const { return {points, table, viewpoint, rim}; }
};

class Draws {
 public:
  explicit Draws(unsigned seed) : engine_(seed) {}
  float Uniform(float lo, float hi) {
    return std::uniform_real_distribution<float>(lo, hi)(engine_);
  }
  size_t Index(size_t count) {
    return std::uniform_int_distribution<size_t>(0, count - 1)(engine_);
  }
  Vector3f Cube() { return {Uniform(-1, 1), Uniform(-1, 1), Uniform(-1, 1)}; }
  Vector3f Odd() {
    const float odd[] = {kNan, kInf, -kInf, 1e30f, -1e30f, 1e-42f, 0, -0.0f, 3e38f};
    return {odd[Index(9)], odd[Index(9)], odd[Index(9)]};
  }

 private:
  std::mt19937 engine_;
};

// A view of a box or a can on a table, some hundred points, and its rim.
Cloud SoundCloud(Draws& draws) {
  static const TableView views[] = {
      ViewOnTable(MakeShape({0.04, 0.06, 0.09}, 0.1, 0.1, {0, 0, 0.09}, {0, 0, 0.5}), 400, 0.001),
      ViewOnTable(MakeShape({0.035, 0.035, 0.06}, 0.1, 1, {0, 0, 0.06}), 200, 0.001)};
  const TableView& view = views[draws.Index(2)];
  Cloud cloud{view.points_C, view.table_C, Vector3d::Zero(), {}, false};
  for (int i = 0; i < 48; ++i) {
    cloud.rim.push_back(
        {cloud.points[draws.Index(cloud.points.size())], static_cast<Beyond>(draws.Index(5))});
  }
  return cloud;
}

// What is done to a sound cloud.
using Damage = std::function<void(Cloud&, Draws&)>;
const std::vector<std::pair<const char*, Damage>>& Damages() {
  static const std::vector<std::pair<const char*, Damage>> damages{
      {"nothing", [](Cloud&, Draws&) {}},
      {"few points",
       [](Cloud& c, Draws& d) {
         c.points.resize(d.Index(20));
         c.hopeless = true;
       }},
      {"about as few as may be", [](Cloud& c, Draws& d) { c.points.resize(20 + d.Index(15)); }},
      {"on a plane",
       [](Cloud& c, Draws&) {
         for (auto& p : c.points) p.z() = 0.8f;
         c.hopeless = true;
       }},
      {"on a line",
       [](Cloud& c, Draws&) {
         for (auto& p : c.points) p = Vector3f(p.x(), 2 * p.x(), 0.8f);
         c.hopeless = true;
       }},
      {"in one place",
       [](Cloud& c, Draws&) {
         std::fill(c.points.begin(), c.points.end(), Vector3f(c.points[0]));
         c.hopeless = true;
       }},
      {"in two places",
       [](Cloud& c, Draws&) {
         for (size_t i = 0; i < c.points.size(); ++i) c.points[i] = c.points[i % 2];
         c.hopeless = true;
       }},
      {"odd numbers mixed in",
       [](Cloud& c, Draws& d) {
         for (int i = 0; i < 50; ++i) c.points[d.Index(c.points.size())] = d.Odd();
       }},
      {"nothing but odd numbers",
       [](Cloud& c, Draws& d) {
         for (auto& p : c.points) p = d.Odd();
         c.hopeless = true;
       }},
      {"millimetres",
       [](Cloud& c, Draws&) {
         for (auto& p : c.points) p *= 1000;
         c.hopeless = true;
       }},
      {"tiny",
       [](Cloud& c, Draws&) {
         for (auto& p : c.points) p *= 1e-40f;
         c.hopeless = true;
       }},
      {"a few flyers",
       [](Cloud& c, Draws& d) {
         for (int i = 0; i < 3; ++i) c.points[d.Index(c.points.size())] = d.Cube();
       }},
      {"far away, where floats are coarse",
       [](Cloud& c, Draws&) {
         for (auto& p : c.points) p += Vector3f(0, 0, 3e5f);
       }},
      {"a normal of some length",
       [](Cloud& c, Draws& d) {
         c.table->normal *= d.Index(2) == 0 ? 2 : 1e-5;
         c.hopeless = true;
       }},
      {"no normal",
       [](Cloud& c, Draws& d) {
         c.table->normal =
             d.Index(2) == 0 ? Vector3d::Zero().eval() : Vector3d(0, static_cast<double>(kNan), 0);
         c.hopeless = true;
       }},
      {"no offset",
       [](Cloud& c, Draws& d) {
         c.table->offset_m = static_cast<double>(d.Index(2) == 0 ? kNan : kInf);
         c.hopeless = true;
       }},
      {"a plane high above",
       [](Cloud& c, Draws&) {
         c.table->offset_m -= 0.3;
         c.hopeless = true;
       }},
      {"a plane far below", [](Cloud& c, Draws&) { c.table->offset_m += 0.3; }},
      {"any plane",
       [](Cloud& c, Draws& d) {
         c.table->normal = d.Cube().cast<double>().normalized();
         c.table->offset_m = static_cast<double>(d.Uniform(-1, 1));
       }},
      {"no table", [](Cloud& c, Draws&) { c.table.reset(); }},
      {"seen from within",
       [](Cloud& c, Draws& d) { c.viewpoint = c.points[d.Index(c.points.size())].cast<double>(); }},
      {"seen from anywhere",
       [](Cloud& c, Draws& d) {
         c.viewpoint = c.points[0].cast<double>() + 0.3 * d.Cube().cast<double>();
         if (d.Index(2) == 0) c.rim.clear();
       }},
      {"seen from nowhere",
       [](Cloud& c, Draws&) {
         c.viewpoint.y() = static_cast<double>(kNan);
         c.hopeless = true;
       }},
      {"seen from far away", [](Cloud& c, Draws&) { c.viewpoint.z() = -1e30; }},
      {"a rim of odd numbers",
       [](Cloud& c, Draws& d) {
         for (auto& r : c.rim) r.point = d.Odd();
       }},
      {"a rim in one place",
       [](Cloud& c, Draws&) {
         for (auto& r : c.rim) r.point = c.rim[0].point;
       }},
      {"a rim of too many points",
       [](Cloud& c, Draws&) {
         while (c.rim.size() < 3000) c.rim.insert(c.rim.end(), c.rim.begin(), c.rim.begin() + 40);
       }},
      {"a filled cube",
       [](Cloud& c, Draws& d) {
         for (auto& p : c.points) p = 0.4f * d.Cube() + Vector3f(0, 0, 1.2f);
         c.table.reset();
       }},
  };
  return damages;
}

bool IsFinite(const Superquadric& s) {
  return s.semi_axes.allFinite() && s.semi_axes.minCoeff() > 0 && s.epsilon.allFinite() &&
         s.taper.allFinite() && s.X_FO.matrix().allFinite();
}

void ExpectSound(const FitResult& fit, const Cloud& cloud) {
  EXPECT_TRUE(IsFinite(fit.shape));
  EXPECT_TRUE(std::all_of(fit.alternatives.begin(), fit.alternatives.end(), IsFinite));
  EXPECT_TRUE(std::all_of(fit.parts.begin(), fit.parts.end(), IsFinite));
  EXPECT_TRUE(fit.covariance.allFinite());
  EXPECT_GE(fit.covariance.diagonal().minCoeff(), 0);
  EXPECT_TRUE(std::isfinite(fit.mean_radial_distance_m));
  EXPECT_GE(fit.mean_radial_distance_m, 0);
  EXPECT_EQ(fit.converged, fit.reason.empty());
  if (cloud.hopeless) {
    EXPECT_FALSE(fit.converged);
  }
}

// `rounds` clouds of each damage, or of two at once.
void ForEachCloud(int rounds, unsigned seed, const std::function<void(const Cloud&)>& check) {
  Draws draws(seed);
  for (int round = 0; round < rounds; ++round) {
    for (const auto& [name, damage] : Damages()) {
      const bool twice = round % 2 == 1;
      const auto& [other_name, other] = Damages()[draws.Index(Damages().size())];
      SCOPED_TRACE(std::string(name) + (twice ? std::string(" after ") + other_name : "") +
                   ", round " + std::to_string(round));
      Cloud cloud = SoundCloud(draws);
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
  ForEachCloud(slow ? 4 : 40, 5,
               [&](const Cloud& cloud) { ExpectSound(Fit(cloud.input(), config), cloud); });
}

TEST(BadCloud, GivesSoundGraspsOrNone) {
  ForEachCloud(20, 6, [&](const Cloud& cloud) {
    const Estimate estimate = EstimateObject(cloud.input(), {});
    ExpectSound(estimate.fit, cloud);
    if (!estimate.fit.converged) {
      EXPECT_TRUE(estimate.grasps.empty());
    }
    for (const GraspCandidate& grasp : estimate.grasps) {
      EXPECT_TRUE(grasp.X_FG.matrix().allFinite());
      EXPECT_TRUE(std::isfinite(grasp.opening_m) && grasp.opening_m >= 0);
      EXPECT_TRUE(grasp.score >= 0 && grasp.score <= 1);
      EXPECT_TRUE(grasp.contacts_F[0].allFinite() && grasp.contacts_F[1].allFinite());
    }
  });
}

TEST_P(BadCloudTest, IsToldWhatIsWrongWithItsTable) {
  FitConfig config;
  config.method = GetParam();
  Draws draws(1);
  const Cloud sound = SoundCloud(draws);
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
  Cloud cloud = SoundCloud(draws);
  for (auto& p : cloud.points) p *= 1000;
  EXPECT_THAT(Fit(cloud.input(), {}).reason, HasSubstr("millimetres"));
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
