// What stands before the user, as the model sees it: object instances ranked by distance, and the
// (object, action) pairs that are possible with them.
#pragma once

#include <cstdint>
#include <vector>

#include "services/base/utime.h"
#include "services/intention/core/affordances.h"

namespace beckon::intention {

/// Most objects of a situation (a mask of objects has 64 bits).
inline constexpr int kMaxThings = 64;

/// An object as it is seen.
struct Thing {
  int category = -1;      // index in Affordances; -1: unknown, affords nothing
  double distance_m = 0;  // horizontal, from the user, finite
  double lateral_m = 0;   // to the right, 0 where unknown
};

struct Instance {
  int category = -1;
  int rank = 0;  // 1 = the nearest of its category; 0 where the category is unknown
  double distance_m = 0;
  double lateral_m = 0;
};

/// The candidate for what the user wants.
struct Pair {
  int object = 0;  // index in Situation::objects
  int action = 0;  // index in Affordances::actions()

  bool operator==(const Pair&) const = default;
};

struct Situation {
  std::vector<Instance> objects;
  std::vector<Pair> pairs;   // by object, then action
  bool has_lateral = false;  // whether the objects differ in lateral_m
  Utime utime = 0;           // when; 0: not known

  int pair_count() const { return static_cast<int>(pairs.size()); }
  /// Objects of a category, as a mask.
  uint64_t MaskOf(int category) const;
  /// Objects that afford something, as a mask.
  uint64_t KnownMask() const;
  /// Instances by category.
  std::vector<int> Present(const Affordances& affordances) const;
  /// Index of a pair, or -1.
  int Find(int object, int action) const;
  int Find(int category, int rank, int action) const;
};

/// Equal distances are ranked in input order. At most kMaxThings things.
Situation MakeSituation(const Affordances& affordances, const std::vector<Thing>& things,
                        Utime utime = 0);

}  // namespace beckon::intention
