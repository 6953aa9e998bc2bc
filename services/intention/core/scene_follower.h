// What stands on the table while a session lasts: objects keep their index from scene to scene,
// what segmentation flickers is left out, what lasts is believed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/messages.h"
#include "services/intention/core/label_match.h"

namespace beckon::intention {

struct FollowConfig {
  Utime settle = 7 * kSecond / 10;  // a change is believed once it has lasted so long ...
  int settle_scenes = 3;            // ... and so many scenes showed it
  double place_m = 0.05;            // within which an object has not moved
  LabelMatchConfig looks{.place_m = 0.05, .extent_m = 0.05};  // of one object under two ids
};

struct Followed {
  msg::SceneObject object;                // its centroid is where it settled; id of the newest run
  bool gone = false;                      // believed; it may come back
  std::optional<Eigen::Vector3d> seen_W;  // its centroid in the newest scene, where it is in it
};

/// The first scene is believed at once. Later an object is gone, back, moved or new once that has
/// lasted. Within a run of perception objects are known by id, else by place and looks. Scenes
/// without a table say nothing.
class SceneFollower {
 public:
  /// The first kMaxThings objects of the scene.
  SceneFollower(const msg::Scene& first, Utime now, const FollowConfig& config = {});

  /// Takes the next scene. True: what is believed changed, or an object's id.
  bool See(const msg::Scene& scene, Utime now);

  /// New ones are appended, gone ones stay; at most kMaxThings.
  const std::vector<Followed>& objects() const { return objects_; }
  /// Whether the newest scene shows an object where it settled.
  bool Shows(int object) const;
  /// When the newest scene with a table arrived.
  Utime seen() const { return seen_; }
  const std::string& source() const { return source_; }
  int64_t seq() const { return seq_; }
  /// Of its frame.
  Utime utime() const { return utime_; }
  /// The id of an object in the newest scene; 0 where it is not in it.
  int IdNow(int object) const;
  /// The camera in the newest scene.
  const Pose& X_WC() const { return X_WC_; }

 private:
  /// Something else than what is believed.
  struct Change {
    Utime since = 0;
    int scenes = 0;                       // that showed it; 0: there is none
    std::optional<Eigen::Vector3d> at_W;  // nothing: not seen
  };
  struct Track {
    int id = 0;                                    // in the present run of perception; 0: not known
    std::vector<msg::CategoryProbability> latest;  // perception's opinion, which what the user says
                                                   // changes
    Change change;
  };
  struct Newcomer {
    msg::SceneObject object;
    Change change;
  };
  /// By object of a scene: the one of ours that it is, or -1.
  using Matches = std::vector<int>;

  void Add(const msg::SceneObject& object);
  Matches Match(const msg::Scene& scene) const;
  bool Settle(size_t i, const msg::SceneObject* seen, Utime now);
  bool Welcome(const std::vector<const msg::SceneObject*>& strangers, Utime now);
  bool Near(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
  bool Lasts(Change& change, const std::optional<Eigen::Vector3d>& at_W, Utime now) const;

  FollowConfig config_;
  std::vector<Followed> objects_;
  std::vector<Track> tracks_;        // by object
  std::vector<Newcomer> newcomers_;  // not believed yet
  Utime seen_ = 0;
  std::string source_;
  int64_t seq_ = 0;
  Utime utime_ = 0;
  Pose X_WC_ = Pose::Identity();
};

}  // namespace beckon::intention
