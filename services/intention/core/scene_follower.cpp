#include "services/intention/core/scene_follower.h"

#include <algorithm>
#include <tuple>

#include "services/intention/core/situation.h"

namespace beckon::intention {

SceneFollower::SceneFollower(const msg::Scene& first, Utime now, const FollowConfig& config)
    : config_(config),
      seen_(now),
      source_(first.source),
      seq_(first.seq),
      utime_(first.utime),
      X_WC_(first.X_WC) {
  for (const msg::SceneObject& object : first.objects) Add(object);
}

void SceneFollower::Add(const msg::SceneObject& object) {
  if (objects_.size() >= kMaxThings) return;
  objects_.push_back({object, false, object.centroid_W});
  // Seen in every scene and needed by nobody here.
  objects_.back().object.points_C.clear();
  objects_.back().object.outline_px.clear();
  tracks_.push_back({object.id, object.probabilities, {}});
}

int SceneFollower::IdNow(int object) const {
  const auto i = static_cast<size_t>(object);
  return objects_[i].seen_W ? tracks_[i].id : 0;
}

bool SceneFollower::Near(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
  return (a - b).norm() <= config_.place_m;
}

bool SceneFollower::Shows(int object) const {
  const Followed& followed = objects_[static_cast<size_t>(object)];
  return !followed.gone && followed.seen_W && Near(*followed.seen_W, followed.object.centroid_W);
}

bool SceneFollower::See(const msg::Scene& scene, Utime now) {
  if (!scene.has_table) return false;
  if (scene.source != source_ || scene.seq < seq_) {  // another run: its ids are others
    for (Track& track : tracks_) track.id = 0;
  }
  source_ = scene.source;
  seq_ = scene.seq;
  utime_ = scene.utime;
  seen_ = now;
  X_WC_ = scene.X_WC;
  const Matches matches = Match(scene);
  std::vector<const msg::SceneObject*> seen(objects_.size(), nullptr), strangers;
  for (size_t i = 0; i < matches.size(); ++i) {
    const msg::SceneObject* object = &scene.objects[i];
    matches[i] < 0 ? strangers.push_back(object)
                   : void(seen[static_cast<size_t>(matches[i])] = object);
  }
  bool changed = false;
  for (size_t i = 0; i < objects_.size(); ++i) changed |= Settle(i, seen[i], now);
  return Welcome(strangers, now) || changed;
}

/// Greedy: by id first, then the nearest by place and looks.
SceneFollower::Matches SceneFollower::Match(const msg::Scene& scene) const {
  struct Candidate {
    bool by_id;
    double distance_m;
    size_t theirs, ours;
  };
  std::vector<Candidate> pairs;
  for (size_t theirs = 0; theirs < scene.objects.size(); ++theirs) {
    const msg::SceneObject& object = scene.objects[theirs];
    for (size_t ours = 0; ours < objects_.size(); ++ours) {
      const Followed& known = objects_[ours];
      const double settled_m = (object.centroid_W - known.object.centroid_W).norm();
      const double last_m = known.seen_W ? (object.centroid_W - *known.seen_W).norm() : settled_m;
      const double distance_m = std::min(settled_m, last_m);
      const bool near = distance_m <= config_.looks.place_m;
      msg::SceneObject latest = known.object;
      latest.probabilities = tracks_[ours].latest;
      const bool alike = LooksAlike(object, known.object, config_.looks) ||
                         LooksAlike(object, latest, config_.looks);
      const bool same_id = tracks_[ours].id == object.id;
      if (same_id ? near || alike : near && alike)
        pairs.push_back({same_id, distance_m, theirs, ours});
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const Candidate& a, const Candidate& b) {
    return std::tuple(!a.by_id, a.distance_m, a.theirs, a.ours) <
           std::tuple(!b.by_id, b.distance_m, b.theirs, b.ours);
  });
  Matches matches(scene.objects.size(), -1);
  std::vector<bool> taken(objects_.size(), false);
  for (const Candidate& pair : pairs) {
    if (matches[pair.theirs] >= 0 || taken[pair.ours]) continue;
    matches[pair.theirs] = static_cast<int>(pair.ours);
    taken[pair.ours] = true;
  }
  return matches;
}

/// What the newest scene says of an object that is known; null: nothing.
bool SceneFollower::Settle(size_t i, const msg::SceneObject* seen, Utime now) {
  Followed& known = objects_[i];
  Track& track = tracks_[i];
  known.seen_W.reset();
  bool changed = false;
  if (seen != nullptr) {
    known.seen_W = seen->centroid_W;
    track.id = seen->id;
    track.latest = seen->probabilities;
    changed = std::exchange(known.object.id, seen->id) != seen->id;
  }
  const bool as_believed = known.gone
                               ? seen == nullptr
                               : seen != nullptr && Near(seen->centroid_W, known.object.centroid_W);
  if (as_believed) {
    track.change = {};
    return changed;
  }
  if (!Lasts(track.change, known.seen_W, now)) return changed;
  track.change = {};
  known.gone = seen == nullptr;
  if (seen != nullptr) known.object.centroid_W = seen->centroid_W;
  return true;
}

bool SceneFollower::Welcome(const std::vector<const msg::SceneObject*>& strangers, Utime now) {
  bool changed = false;
  std::vector<Newcomer> still;
  for (const msg::SceneObject* object : strangers) {
    Newcomer newcomer{*object, {}};
    const auto before = std::ranges::find_if(newcomers_, [&](const Newcomer& n) {
      return Near(n.object.centroid_W, object->centroid_W);
    });
    if (before != newcomers_.end()) newcomer.change = before->change;
    if (Lasts(newcomer.change, object->centroid_W, now)) {
      Add(*object);
      changed = true;
    } else {
      still.push_back(std::move(newcomer));
    }
  }
  newcomers_ = std::move(still);
  return changed;
}

/// Counts a scene that says so; true once that has lasted.
bool SceneFollower::Lasts(Change& change, const std::optional<Eigen::Vector3d>& at_W,
                          Utime now) const {
  const bool still = change.scenes > 0 && change.at_W.has_value() == at_W.has_value() &&
                     (!at_W || Near(*change.at_W, *at_W));
  if (!still) change = {now, 0, at_W};
  ++change.scenes;
  return change.scenes >= config_.settle_scenes && now - change.since >= config_.settle;
}

}  // namespace beckon::intention
