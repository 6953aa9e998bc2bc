// The inner loop of the adaptive fit does not allocate.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "services/pose/adaptive_problem.h"
#include "tests/pose/views.h"

namespace {
thread_local long allocations = 0;

void* TryAllocate(size_t size) noexcept {
  ++allocations;
  return std::malloc(size == 0 ? 1 : size);
}
void* Allocate(size_t size) {
  if (void* p = TryAllocate(size)) return p;
  throw std::bad_alloc();
}
void* Allocate(size_t size, std::align_val_t alignment) {
  ++allocations;
  const size_t a = static_cast<size_t>(alignment);
  if (void* p = std::aligned_alloc(a, (size + a - 1) / a * a)) return p;
  throw std::bad_alloc();
}
}  // namespace

void* operator new(size_t size) { return Allocate(size); }
void* operator new[](size_t size) { return Allocate(size); }
void* operator new(size_t size, const std::nothrow_t&) noexcept { return TryAllocate(size); }
void* operator new[](size_t size, const std::nothrow_t&) noexcept { return TryAllocate(size); }
void* operator new(size_t size, std::align_val_t a) { return Allocate(size, a); }
void* operator new[](size_t size, std::align_val_t a) { return Allocate(size, a); }
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, size_t) noexcept { std::free(p); }
void operator delete[](void* p, size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, size_t, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, size_t, std::align_val_t) noexcept { std::free(p); }

namespace beckon::pose {
namespace {

TEST(Allocation, IsCounted) {
  const long before = allocations;
  const std::vector<double> three(3);
  EXPECT_EQ(allocations, before + 1);
}

TEST(Allocation, DoesNotHappenInTheInnerLoopOfTheAdaptiveFit) {
  const TableView view =
      ViewOnTable(MakeShape({0.04, 0.06, 0.09}, 0.1, 0.1, {0, 0, 0.09}, {0, 0, 0.5}), 600);
  PointBlock points, rays;
  for (size_t i = 0; i < 300; ++i) points.Add(view.points_C[i].cast<double>(), 1.0 / 300);
  for (size_t i = 0; i < 90; ++i) rays.Add(view.points_C[i].cast<double>().normalized(), 1.0 / 90);
  points.Pad();
  rays.Pad();
  const TableTopScene scene{view.table_C};
  const AdaptiveConfig config;
  const Cut cut{Eigen::Vector3d::UnitX(), 0.02, 0.01};
  const AdaptiveProblem whole(points, rays, scene, 2, config);
  const AdaptiveProblem cut_off(points, rays, scene, 2, config, {&cut, 1});
  const long before = allocations;
  const double cost = whole.Linearise(view.shape_C).cost + cut_off.Linearise(view.shape_C).cost +
                      whole.CostOf(view.shape_C).total();
  EXPECT_EQ(allocations, before);
  EXPECT_TRUE(std::isfinite(cost));
}

}  // namespace
}  // namespace beckon::pose
