// Distances of many points and rays from one superquadric, with derivatives.
#include "services/pose/distance_kernel.h"

#include <algorithm>
#include <cmath>

#include "services/pose/lanes.h"

namespace beckon::pose {
namespace {

using namespace lanes;

constexpr float kTiny = 1e-6f;      // relative size below which a coordinate counts as zero
constexpr float kMaxShrink = 4.0f;  // keeps the Jacobian bounded near the centre
constexpr int kEntries = kKernelParameters * (kKernelParameters + 1) / 2;

// A superquadric in single precision: p_O = R (p_F - centre).
struct Shape {
  float R[3][3], centre[3];
  float a[3], by_a[3], e1, e2;

  explicit Shape(const Superquadric& s) {
    const Eigen::Matrix3d R_OF = s.X_FO.linear().transpose();
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) R[i][k] = static_cast<float>(R_OF(i, k));
      centre[i] = static_cast<float>(s.X_FO.translation()[i]);
      a[i] = static_cast<float>(s.semi_axes[i]);
      by_a[i] = static_cast<float>(1 / s.semi_axes[i]);
    }
    e1 = static_cast<float>(s.epsilon[0]);
    e2 = static_cast<float>(s.epsilon[1]);
  }
};

BECKON_LANES_INLINE Lanes Load(const float* p) { return *reinterpret_cast<const Lanes*>(p); }
BECKON_LANES_INLINE void Store(float* p, Lanes v) { *reinterpret_cast<Lanes*>(p) = v; }

struct Point {
  Lanes x, y, z;
};
BECKON_LANES_INLINE Point LoadPoint(const PointBlock& b, int i) {
  return {Load(&b.x[static_cast<size_t>(i)]), Load(&b.y[static_cast<size_t>(i)]),
          Load(&b.z[static_cast<size_t>(i)])};
}
BECKON_LANES_INLINE Point Turn(const Shape& s, const Point& p) {
  return {s.R[0][0] * p.x + s.R[0][1] * p.y + s.R[0][2] * p.z,
          s.R[1][0] * p.x + s.R[1][1] * p.y + s.R[1][2] * p.z,
          s.R[2][0] * p.x + s.R[2][1] * p.y + s.R[2][2] * p.z};
}
BECKON_LANES_INLINE Point TurnBack(const Shape& s, const Point& p) {
  return {s.R[0][0] * p.x + s.R[1][0] * p.y + s.R[2][0] * p.z,
          s.R[0][1] * p.x + s.R[1][1] * p.y + s.R[2][1] * p.z,
          s.R[0][2] * p.x + s.R[1][2] * p.y + s.R[2][2] * p.z};
}
BECKON_LANES_INLINE Point ToShape(const Shape& s, const Point& p) {
  return Turn(s, {p.x - s.centre[0], p.y - s.centre[1], p.z - s.centre[2]});
}

// log((exp(2u/e) + exp(2v/e))^(e/2)), the weight of u, and the derivative by e (half the weights'
// entropy).
struct Norm2 {
  Lanes value, weight, by_e;
};
BECKON_LANES_INLINE Norm2 LogNorm(Lanes u, Lanes v, float e) {
  const Lanes difference = u - v;
  const Lanes t = Abs(difference) * (2.0f / e);
  const Lanes ratio = Exp(-t);
  const Lanes log1p = Log(1.0f + ratio);
  const Lanes larger = 1.0f / (1.0f + ratio), smaller = ratio * larger;
  return {Max(u, v) + 0.5f * e * log1p, difference >= 0.0f ? larger : smaller,
          0.5f * (log1p + smaller * t)};
}
BECKON_LANES_INLINE Lanes LogNormValue(Lanes u, Lanes v, float e) {
  return Max(u, v) + 0.5f * e * Log(1.0f + Exp(Abs(u - v) * (-2.0f / e)));
}

struct Gauge8 {
  Lanes log_g;
  Lanes weight[3];  // - d log g / d log a
  Lanes by_e1, by_e2;
  Point point;  // d log g / d p_O
};
BECKON_LANES_INLINE Gauge8 GaugeAt(const Shape& s, const Point& p) {
  const Lanes x = Max(Abs(p.x), All(kTiny * s.a[0])), y = Max(Abs(p.y), All(kTiny * s.a[1])),
              z = Max(Abs(p.z), All(kTiny * s.a[2]));
  const Norm2 xy = LogNorm(Log(x * s.by_a[0]), Log(y * s.by_a[1]), s.e2);
  const Norm2 xyz = LogNorm(xy.value, Log(z * s.by_a[2]), s.e1);
  Gauge8 g;
  g.log_g = xyz.value;
  g.weight[0] = xyz.weight * xy.weight;
  g.weight[1] = xyz.weight * (1.0f - xy.weight);
  g.weight[2] = 1.0f - xyz.weight;
  g.by_e1 = xyz.by_e;
  g.by_e2 = xyz.weight * xy.by_e;
  g.point = {CopySign(g.weight[0] / x, p.x), CopySign(g.weight[1] / y, p.y),
             CopySign(g.weight[2] / z, p.z)};
  return g;
}
BECKON_LANES_INLINE Lanes LogGaugeAt(const Shape& s, const Point& p) {
  const Lanes x = Max(Abs(p.x), All(kTiny * s.a[0])), y = Max(Abs(p.y), All(kTiny * s.a[1])),
              z = Max(Abs(p.z), All(kTiny * s.a[2]));
  return LogNormValue(LogNormValue(Log(x * s.by_a[0]), Log(y * s.by_a[1]), s.e2),
                      Log(z * s.by_a[2]), s.e1);
}

