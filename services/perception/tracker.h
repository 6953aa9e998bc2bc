// Gives objects the same id from frame to frame.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "services/perception/object_extraction.h"

namespace beckon::perception {

struct TrackerConfig {
  double max_step_m = 0.03;  // an object that moved no more between two frames is the same
  double min_overlap = 0.5;  // so is one whose pixels overlap this much (intersection over union)
  int forget_after_frames = 300;  // an object hidden for longer gets a new id
};

/// Matches the objects of a frame with those seen before, nearest and most overlapping first. Ids
/// count up from 1 and are never given twice.
class Tracker {
 public:
  explicit Tracker(const TrackerConfig& config) : config_(config) {}

  /// The id of each object of the next frame. `objects` in C, their camera taken to stand still.
  std::vector<int> Update(std::span<const ExtractedObject> objects);

  /// Whether an object of this id may still come back.
  bool Remembers(int id) const;

 private:
  struct Track {
    int id = 0;
    Eigen::Vector3d centroid_C;
    std::vector<uint32_t> pixels;  // ascending
    int64_t last_frame = 0;
  };

  TrackerConfig config_;
  std::vector<Track> tracks_;
  int64_t frame_ = 0;
  int next_id_ = 1;
};

}  // namespace beckon::perception
