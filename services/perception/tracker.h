// Tells which segment of a frame is which of the objects seen before.
#pragma once

#include <Eigen/Core>
#include <bitset>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "services/perception/object_look.h"
#include "services/perception/scene_layers.h"

namespace beckon::perception {

/// Section [tracker] of the configuration.
struct TrackerConfig {
  double max_step_m = 0.03;    // an object that moved no more between two frames is the same
  double min_overlap = 0.5;    // so is one of which this part shows the surface seen there before,
  double max_jump_m = 0.5;     // and one that vanished and turns up this near, of the same looks
  double min_likeness = 0.65;  // 0..1, of the colours, that the same looks have
  int forget_after_frames = 300;  // an object hidden or gone for longer gets a new id
  bool steady = true;             // false: every frame is shown as it comes
  /// Frames, more for it than against, before objects part, join, come or go, and pixels change
  /// hands, where depth stays as it was.
  int settle_after_frames = 20;
};

/// What became of the segments of a frame.
struct TrackedSegments {
  std::vector<Slot> slot_of_label;  // 0 .. n; several may share one; 0 for label 0, and for a
                                    // segment that found no slot free
  std::vector<std::pair<Slot, Slot>> outvoted;  // objects that are no longer thought to be any, and
                                                // what they are part of, or 0
};

/// Segments are given to objects so that the sum of costs is least over all of them. A pair costs
/// what is between their places, the surface they do not share, and what differs in colour and
/// size. Where several segments lie on the surface of one object, the others are pieces of it for
/// as long as something is in front of it. Otherwise frames vote on whether an object is one, two
/// or none: what is said twice as often as its contrary wins, sooner over objects just seen.
class Tracker {
 public:
  explicit Tracker(const TrackerConfig& config) : config_(config), tracks_(kSlots) {}

  /// Takes the segments 1 .. n of the next frame. Their camera is taken to stand still.
  TrackedSegments Update(std::span<const ObjectLook> segments, const SceneEvidence& evidence);

  /// Notes how an object is shown in this frame. Its first time gives it its id.
  void Show(Slot slot, const ObjectLook& look);

  /// Frees objects that were not shown for long, and returns their slots.
  std::vector<Slot> Forget();

  /// From 1, in the order objects were first shown, never given twice; 0 before.
  int Id(Slot slot) const { return tracks_[slot].id; }
  /// How many pixels it had when last shown.
  int LastPixels(Slot slot) const { return tracks_[slot].last.n_pixels; }
  /// Whether an object of this id may still come back.
  bool Remembers(int id) const;
  SlotTraits Traits() const;

 private:
  struct Track {
    bool used = false;
    bool shown = false;  // since it was added, outvoted or revived
    Slot part_of = 0;    // the object that it was outvoted to be a part of
    int id = 0;
    ObjectLook last;                                   // as last shown, and
    ObjectLook whole;                                  // as it looks when little of it is hidden
    Eigen::Vector3d step_C = Eigen::Vector3d::Zero();  // it moved in the last frame
    int64_t last_frame = 0;                            // in which it was both found and shown,
    int64_t found_frame = 0;                           // found by segmentation,
    int64_t shown_frame = 0;                           // shown
    int n_found = 0;
    int trust = 0;  // frames in which it was found, before it is shown
    int doubt = 0;  // more frames that did not find it where its surface is than did
    int split = 0;  // the same, in which it was in pieces without being hidden
  };

  double Cost(const ObjectLook& segment, int label, Slot slot, const SceneEvidence& evidence) const;
  void AssignSegments(std::span<const ObjectLook> segments, const SceneEvidence& evidence,
                      std::vector<Slot>& slot_of_label) const;
  Slot PieceOf(const ObjectLook& segment, int label, const SceneEvidence& evidence) const;
  void Vote(const SceneEvidence& evidence, TrackedSegments& result,
            const std::bitset<kSlots>& found, const std::bitset<kSlots>& in_pieces);
  Slot Revive(const ObjectLook& look, Slot whole);
  Slot Add(const ObjectLook& look, int trust);
  int Needed(const Track& track) const;

  TrackerConfig config_;
  std::vector<Track> tracks_;  // by slot; the first is never used
  int64_t frame_ = 0;
  int next_id_ = 1;
};

}  // namespace beckon::perception
