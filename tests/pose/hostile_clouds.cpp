// Clouds, tables, viewpoints and rims as they should not be, and what any estimate of them must be.
#include "tests/pose/hostile_clouds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

bool IsSound(const Superquadric& s) {
  return s.semi_axes.allFinite() && s.semi_axes.minCoeff() > 0 && s.epsilon.allFinite() &&
         s.taper.allFinite() && s.X_FO.matrix().allFinite();
}

bool IsSound(const GraspCandidate& grasp) {
  return grasp.X_FG.matrix().allFinite() && std::isfinite(grasp.opening_m) &&
         grasp.opening_m >= 0 && grasp.score >= 0 && grasp.score <= 1 &&
         grasp.contacts_F[0].allFinite() && grasp.contacts_F[1].allFinite();
}

}  // namespace

HostileCloud SoundCloud(Draws& draws) {
  static const TableView views[] = {
      ViewOnTable(MakeShape({0.04, 0.06, 0.09}, 0.1, 0.1, {0, 0, 0.09}, {0, 0, 0.5}), 400, 0.001),
      ViewOnTable(MakeShape({0.035, 0.035, 0.06}, 0.1, 1, {0, 0, 0.06}), 200, 0.001)};
  const TableView& view = views[draws.Index(2)];
  HostileCloud cloud{view.points_C, view.table_C, Vector3d::Zero(), {}, false};
  Draws of_rim(draws());  // one choice, so that bytes are left for others
  for (int i = 0; i < 48; ++i) {
    cloud.rim.push_back(
        {cloud.points[of_rim.Index(cloud.points.size())], static_cast<Beyond>(of_rim.Index(5))});
  }
  return cloud;
}

