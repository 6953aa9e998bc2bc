// What it costs to take a segment for an object, and what becomes of segments that are none's.
#include "services/perception/tracker.h"

#include <algorithm>
#include <cmath>

#include "services/perception/assignment.h"

namespace beckon::perception {
namespace {

constexpr double kDifferent = 0.4;  // likeness below which a step is not the same object's
constexpr double kIntact = 0.6;     // part of an object that is in place: it did not jump
constexpr double kSameSize = 0.5;   // difference of the logarithms of areas
constexpr double kDoubted = 0.2;    // cost of a frame against an object: one of several is to lose
constexpr double kInPlace = 0.5;    // part of an object whose surface is seen where it was
constexpr double kHidden = 0.05;    // part of an object whose hiding may cut it in pieces
constexpr double kMoves_m = 0.005;  // in a frame; less is noise
constexpr int kExtrapolate = 10;    // frames an unseen object is thought to move on
constexpr int kEstablished = 5;     // frames
constexpr int kFewest = 3;          // frames that must speak against an object just seen
constexpr int kPassing = 3;         // frames after which what was never shown is forgotten
constexpr double kWhole = 0.8;      // part of the whole's area that tells how it looks
constexpr double kShrink = 0.99;    // of the whole's area in a frame, lest one error last
constexpr float kFollow = 0.1f;     // of a difference, by which colours are averaged

/// How much of a segment or of the object, whichever is smaller, shows the object's surface.
double Covered(int same, const ObjectLook& segment, const ObjectLook& last) {
  return same / std::max(1.0, static_cast<double>(std::min(segment.n_pixels, last.n_pixels)));
}

}  // namespace

double Tracker::Cost(const ObjectLook& segment, int label, Slot slot,
                     const SceneEvidence& evidence) const {
  const Track& track = tracks_[slot];
  if (track.part_of != 0) return kForbidden;
  const int same = evidence.same[label][slot];
  const double either = std::max(1, segment.n_pixels + evidence.visible[slot] - same);
  const auto unseen =
      static_cast<double>(std::min<int64_t>(frame_ - track.last_frame, kExtrapolate));
  const Eigen::Vector3d expected_C = track.last.centroid_C + unseen * track.step_C;
  const double away_m = (segment.centroid_C - expected_C).norm();
  const double likeness = Likeness(segment, track.whole);
  const double growth =
      std::abs(std::log(std::max(segment.area_m2, 1e-9) / std::max(track.whole.area_m2, 1e-9)));
  const int in_place = evidence.visible[slot] + evidence.hidden[slot] + evidence.unseen[slot];

  const bool stayed = Covered(same, segment, track.last) >= config_.min_overlap;
  const bool stepped = away_m <= config_.max_step_m && likeness >= kDifferent;
  const bool jumped = away_m <= config_.max_jump_m && likeness >= config_.min_likeness &&
                      growth <= kSameSize && in_place < kIntact * track.last.n_pixels;
  if (!stayed && !stepped && !jumped) return kForbidden;
  return std::min(away_m / config_.max_step_m, 2.0) + 2 * (1 - same / either) + 3 * (1 - likeness) +
         growth / 2;
}

void Tracker::AssignSegments(std::span<const ObjectLook> segments, const SceneEvidence& evidence,
                             std::vector<Slot>& slot_of_label) const {
  std::vector<Slot> used;
  for (int slot = 1; slot < kSlots; ++slot) {
    if (tracks_[slot].used) used.push_back(static_cast<Slot>(slot));
  }
  std::vector<double> costs;
  costs.reserve(segments.size() * used.size());
  for (size_t s = 0; s < segments.size(); ++s) {
    for (Slot slot : used) {
      costs.push_back(Cost(segments[s], static_cast<int>(s) + 1, slot, evidence));
    }
  }
  const auto columns = Assign(costs, static_cast<int>(segments.size()),
                              static_cast<int>(used.size()), kForbidden / 1000);
  for (size_t s = 0; s < segments.size(); ++s) {
    if (columns[s] >= 0) slot_of_label[s + 1] = used[columns[s]];
  }
}

/// The object on whose surface most of a segment lies; 0 = none.
Slot Tracker::PieceOf(const ObjectLook& segment, int label, const SceneEvidence& evidence) const {
  const auto& same = evidence.same[label];
  const auto most = std::max_element(same.begin() + 1, same.end());
  return *most < config_.min_overlap * segment.n_pixels ? Slot{0}
                                                        : static_cast<Slot>(most - same.begin());
}

TrackedSegments Tracker::Update(std::span<const ObjectLook> segments,
                                const SceneEvidence& evidence) {
  ++frame_;
  TrackedSegments result;
  result.slot_of_label.assign(segments.size() + 1, 0);
  AssignSegments(segments, evidence, result.slot_of_label);
  std::bitset<kSlots> found, in_pieces;
  std::vector<std::pair<int, Slot>> fresh;  // labels, and what they part from
  for (int label = 1; label <= static_cast<int>(segments.size()); ++label) {
    Slot& slot = result.slot_of_label[label];
    if (slot == 0) {
      const Slot whole = PieceOf(segments[label - 1], label, evidence);
      in_pieces[whole] = whole != 0;
      const bool parts = tracks_[whole].split + 1 >= Needed(tracks_[whole]);
      if (whole != 0 && !parts) slot = whole;
      if (slot == 0) fresh.emplace_back(label, whole);
    }
    found[slot] = slot != 0;
  }
  Vote(evidence, result, found, in_pieces);
  for (const auto& [label, whole] : fresh) {
    Slot& slot = result.slot_of_label[label];
    slot = Revive(segments[label - 1], whole);
    if (slot == 0) {
      slot = Add(segments[label - 1], whole != 0 ? config_.settle_after_frames : 1);
    }
  }
  return result;
}

/// Counts this frame for and against each object, and finds those that lost.
void Tracker::Vote(const SceneEvidence& evidence, TrackedSegments& result,
                   const std::bitset<kSlots>& found, const std::bitset<kSlots>& in_pieces) {
  for (int slot = 1; slot < kSlots; ++slot) {
    Track& track = tracks_[slot];
    if (!track.used) continue;
    const bool hidden = evidence.hidden[slot] > kHidden * track.last.n_pixels;
    track.split = in_pieces[slot] && !hidden ? track.split + 1 : std::max(0, track.split - 2);
    if (found[slot]) {
      ++track.trust;
      ++track.n_found;
      track.found_frame = frame_;
      track.doubt = std::max(0, track.doubt - 2);
      continue;
    }
    track.trust = std::max(0, track.trust - 2);
    if (evidence.visible[slot] < kInPlace * track.last.n_pixels) continue;
    if (++track.doubt < Needed(track)) continue;
    track.doubt = track.trust = 0;
    track.shown = false;
    const auto fewer = [slot](const auto& a, const auto& b) { return a[slot] < b[slot]; };
    const auto label =
        std::max_element(evidence.same.begin(), evidence.same.end(), fewer) - evidence.same.begin();
    track.part_of = result.slot_of_label[label];
    result.outvoted.emplace_back(static_cast<Slot>(slot), track.part_of);
  }
}

/// Frames against an object, more than for it, that are enough.
int Tracker::Needed(const Track& track) const {
  return std::clamp(track.n_found, std::min(kFewest, config_.settle_after_frames),
                    config_.settle_after_frames);
}

/// The object that was thought to be a part of another and is likest to a segment that parts from
/// it; 0 = none.
Slot Tracker::Revive(const ObjectLook& look, Slot whole) {
  Slot best = 0;
  for (int slot = 1; whole != 0 && slot < kSlots; ++slot) {
    const Track& track = tracks_[slot];
    if (track.part_of != whole) continue;
    const auto away = [&](int s) { return (tracks_[s].last.centroid_C - look.centroid_C).norm(); };
    if (away(slot) > config_.max_step_m) continue;
    if (best == 0 || away(slot) < away(best)) best = static_cast<Slot>(slot);
  }
  if (best == 0) return 0;
  tracks_[best].part_of = 0;
  tracks_[best].trust = config_.settle_after_frames;
  return best;
}

Slot Tracker::Add(const ObjectLook& look, int trust) {
  for (int slot = 1; slot < kSlots; ++slot) {
    if (tracks_[slot].used) continue;
    tracks_[slot] = {.used = true,
                     .last = look,
                     .whole = look,
                     .last_frame = frame_,
                     .found_frame = frame_,
                     .shown_frame = frame_,
                     .trust = trust};
    return static_cast<Slot>(slot);
  }
  return 0;
}

void Tracker::Show(Slot slot, const ObjectLook& look) {
  Track& track = tracks_[slot];
  if (track.id == 0) track.id = next_id_++;
  track.shown_frame = frame_;
  track.shown = true;
  if (track.found_frame != frame_) return;
  const Eigen::Vector3d moved_C = look.centroid_C - track.last.centroid_C;
  const bool moves = track.last_frame == frame_ - 1 && moved_C.norm() > kMoves_m &&
                     moved_C.norm() <= config_.max_step_m &&
                     look.n_pixels > kWhole * track.last.n_pixels;
  track.step_C = moves ? moved_C : Eigen::Vector3d::Zero();
  track.last = look;
  track.last_frame = frame_;
  const bool whole = look.area_m2 >= kWhole * track.whole.area_m2;
  track.whole.area_m2 = std::max(look.area_m2, kShrink * track.whole.area_m2);
  if (!whole) return;
  for (size_t i = 0; i < look.colours.size(); ++i) {
    track.whole.colours[i] += kFollow * (look.colours[i] - track.whole.colours[i]);
  }
}

std::vector<Slot> Tracker::Forget() {
  std::vector<Slot> forgotten;
  for (int slot = 1; slot < kSlots; ++slot) {
    Track& track = tracks_[slot];
    const int keep = track.id == 0 ? kPassing : config_.forget_after_frames;
    if (!track.used || frame_ - track.shown_frame <= keep) continue;
    track = {};
    for (Track& part : tracks_) {
      if (part.part_of == slot) part.part_of = 0;
    }
    forgotten.push_back(static_cast<Slot>(slot));
  }
  return forgotten;
}

bool Tracker::Remembers(int id) const {
  return std::any_of(tracks_.begin(), tracks_.end(), [id](const Track& t) { return t.id == id; });
}

SlotTraits Tracker::Traits() const {
  SlotTraits traits;
  for (int slot = 1; slot < kSlots; ++slot) {
    const Track& track = tracks_[slot];
    traits.established[slot] = track.n_found >= kEstablished;
    traits.at_once[slot] = !track.shown && track.trust >= config_.settle_after_frames;
  }
  return traits;
}

}  // namespace beckon::perception
