// Keeps objects the same from frame to frame: their ids, and the shapes they are shown with.
#pragma once

#include <cstdint>
#include <vector>

#include "services/perception/scene_layers.h"
#include "services/perception/segmentation.h"
#include "services/perception/tracker.h"

namespace beckon::perception {

/// The objects of a frame as memory has them.
struct SteadyObjects {
  std::vector<int> ids;               // of objects 1 .. n_objects, >= 1
  std::vector<uint16_t> silhouettes;  // like labels, with the pixels whose depth is missing or
                                      // strayed in this frame
};

/// Everything that is remembered of the frames before. An object is shown where segmentation finds
/// it, and where it only errs: its surface is there as it was. It is shown no more once its place
/// is seen to be empty or is hidden; hidden ones, and those that vanished, come back with their id
/// for forget_after_frames.
class ObjectMemory {
 public:
  ObjectMemory(const TrackerConfig& config, const SensorNoise& sensor)
      : tracker_(config), layers_(config.steady ? config.settle_after_frames : 0, sensor) {}

  /// Takes the next frame and rewrites the labels, numbered by size as before, and n_objects.
  /// The first frame stays as it is, and so does one without a table.
  SteadyObjects Update(const RgbdImage& image, int max_objects, Segmentation& segmentation);

  /// Whether an object of this id may still come back.
  bool Remembers(int id) const { return tracker_.Remembers(id); }

 private:
  std::vector<Slot> Shown(std::span<const ObjectLook> segments,
                          std::span<const Slot> slot_of_label) const;
  SteadyObjects Write(const RgbdImage& image, const std::vector<Slot>& shown,
                      Segmentation& segmentation);

  Tracker tracker_;
  SceneLayers layers_;
};

}  // namespace beckon::perception
