// Greedy matching of objects to tracks.
#include "services/perception/tracker.h"

#include <algorithm>
#include <tuple>

namespace beckon::perception {
namespace {

/// Intersection over union of two ascending lists of pixels.
double Overlap(const std::vector<uint32_t>& a, const std::vector<uint32_t>& b) {
  if (a.empty() || b.empty() || a.back() < b.front() || b.back() < a.front()) return 0;
  size_t common = 0;
  for (size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    if (a[i] == b[j])
      ++common, ++i, ++j;
    else if (a[i] < b[j])
      ++i;
    else
      ++j;
  }
  return static_cast<double>(common) / static_cast<double>(a.size() + b.size() - common);
}

}  // namespace

std::vector<int> Tracker::Update(std::span<const ExtractedObject> objects) {
  ++frame_;
  std::erase_if(tracks_, [this](const Track& track) {
    return frame_ - track.last_frame > config_.forget_after_frames;
  });

  struct Pair {
    double cost;  // distance in steps, less what overlaps
    int id;
    size_t object, track;
  };
  std::vector<Pair> pairs;
  for (size_t o = 0; o < objects.size(); ++o) {
    for (size_t t = 0; t < tracks_.size(); ++t) {
      const double steps =
          (objects[o].centroid_C - tracks_[t].centroid_C).norm() / config_.max_step_m;
      const double overlap = Overlap(objects[o].pixels, tracks_[t].pixels);
      if (steps > 1 && overlap < config_.min_overlap) continue;
      pairs.push_back({steps - 2 * overlap, tracks_[t].id, o, t});
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return std::tie(a.cost, a.id, a.object) < std::tie(b.cost, b.id, b.object);
  });

  std::vector<int> ids(objects.size(), 0);
  std::vector<bool> taken(tracks_.size(), false);
  for (const Pair& pair : pairs) {
    if (ids[pair.object] != 0 || taken[pair.track]) continue;
    ids[pair.object] = pair.id;
    taken[pair.track] = true;
    Track& track = tracks_[pair.track];
    track = {pair.id, objects[pair.object].centroid_C, objects[pair.object].pixels, frame_};
  }
  for (size_t o = 0; o < objects.size(); ++o) {
    if (ids[o] != 0) continue;
    ids[o] = next_id_++;
    tracks_.push_back({ids[o], objects[o].centroid_C, objects[o].pixels, frame_});
  }
  return ids;
}

bool Tracker::Remembers(int id) const {
  return std::any_of(tracks_.begin(), tracks_.end(), [id](const Track& t) { return t.id == id; });
}

}  // namespace beckon::perception
