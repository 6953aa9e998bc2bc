// The acoustic model of PocketSphinx ("phonetically tied mixtures"): how likely each tied state of
// its phones makes what a frame of sound holds. Reading and scoring only; searches are in search.h.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "services/base/result.h"
#include "services/ui_bridge/speech/phones.h"

namespace beckon::ui_bridge::speech {

inline constexpr int kCepstrum = 13;  // mel cepstral coefficients of a frame
inline constexpr int kStreams = 3;    // they, their slope, their curvature
inline constexpr int kStates = 3;     // of each phone, left to right

using Cepstrum = std::array<float, kCepstrum>;
using Observation = std::array<Cepstrum, kStreams>;

/// Each frame with its slope and curvature, over 7 frames; the ends are repeated.
std::vector<Observation> Observations(const std::vector<Cepstrum>& cepstra);

/// A phone's three states, each an index into the scores of a frame, and what staying in one and
/// leaving it costs (logarithms, at most 0).
struct PhoneModel {
  std::array<uint16_t, kStates> senones{};
  std::array<float, kStates> stay{};
  std::array<float, kStates> leave{};
  bool operator==(const PhoneModel&) const = default;
};

/// Log-likelihoods in nats of all tied states, frame after frame.
class StateScores {
 public:
  StateScores(size_t frames, size_t senones) : senones_(senones), scores_(frames * senones) {}
  int frames() const { return static_cast<int>(senones_ == 0 ? 0 : scores_.size() / senones_); }
  std::span<float> Frame(int t) { return {&scores_[static_cast<size_t>(t) * senones_], senones_}; }
  const float* At(int t) const { return &scores_[static_cast<size_t>(t) * senones_]; }

 private:
  size_t senones_;
  std::vector<float> scores_;
};

class AcousticModel {
 public:
  /// Files mdef, means, variances, sendump and transition_matrices in `folder`. The error names the
  /// file and what is wrong with it.
  static Result<AcousticModel> Load(const std::string& folder);

  /// The phone, or kSilence, whatever is beside it.
  const PhoneModel& Alone(Phone phone) const;
  /// Noises that are no phones: breath, and others.
  const std::vector<PhoneModel>& noises() const { return noises_; }
  /// A word said alone: each phone between its neighbours.
  std::vector<PhoneModel> Word(const Pronunciation& sounds) const;

  StateScores Score(std::span<const Observation> sound) const;

 private:
  friend class AcousticModelReader;
  static constexpr size_t kTop = 4;  // densities of a codebook that count
  struct Codebook {
    /// [coefficient][density], so that many densities are computed at once.
    std::vector<float> means[kStreams];
    std::vector<float> half_precisions[kStreams];  // 1 / (2 variance)
    std::vector<float> offsets[kStreams];          // [density]
    std::vector<uint16_t> senones;                 // that use it
  };
  struct Best {
    float score = 0;
    std::array<uint16_t, kTop> density{};
    std::array<float, kTop> share{};  // against the best one
  };
  struct TreeNode {
    int16_t context;
    int16_t children;
    int32_t down;  // first child, or a phone's index
  };

  Best FindBest(const Codebook& codebook, size_t stream, const Cepstrum& x) const;
  void ScoreFrame(const Observation& x, std::span<float> scores) const;
  int Find(int position, int base, int left, int right) const;
  const PhoneModel& Between(int position, int base, int left, int right) const;

  size_t densities_ = 0;
  size_t senones_ = 0;
  std::vector<Codebook> codebooks_;
  std::vector<uint8_t> weights_[kStreams];  // -log, [density][senone]
  std::vector<PhoneModel> models_;          // of the phones alone, then between others
  std::vector<TreeNode> tree_;
  std::vector<PhoneModel> noises_;
  std::array<int, kPhones + 1> base_{};  // index of each Phone among the model's
};

}  // namespace beckon::ui_bridge::speech