struct Distance8 {
  Lanes distance, by_slope, by_g;
};
// grad g = g grad log g, so (g - 1) / |grad g| = (1 - 1/g) / |grad log g|.
BECKON_LANES_INLINE Distance8 DistanceOf(const Gauge8& g) {
  const Lanes slope2 = g.point.x * g.point.x + g.point.y * g.point.y + g.point.z * g.point.z;
  Distance8 d;
  d.by_slope = 1.0f / Sqrt(Max(slope2, All(1e-12f)));
  d.by_g = Exp(-g.log_g);
  d.distance = (1.0f - d.by_g) * d.by_slope;
  return d;
}

struct Sums {
  Lanes cost, gradient[kKernelParameters], hessian[kEntries];
};

BECKON_LANES_INLINE void Accumulate(const Shape& s, const PointBlock& points, float inside,
                                    float outside, Sums& sums) {
  for (int i = 0; i < points.size; i += kLanes) {
    const Point p_F = LoadPoint(points, i);
    const Point arm{p_F.x - s.centre[0], p_F.y - s.centre[1], p_F.z - s.centre[2]};
    const Gauge8 g = GaugeAt(s, Turn(s, arm));
    const Distance8 d = DistanceOf(g);
    const Point n = TurnBack(s, g.point);
    const Lanes scale2 = d.distance < 0.0f ? All(inside * inside) : All(outside * outside);
    const Lanes x = 1.0f + d.distance * d.distance / scale2;
    const Lanes share = Load(&points.weight[static_cast<size_t>(i)]);
    const Lanes weight = share / x;
    sums.cost += share * scale2 * Log(x);
    // Taken at the point of the surface on the same ray, p/g, where the slope is g times as large:
    // log g changes by the same amount there, but for a translation, which moves it by g times as
    // much.
    const Lanes scale = Min(d.by_g, All(kMaxShrink)) * d.by_slope;
    const Lanes J[kKernelParameters] = {-scale * g.weight[0],
                                        -scale * g.weight[1],
                                        -scale * g.weight[2],
                                        scale * g.by_e1,
                                        scale * g.by_e2,
                                        scale * (n.y * arm.z - n.z * arm.y),
                                        scale * (n.z * arm.x - n.x * arm.z),
                                        scale * (n.x * arm.y - n.y * arm.x),
                                        -d.by_slope * n.x,
                                        -d.by_slope * n.y,
                                        -d.by_slope * n.z};
    int entry = 0;
    for (int row = 0; row < kKernelParameters; ++row) {
      const Lanes weighted = weight * J[row];
      sums.gradient[row] += weighted * d.distance;
      for (int column = 0; column <= row; ++column) sums.hessian[entry++] += weighted * J[column];
    }
  }
}

// Minimum of the gauge along each ray, by golden section within the shape's reach: the gauge is
// convex.
BECKON_LANES_INLINE void Deepest(const Shape& s, const float* viewpoint, const PointBlock& rays,
                                 float reach, int steps, PointBlock& points) {
  constexpr float kGolden = 0.618034f;
  const Point v{All(viewpoint[0]), All(viewpoint[1]), All(viewpoint[2])};
  const Point v_O = ToShape(s, v);
  for (int i = 0; i < rays.size; i += kLanes) {
    const Point d_F = LoadPoint(rays, i);
    const Point d = Turn(s, d_F);
    // The point nearest to the centre, and a reach to either side of it; directions are of unit
    // length.
    const Lanes middle = -(v_O.x * d.x + v_O.y * d.y + v_O.z * d.z);
    const auto value = [&](Lanes t) __attribute__((always_inline)) {
      return LogGaugeAt(s, {v_O.x + t * d.x, v_O.y + t * d.y, v_O.z + t * d.z});
    };
    Lanes lo = middle - reach, hi = middle + reach;
    Lanes t1 = hi - kGolden * (hi - lo), t2 = lo + kGolden * (hi - lo);
    Lanes g1 = value(t1), g2 = value(t2);
    for (int step = 0; step < steps; ++step) {
      const IntLanes left = g1 < g2;
      hi = left ? t2 : hi;
      lo = left ? lo : t1;
      const Lanes kept = left ? t1 : t2, g_kept = left ? g1 : g2;
      const Lanes next = left ? hi - kGolden * (hi - lo) : lo + kGolden * (hi - lo);
      const Lanes g_next = value(next);
      t1 = left ? next : kept;
      g1 = left ? g_next : g_kept;
      t2 = left ? kept : next;
      g2 = left ? g_kept : g_next;
    }
    const Lanes t = 0.5f * (lo + hi);
    const size_t k = static_cast<size_t>(i);
    Store(&points.x[k], v.x + t * d_F.x);
    Store(&points.y[k], v.y + t * d_F.y);
    Store(&points.z[k], v.z + t * d_F.z);
  }
}

