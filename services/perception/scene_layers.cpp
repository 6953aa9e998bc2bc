// Compares frames with memory block by block, and takes them in pixel by pixel.
#include "services/perception/scene_layers.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace beckon::perception {
namespace {

constexpr float kSigmas = 4;       // depths that differ by less show the same surface
constexpr uint8_t kUndone = 2;     // frames against a slot that one for it makes up for
constexpr float kMost_m = 100;     // infinity is no depth
constexpr size_t kTogether = 4;    // changed blocks that touch: fewer are an outline that strays
constexpr float kFollow = 0.125f;  // of the difference, by which depth is averaged

}  // namespace

void SceneLayers::Fit(const RgbdImage& image) {
  const auto camera = [](const Intrinsics& i) { return std::array{i.fx, i.fy, i.cx, i.cy}; };
  if (width_ == image.width && height_ == image.height &&
      camera(intrinsics_) == camera(image.intrinsics)) {
    return;
  }
  width_ = image.width;
  height_ = image.height;
  intrinsics_ = image.intrinsics;
  const size_t n = image.depth_m.size();
  front_slot_.assign(n, 0);
  behind_slot_.assign(n, 0);
  seen_.assign(n, 0);
  front_depth_m_.assign(n, 0);
  behind_depth_m_.assign(n, 0);
  doubt_.assign(n, 0);
  relation_.assign(n, Relation::kMissing);
  region_ = {};
}

/// Whole blocks around all that is or was an object. Most of an image is none: in each row, only
/// what may widen the rectangle is looked through, and most of that at once.
SceneLayers::Rectangle SceneLayers::Region(std::span<const uint16_t> labels) const {
  const std::vector<uint16_t> none(width_, 0);
  const auto any = [&](std::span<const uint16_t> part) {
    return !part.empty() && std::memcmp(part.data(), none.data(), part.size_bytes()) != 0;
  };
  Rectangle r{width_, height_, 0, 0};
  for (int v = 0; v < height_; ++v) {
    const auto row = labels.subspan(static_cast<size_t>(v) * width_, width_);
    if (!any(row)) continue;
    r.top = std::min(r.top, v);
    r.bottom = v + 1;
    if (any(row.first(r.left))) {
      r.left = 0;
      while (row[r.left] == 0) ++r.left;
    }
    if (any(row.subspan(r.right))) {
      r.right = width_;
      while (row[r.right - 1] == 0) --r.right;
    }
  }
  if (region_.right > region_.left) {
    r = {std::min(r.left, region_.left), std::min(r.top, region_.top),
         std::max(r.right, region_.right), std::max(r.bottom, region_.bottom)};
  }
  if (r.right <= r.left) return {};
  const auto up = [](int x, int most) {
    return std::min(most, (x + kBlock - 1) / kBlock * kBlock);
  };
  return {r.left / kBlock * kBlock, r.top / kBlock * kBlock, up(r.right, width_),
          up(r.bottom, height_)};
}

float SceneLayers::Tolerance(float depth_m) const {
  const float off = depth_m - static_cast<float>(sensor_.from_m);
  return kSigmas * (static_cast<float>(sensor_.floor_m) +
                    static_cast<float>(sensor_.growth_per_m) * off * off);
}

SceneLayers::Relation SceneLayers::Relate(size_t i, float depth_m) const {
  if (!(depth_m > 0 && depth_m < kMost_m)) return Relation::kMissing;
  if (front_depth_m_[i] == 0) return Relation::kFirst;
  const float off_m = depth_m - front_depth_m_[i], tolerance_m = Tolerance(depth_m);
  if (std::abs(off_m) <= tolerance_m) return Relation::kSame;
  if (behind_slot_[i] != 0 && std::abs(depth_m - behind_depth_m_[i]) <= tolerance_m) {
    return Relation::kBehind;
  }
  return off_m < 0 ? Relation::kNearer : Relation::kFarther;
}

void SceneLayers::Count(size_t i, Relation relation, float depth_m, uint16_t label,
                        SceneEvidence& evidence) const {
  const Slot front = front_slot_[i], behind = behind_slot_[i];
  switch (relation) {
    case Relation::kMissing:
      ++evidence.unseen[front];
      ++evidence.unseen[behind];
      return;
    case Relation::kFirst:
      return;
    case Relation::kBehind:
      ++evidence.same[label][behind];
      ++evidence.empty[front];
      return;
    case Relation::kSame:
      ++evidence.same[label][front];
      break;
    case Relation::kNearer:
      ++evidence.hidden[front];
      break;
    case Relation::kFarther:
      ++evidence.empty[front];
      break;
  }
  if (behind != 0) ++(depth_m < behind_depth_m_[i] ? evidence.hidden : evidence.empty)[behind];
}

void SceneLayers::CompareBlock(const RgbdImage& image, std::span<const uint16_t> labels, int bu,
                               int bv, SceneEvidence& evidence) {
  int n_known = 0, n_off = 0;
  const int right = std::min(bu + kBlock, region_.right);
  const int bottom = std::min(bv + kBlock, region_.bottom);
  for (int v = bv; v < bottom; ++v) {
    for (int u = bu; u < right; ++u) {
      const size_t i = image.Index(u, v);
      const Relation relation = Relate(i, image.depth_m[i]);
      relation_[i] = relation;
      n_known += relation >= Relation::kSame;
      n_off += relation > Relation::kSame;
      if ((front_slot_[i] | behind_slot_[i]) != 0) {
        Count(i, relation, image.depth_m[i], labels[i], evidence);
      }
    }
  }
  const size_t row = static_cast<size_t>(width_) / kBlock + 3;
  block_changed_[(bv / kBlock + 1) * row + bu / kBlock + 1] =
      n_known >= kBlock && n_off * 4 >= n_known * 3;
}

