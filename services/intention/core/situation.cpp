#include "services/intention/core/situation.h"

#include <cassert>

namespace beckon::intention {

uint64_t Situation::MaskOf(int category) const {
  uint64_t mask = 0;
  for (size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].category == category) mask |= uint64_t{1} << i;
  }
  return mask;
}

uint64_t Situation::KnownMask() const {
  uint64_t mask = 0;
  for (const Pair& pair : pairs) mask |= uint64_t{1} << pair.object;
  return mask;
}

std::vector<int> Situation::Present(const Affordances& affordances) const {
  std::vector<int> present(affordances.categories().size(), 0);
  for (const Instance& object : objects) {
    if (object.category >= 0) ++present[static_cast<size_t>(object.category)];
  }
  return present;
}

int Situation::Find(int object, int action) const {
  for (int i = 0; i < pair_count(); ++i) {
    if (pairs[i].object == object && pairs[i].action == action) return i;
  }
  return -1;
}

int Situation::Find(int category, int rank, int action) const {
  for (int i = 0; i < pair_count(); ++i) {
    const Instance& object = objects[pairs[i].object];
    if (object.category == category && object.rank == rank && pairs[i].action == action) return i;
  }
  return -1;
}

Situation MakeSituation(const Affordances& affordances, const std::vector<Thing>& things,
                        Utime utime) {
  assert(things.size() <= kMaxThings);
  Situation situation;
  situation.utime = utime;
  for (size_t i = 0; i < things.size(); ++i) {
    const Thing& thing = things[i];
    int nearer = 0;
    for (size_t j = 0; j < things.size(); ++j) {
      if (j == i || things[j].category != thing.category) continue;
      const bool before = things[j].distance_m < thing.distance_m ||
                          (things[j].distance_m == thing.distance_m && j < i);
      nearer += before ? 1 : 0;
    }
    const int rank = thing.category < 0 ? 0 : nearer + 1;
    situation.objects.push_back({thing.category, rank, thing.distance_m, thing.lateral_m});
    situation.has_lateral |= thing.lateral_m != things[0].lateral_m;
    if (thing.category < 0) continue;
    for (const int action : affordances.categories()[thing.category].actions) {
      situation.pairs.push_back({static_cast<int>(i), action});
    }
  }
  return situation;
}

}  // namespace beckon::intention
