// What each pixel showed lately: the surface that is seen there, and the object hidden behind it.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <span>
#include <vector>

#include "services/base/rgbd.h"
#include "services/perception/sensor_noise.h"

namespace beckon::perception {

/// Where an object is kept in memory; 0 = no object.
using Slot = uint8_t;
inline constexpr int kSlots = 256;
template <typename T>
using PerSlot = std::array<T, kSlots>;

/// A frame held against memory, in pixels.
struct SceneEvidence {
  std::vector<PerSlot<int>> same;  // [label][slot]: show the surface remembered of that object
  PerSlot<int> visible{};          // sums of `same`
  PerSlot<int> hidden{};           // something nearer is where the object was
  PerSlot<int> empty{};            // something farther is
  PerSlot<int> unseen{};           // have no depth now
};

/// What Take should know of the objects.
struct SlotTraits {
  std::bitset<kSlots> established;  // kept behind what comes before them
  std::bitset<kSlots> at_once;      // given all their pixels without waiting
};

/// Two layers of depth and slots per pixel. Where depth stays, a pixel changes hands only after
/// `settle_after_frames` that speak for it, less two for each that speaks against it: what
/// segmentation gets wrong now and then never shows. Where the depth of most of a block of 4 x 4
/// pixels changes by more than the noise, and that of several blocks that touch, the new frame is
/// believed at once; a change of fewer is how ragged outlines are in depth images, and believed
/// like the rest. When an object comes before another, the pixels of the latter are kept behind,
/// and are its own again once their depth comes back; seeing farther empties the place.
class SceneLayers {
 public:
  /// Pixels left .. right - 1, top .. bottom - 1.
  struct Rectangle {
    int left = 0, top = 0, right = 0, bottom = 0;
  };

  /// 0 frames: every frame is believed at once.
  SceneLayers(int settle_after_frames, const SensorNoise& sensor)
      : settle_after_frames_(settle_after_frames), sensor_(sensor) {}

  /// Holds a frame against memory. `labels` of the image's size, 0 .. n_labels. An image of another
  /// size or camera than the last empties the memory.
  SceneEvidence Compare(const RgbdImage& image, std::span<const uint16_t> labels, int n_labels);

  /// Takes the frame that was compared last into memory; `slot_of_label` of 0 .. n_labels, the
  /// first 0.
  void Take(const RgbdImage& image, std::span<const uint16_t> labels,
            std::span<const Slot> slot_of_label, const SlotTraits& traits);

  /// Gives all pixels of an object to another, or to none.
  void Give(Slot from, Slot to);

  /// Per pixel, after Take: whose it is, be there depth in this frame or not, and
  const std::vector<Slot>& silhouettes() const { return front_slot_; }
  /// whose it is among the pixels that show that surface in this frame.
  const std::vector<Slot>& seen() const { return seen_; }
  /// All of both that is an object lies in here.
  const Rectangle& region() const { return region_; }
  /// Pixels seen of each object.
  const PerSlot<int>& n_seen() const { return n_seen_; }

 private:
  static constexpr int kBlock = 4;
  enum class Relation : uint8_t { kMissing, kFirst, kSame, kNearer, kFarther, kBehind };

  void Fit(const RgbdImage& image);
  Rectangle Region(std::span<const uint16_t> labels) const;
  float Tolerance(float depth_m) const;
  Relation Relate(size_t pixel, float depth_m) const;
  void Count(size_t pixel, Relation relation, float depth_m, uint16_t label,
             SceneEvidence& evidence) const;
  void CompareBlock(const RgbdImage& image, std::span<const uint16_t> labels, int bu, int bv,
                    SceneEvidence& evidence);
  void DropLoneChanges();
  bool ChangedAround(int u, int v) const;
  void TakePixel(size_t pixel, float depth_m, Slot slot, bool changed, const SlotTraits& traits);
  void Replace(size_t pixel, float depth_m, Slot slot, const SlotTraits& traits);

  int settle_after_frames_;
  SensorNoise sensor_;
  int width_ = 0, height_ = 0;
  Intrinsics intrinsics_;
  std::vector<Slot> front_slot_, behind_slot_, seen_;
  std::vector<float> front_depth_m_, behind_depth_m_;  // 0 = never seen
  std::vector<uint8_t> doubt_;                         // frames against the front's slot
  std::vector<Relation> relation_;                     // of the frame compared last
  std::vector<uint8_t> block_changed_;                 // with a border of one block
  std::vector<size_t> together_;                       // changed blocks that touch
  PerSlot<int> n_seen_{};
  Rectangle region_;  // the same
};

}  // namespace beckon::perception