BECKON_LANES_INLINE void Distances(const Shape& s, const PointBlock& points, float* out) {
  for (int i = 0; i < points.size; i += kLanes) {
    Store(out + i, DistanceOf(GaugeAt(s, ToShape(s, LoadPoint(points, i)))).distance);
  }
}

BECKON_LANES_INLINE void RadialDistances(const Shape& s, const PointBlock& points, Lanes& sum) {
  for (int i = 0; i < points.size; i += kLanes) {
    const Point p = ToShape(s, LoadPoint(points, i));
    const Lanes length = Sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
    sum +=
        Load(&points.weight[static_cast<size_t>(i)]) * length * Abs(1.0f - Exp(-LogGaugeAt(s, p)));
  }
}

// Each kernel is compiled twice: for every processor, and for those with eight lanes in hardware.
// Neither fuses multiplications with additions, so both give the same bytes.
#define BECKON_KERNEL(name, parameters, arguments)           \
  void name##Baseline parameters { name arguments; }         \
  BECKON_WIDE void name##Wide parameters { name arguments; } \
  void Run##name parameters { HasWideLanes() ? name##Wide arguments : name##Baseline arguments; }

#if defined(__x86_64__)
#define BECKON_WIDE [[gnu::target("avx2")]]
bool HasWideLanes() {
  static const bool has = __builtin_cpu_supports("avx2");
  return has;
}
#else
#define BECKON_WIDE
bool HasWideLanes() { return false; }
#endif

BECKON_KERNEL(Accumulate,
              (const Shape& s, const PointBlock& points, float inside, float outside, Sums& sums),
              (s, points, inside, outside, sums))
BECKON_KERNEL(Deepest,
              (const Shape& s, const float* viewpoint, const PointBlock& rays, float reach,
               int steps, PointBlock& points),
              (s, viewpoint, rays, reach, steps, points))
BECKON_KERNEL(Distances, (const Shape& s, const PointBlock& points, float* out), (s, points, out))
BECKON_KERNEL(RadialDistances, (const Shape& s, const PointBlock& points, Lanes& sum),
              (s, points, sum))

double Total(const Lanes& sum) {
  double total = 0;
  for (int i = 0; i < kLanes; ++i) total += static_cast<double>(sum[i]);
  return total;
}

}  // namespace

void PointBlock::Add(const Eigen::Vector3d& p, double point_weight) {
  const size_t i = static_cast<size_t>(size++);
  x[i] = static_cast<float>(p.x());
  y[i] = static_cast<float>(p.y());
  z[i] = static_cast<float>(p.z());
  weight[i] = static_cast<float>(point_weight);
}

void PointBlock::Pad() {
  for (size_t i = static_cast<size_t>(size); i % kLanes != 0; ++i) {
    // A copy of a real point: whatever is computed of it stays finite.
    x[i] = x[0];
    y[i] = y[0];
    z[i] = z[0];
    weight[i] = 0;
  }
}

DistanceSum SumDistances(const Superquadric& shape, const PointBlock& points_F, CauchyLoss loss) {
  Sums sums{};
  RunAccumulate(Shape(shape), points_F, static_cast<float>(loss.inside_m),
                static_cast<float>(loss.outside_m), sums);
  DistanceSum result;
  result.cost = Total(sums.cost);
  int entry = 0;
  for (int row = 0; row < kKernelParameters; ++row) {
    result.gradient[row] = Total(sums.gradient[row]);
    for (int column = 0; column <= row; ++column, ++entry) {
      result.hessian(row, column) = result.hessian(column, row) = Total(sums.hessian[entry]);
    }
  }
  return result;
}

void FindDeepest(const Superquadric& shape, const Eigen::Vector3d& viewpoint_F,
                 const PointBlock& rays_F, int steps, PointBlock& points_F) {
  const Eigen::Vector3f viewpoint = viewpoint_F.cast<float>();
  points_F.size = rays_F.size;
  points_F.weight = rays_F.weight;
  RunDeepest(Shape(shape), viewpoint.data(), rays_F, static_cast<float>(shape.semi_axes.norm()),
             steps, points_F);
}

void ComputeDistances(const Superquadric& shape, const PointBlock& points_F,
                      BlockDistances& distances_m) {
  RunDistances(Shape(shape), points_F, distances_m.data());
}

double SumRadialDistances(const Superquadric& shape, const PointBlock& points_F) {
  Lanes sum{};
  RunRadialDistances(Shape(shape), points_F, sum);
  return Total(sum);
}

}  // namespace beckon::pose