const std::vector<std::pair<const char*, Damage>>& Damages() {
  static const std::vector<std::pair<const char*, Damage>> damages{
      {"nothing", [](HostileCloud&, Draws&) {}},
      {"few points",
       [](HostileCloud& c, Draws& d) {
         c.points.resize(d.Index(20));
         c.hopeless = true;
       }},
      {"about as few as may be",
       [](HostileCloud& c, Draws& d) { c.points.resize(20 + d.Index(15)); }},
      {"on a plane",
       [](HostileCloud& c, Draws&) {
         for (auto& p : c.points) p.z() = 0.8f;
         c.hopeless = true;
       }},
      {"on a line",
       [](HostileCloud& c, Draws&) {
         for (auto& p : c.points) p = Vector3f(p.x(), 2 * p.x(), 0.8f);
         c.hopeless = true;
       }},
      {"in one place",
       [](HostileCloud& c, Draws&) {
         std::fill(c.points.begin(), c.points.end(), Vector3f(c.points[0]));
         c.hopeless = true;
       }},
      {"in two places",
       [](HostileCloud& c, Draws&) {
         for (size_t i = 0; i < c.points.size(); ++i) c.points[i] = c.points[i % 2];
         c.hopeless = true;
       }},
      {"odd numbers mixed in",
       [](HostileCloud& c, Draws& d) {
         for (int i = 0; i < 50; ++i) c.points[d.Index(c.points.size())] = d.Odd();
       }},
      {"nothing but odd numbers",
       [](HostileCloud& c, Draws& d) {
         for (auto& p : c.points) p = d.Odd();
         c.hopeless = true;
       }},
      {"millimetres",
       [](HostileCloud& c, Draws&) {
         for (auto& p : c.points) p *= 1000;
         c.hopeless = true;
       }},
      {"tiny",
       [](HostileCloud& c, Draws&) {
         for (auto& p : c.points) p *= 1e-40f;
         c.hopeless = true;
       }},
      {"in huge numbers",
       [](HostileCloud& c, Draws& d) {
         const Vector3f far = std::pow(10.0f, d.Uniform(2, 12)) * d.Cube();
         for (auto& p : c.points) p += far;
         for (auto& r : c.rim) r.point += far;
       }},
      {"on a slanting plane",
       [](HostileCloud& c, Draws& d) {
         const Vector3f slope = d.Cube();
         for (auto& p : c.points) p.z() = 0.8f + slope.x() * p.x() + slope.y() * p.y();
         c.hopeless = true;
       }},
      {"every point many times",
       [](HostileCloud& c, Draws& d) {
         const size_t different = 1 + d.Index(c.points.size());
         for (size_t i = different; i < c.points.size(); ++i) c.points[i] = c.points[i % different];
       }},
      {"of another camera",
       [](HostileCloud& c, Draws& d) {
         const Vector3f wrong(d.Uniform(0.1f, 4), d.Uniform(0.1f, 4), 1);
         for (auto& p : c.points) p = p.cwiseProduct(wrong);
       }},
      {"a rim of another object",
       [](HostileCloud& c, Draws& d) {
         const Vector3f aside = d.Cube();
         for (auto& r : c.rim) r.point += aside;
       }},
      {"a rim of another depth",
       [](HostileCloud& c, Draws& d) {
         const float scale = d.Uniform(-2, 3);
         for (auto& r : c.rim) r.point *= scale;
       }},
      {"a rim that knows nothing",
       [](HostileCloud& c, Draws& d) {
         const Beyond beyond = static_cast<Beyond>(d.Index(5));
         for (auto& r : c.rim) r.beyond = beyond;
       }},
      {"points of any bits",
       [](HostileCloud& c, Draws& d) {
         for (size_t i = d.Index(100); i > 0; --i) c.points[d.Index(c.points.size())] = d.AnyBits();
       }},
      {"a few flyers",
       [](HostileCloud& c, Draws& d) {
         for (int i = 0; i < 3; ++i) c.points[d.Index(c.points.size())] = d.Cube();
       }},
      {"far away, where floats are coarse",
       [](HostileCloud& c, Draws&) {
         for (auto& p : c.points) p += Vector3f(0, 0, 3e5f);
         c.hopeless = true;
       }},
      {"a normal of some length",
       [](HostileCloud& c, Draws& d) {
         c.table->normal *= d.Index(2) == 0 ? 2 : 1e-5;
         c.hopeless = true;
       }},
      {"no normal",
       [](HostileCloud& c, Draws& d) {
         c.table->normal =
             d.Index(2) == 0 ? Vector3d::Zero().eval() : Vector3d(0, static_cast<double>(kNan), 0);
         c.hopeless = true;
       }},
      {"no offset",
       [](HostileCloud& c, Draws& d) {
         c.table->offset_m = static_cast<double>(d.Index(2) == 0 ? kNan : kInf);
         c.hopeless = true;
       }},
      {"a plane high above",
       [](HostileCloud& c, Draws&) {
         c.table->offset_m -= 0.3;
         c.hopeless = true;
       }},
      {"a plane far below", [](HostileCloud& c, Draws&) { c.table->offset_m += 0.3; }},
      {"any plane",
       [](HostileCloud& c, Draws& d) {
         c.table->normal = d.Cube().cast<double>().normalized();
         c.table->offset_m = static_cast<double>(d.Uniform(-1, 1));
       }},
      {"no table", [](HostileCloud& c, Draws&) { c.table.reset(); }},
      {"seen from within",
       [](HostileCloud& c, Draws& d) {
         c.viewpoint = c.points[d.Index(c.points.size())].cast<double>();
       }},
      {"seen from anywhere",
       [](HostileCloud& c, Draws& d) {
         c.viewpoint = c.points[0].cast<double>() + 0.3 * d.Cube().cast<double>();
         if (d.Index(2) == 0) c.rim.clear();
       }},
      {"seen from nowhere",
       [](HostileCloud& c, Draws&) {
         c.viewpoint.y() = static_cast<double>(kNan);
         c.hopeless = true;
       }},
      {"seen from far away", [](HostileCloud& c, Draws&) { c.viewpoint.z() = -1e30; }},
      {"a rim of odd numbers",
       [](HostileCloud& c, Draws& d) {
         for (auto& r : c.rim) r.point = d.Odd();
       }},
      {"a rim in one place",
       [](HostileCloud& c, Draws&) {
         for (auto& r : c.rim) r.point = c.rim[0].point;
       }},
      {"a rim of too many points",
       [](HostileCloud& c, Draws&) {
         while (c.rim.size() < 3000) c.rim.insert(c.rim.end(), c.rim.begin(), c.rim.begin() + 40);
       }},
      {"a filled cube",
       [](HostileCloud& c, Draws& d) {
         for (auto& p : c.points) p = 0.4f * d.Cube() + Vector3f(0, 0, 1.2f);
         c.table.reset();
       }},
  };
  return damages;
}

std::string Unsound(const FitResult& fit) {
  constexpr int kMostIterations = 5000;  // of all starts and levels of any method by default
  if (!IsSound(fit.shape)) return "the shape is none";
  const auto sound = [](const Superquadric& s) { return IsSound(s); };
  if (!std::all_of(fit.alternatives.begin(), fit.alternatives.end(), sound)) {
    return "an alternative is no shape";
  }
  if (!std::all_of(fit.parts.begin(), fit.parts.end(), sound)) return "a part is no shape";
  if (fit.parts.size() == 1) return "one part alone";
  if (!fit.covariance.allFinite() || fit.covariance.diagonal().minCoeff() < 0) {
    return "the covariance is none";
  }
  if (!std::isfinite(fit.mean_radial_distance_m) || fit.mean_radial_distance_m < 0) {
    return "the mean distance is none";
  }
  if (fit.converged != fit.reason.empty()) return "no reason, or one too many: " + fit.reason;
  if (std::accumulate(fit.iterations.begin(), fit.iterations.end(), 0) > kMostIterations) {
    return "iterations without end";
  }
  return "";
}

std::string Unsound(const Estimate& estimate) {
  if (!estimate.fit.converged && !estimate.grasps.empty()) return "grasps of nothing";
  for (const GraspCandidate& grasp : estimate.grasps) {
    if (!IsSound(grasp)) return "a grasp is none";
  }
  return Unsound(estimate.fit);
}

}  // namespace beckon::pose