SceneEvidence SceneLayers::Compare(const RgbdImage& image, std::span<const uint16_t> labels,
                                   int n_labels) {
  Fit(image);
  region_ = Region(labels);
  block_changed_.assign(
      (static_cast<size_t>(width_) / kBlock + 3) * (static_cast<size_t>(height_) / kBlock + 3), 0);
  SceneEvidence evidence;
  evidence.same.resize(n_labels + 1);
  for (int v = region_.top; v < region_.bottom; v += kBlock) {
    for (int u = region_.left; u < region_.right; u += kBlock) {
      CompareBlock(image, labels, u, v, evidence);
    }
  }
  DropLoneChanges();
  for (const auto& of_label : evidence.same) {
    for (int slot = 1; slot < kSlots; ++slot) evidence.visible[slot] += of_label[slot];
  }
  return evidence;
}

/// Forgets changes of few blocks: outlines stray that far, things that move change more.
void SceneLayers::DropLoneChanges() {
  constexpr uint8_t kChanged = 1, kReached = 2;
  const auto row = static_cast<ptrdiff_t>(width_) / kBlock + 3;
  for (size_t start = 0; start < block_changed_.size(); ++start) {
    if (block_changed_[start] != kChanged) continue;
    together_.assign(1, start);
    block_changed_[start] = kReached;
    for (size_t next = 0; next < together_.size(); ++next) {
      for (const ptrdiff_t step :
           {-row - 1, -row, -row + 1, ptrdiff_t{-1}, ptrdiff_t{1}, row - 1, row, row + 1}) {
        const size_t beside = together_[next] + step;
        if (block_changed_[beside] != kChanged) continue;
        block_changed_[beside] = kReached;
        together_.push_back(beside);
      }
    }
    if (together_.size() >= kTogether) continue;
    for (size_t block : together_) block_changed_[block] = 0;
  }
}

/// Whether the pixel's block or one beside it changed: what moves leaves slivers beside whole
/// blocks.
bool SceneLayers::ChangedAround(int u, int v) const {
  const size_t row = static_cast<size_t>(width_) / kBlock + 3;
  const uint8_t* at = &block_changed_[(v / kBlock + 1) * row + u / kBlock + 1];
  return (at[0] | at[-1] | at[1] | *(at - row) | at[row]) != 0;
}

void SceneLayers::Take(const RgbdImage& image, std::span<const uint16_t> labels,
                       std::span<const Slot> slot_of_label, const SlotTraits& traits) {
  Rectangle used{width_, height_, 0, 0};
  std::fill(seen_.begin(), seen_.end(), Slot{0});
  n_seen_ = {};
  for (int v = region_.top; v < region_.bottom; ++v) {
    bool changed = false;
    for (int u = region_.left; u < region_.right; ++u) {
      const size_t i = image.Index(u, v);
      if (u % kBlock == 0) changed = ChangedAround(u, v);
      TakePixel(i, image.depth_m[i], slot_of_label[labels[i]], changed, traits);
      if ((front_slot_[i] | behind_slot_[i]) == 0) continue;
      ++n_seen_[seen_[i]];
      used = {std::min(used.left, u), std::min(used.top, v), std::max(used.right, u + 1), v + 1};
    }
  }
  region_ = used;
}

void SceneLayers::TakePixel(size_t i, float depth_m, Slot slot, bool changed,
                            const SlotTraits& traits) {
  const Relation relation = relation_[i];
  if (relation == Relation::kMissing) return;
  const bool same = relation == Relation::kSame;
  if (same) front_depth_m_[i] += kFollow * (depth_m - front_depth_m_[i]);
  if (same && slot == front_slot_[i]) {
    doubt_[i] -= std::min(doubt_[i], kUndone);
    seen_[i] = slot;
    return;
  }
  const bool at_once = relation == Relation::kFirst || (same ? traits.at_once[slot] : changed);
  const bool believed = at_once || ++doubt_[i] >= settle_after_frames_;
  if (believed) Replace(i, depth_m, slot, traits);
  if (believed || same) seen_[i] = front_slot_[i];
}

void SceneLayers::Replace(size_t i, float depth_m, Slot slot, const SlotTraits& traits) {
  doubt_[i] = 0;
  Slot &front = front_slot_[i], &behind = behind_slot_[i];
  switch (relation_[i]) {
    case Relation::kSame:
      front = slot;
      return;
    case Relation::kBehind:
      front = settle_after_frames_ > 0 ? behind : slot;
      behind = 0;
      break;
    case Relation::kNearer:
      if (front != slot && traits.established[front]) {
        behind = front;
        behind_depth_m_[i] = front_depth_m_[i];
      }
      front = slot;
      break;
    default:
      if (depth_m > behind_depth_m_[i]) behind = 0;
      front = slot;
  }
  front_depth_m_[i] = depth_m;
}

void SceneLayers::Give(Slot from, Slot to) {
  std::replace(front_slot_.begin(), front_slot_.end(), from, to);
  std::replace(behind_slot_.begin(), behind_slot_.end(), from, to);
}

}  // namespace beckon::perception
