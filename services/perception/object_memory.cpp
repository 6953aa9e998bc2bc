// Segments to objects, objects to labels.
#include "services/perception/object_memory.h"

#include <algorithm>

namespace beckon::perception {
namespace {

constexpr double kStill = 0.5;  // part of what was shown last: enough where no segment is left
constexpr double kOwn = 0.3;    // part of its segments' pixels that an object must have

}  // namespace

SteadyObjects ObjectMemory::Update(const RgbdImage& image, int max_objects,
                                   Segmentation& segmentation) {
  const int n = segmentation.table_C ? segmentation.n_objects : 0;
  const auto segments = LookAt(image, segmentation.labels, n);
  if (!segmentation.table_C) {  // nothing is known of this frame but that time goes on
    SceneEvidence nothing;
    nothing.same.resize(1);
    tracker_.Update(segments, nothing);
    for (Slot slot : tracker_.Forget()) layers_.Give(slot, 0);
    return {{}, segmentation.labels};
  }
  const SceneEvidence evidence = layers_.Compare(image, segmentation.labels, n);
  const TrackedSegments tracked = tracker_.Update(segments, evidence);
  for (const auto& [from, to] : tracked.outvoted) layers_.Give(from, to);
  layers_.Take(image, segmentation.labels, tracked.slot_of_label, tracker_.Traits());
  std::vector<Slot> shown = Shown(segments, tracked.slot_of_label);
  segmentation.n_left_out += std::max(0, static_cast<int>(shown.size()) - max_objects);
  if (static_cast<int>(shown.size()) > max_objects) shown.resize(max_objects);
  SteadyObjects objects = Write(image, shown, segmentation);
  for (Slot slot : tracker_.Forget()) layers_.Give(slot, 0);
  return objects;
}

/// The objects that are shown in this frame, the one with most pixels first.
std::vector<Slot> ObjectMemory::Shown(std::span<const ObjectLook> segments,
                                      std::span<const Slot> slot_of_label) const {
  const PerSlot<int>& n_seen = layers_.n_seen();
  PerSlot<int> n_segment{}, first_label{};
  for (size_t s = segments.size(); s > 0; --s) {
    n_segment[slot_of_label[s]] += segments[s - 1].n_pixels;
    first_label[slot_of_label[s]] = static_cast<int>(s);
  }
  std::vector<Slot> shown;
  for (int i = 1; i < kSlots; ++i) {
    const auto slot = static_cast<Slot>(i);
    const bool found = n_segment[slot] > 0 && n_seen[slot] > kOwn * n_segment[slot];
    const bool still = tracker_.Id(slot) != 0 && n_seen[slot] > kStill * tracker_.LastPixels(slot);
    if (n_seen[slot] > 0 && (found || still)) shown.push_back(slot);
  }
  std::stable_sort(shown.begin(), shown.end(), [&](Slot a, Slot b) {
    return n_seen[a] != n_seen[b] ? n_seen[a] > n_seen[b] : first_label[a] < first_label[b];
  });
  return shown;
}

/// Writes labels and silhouettes of the objects shown, and has the tracker look at them.
SteadyObjects ObjectMemory::Write(const RgbdImage& image, const std::vector<Slot>& shown,
                                  Segmentation& segmentation) {
  PerSlot<uint16_t> label_of_slot{};
  for (size_t k = 0; k < shown.size(); ++k) {
    label_of_slot[shown[k]] = static_cast<uint16_t>(k + 1);
  }
  const auto write = [&](const std::vector<Slot>& slots, std::vector<uint16_t>& labels) {
    const SceneLayers::Rectangle& region = layers_.region();
    labels.assign(slots.size(), 0);
    for (int v = region.top; v < region.bottom; ++v) {
      const size_t row = image.Index(0, v);
      std::transform(slots.begin() + row + region.left, slots.begin() + row + region.right,
                     labels.begin() + row + region.left,
                     [&](Slot slot) { return label_of_slot[slot]; });
    }
  };
  SteadyObjects objects;
  write(layers_.seen(), segmentation.labels);
  write(layers_.silhouettes(), objects.silhouettes);
  segmentation.n_objects = static_cast<int>(shown.size());
  const auto looks = LookAt(image, segmentation.labels, segmentation.n_objects);
  for (size_t k = 0; k < shown.size(); ++k) tracker_.Show(shown[k], looks[k]);
  for (Slot slot : shown) objects.ids.push_back(tracker_.Id(slot));
  return objects;
}

}  // namespace beckon::perception
