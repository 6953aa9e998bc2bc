#include "services/ui_bridge/speech/acoustic_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace beckon::ui_bridge::speech {
namespace {

/// A step of mixture weights: 2^10 steps of the logarithm to base 1.0001.
constexpr float kWeightStep = 1024 * 1e-4F;
/// A codebook is never worse than the best one by more than this, nats: what fits no phone says
/// nothing about which it was.
constexpr float kMostApart = 96 * kWeightStep;

enum Position { kInside = 0, kBegin = 1, kEnd = 2, kSingle = 3 };  // of a phone in its word

const std::array<float, 256>& Weights() {
  static const std::array<float, 256> weights = [] {
    std::array<float, 256> table{};
    for (size_t i = 0; i < table.size(); ++i)
      table[i] = std::exp(-kWeightStep * static_cast<float>(i));
    return table;
  }();
  return weights;
}

}  // namespace

std::vector<Observation> Observations(const std::vector<Cepstrum>& cepstra) {
  std::vector<Observation> result(cepstra.size());
  const auto n = static_cast<int>(cepstra.size());
  const auto at = [&](int t) -> const Cepstrum& {
    return cepstra[static_cast<size_t>(std::clamp(t, 0, n - 1))];
  };
  for (int t = 0; t < n; ++t) {
    auto& x = result[static_cast<size_t>(t)];
    x[0] = at(t);
    for (size_t i = 0; i < kCepstrum; ++i) {
      x[1][i] = at(t + 2)[i] - at(t - 2)[i];
      x[2][i] = (at(t + 3)[i] - at(t - 1)[i]) - (at(t + 1)[i] - at(t - 3)[i]);
    }
  }
  return result;
}

const PhoneModel& AcousticModel::Alone(Phone phone) const {
  return models_[static_cast<size_t>(base_[std::min(phone, kPhones)])];
}

std::vector<PhoneModel> AcousticModel::Word(const Pronunciation& sounds) const {
  std::vector<PhoneModel> models;
  const size_t n = sounds.size();
  for (size_t i = 0; i < n; ++i) {
    const int position = n == 1 ? kSingle : i == 0 ? kBegin : i + 1 == n ? kEnd : kInside;
    models.push_back(Between(position, base_[sounds[i]], base_[i == 0 ? kSilence : sounds[i - 1]],
                             base_[i + 1 == n ? kSilence : sounds[i + 1]]));
  }
  return models;
}

/// Walks the tree of positions, phones, left and right neighbours; -1 where it has no such leaf.
int AcousticModel::Find(int position, int base, int left, int right) const {
  size_t first = 0;
  auto n = size_t{kSingle + 1};
  for (const int context : {position, base, left, right}) {
    const auto begin = tree_.begin() + static_cast<ptrdiff_t>(first);
    const auto end = begin + static_cast<ptrdiff_t>(n);
    const auto node = std::find_if(begin, end, [&](const auto& x) { return x.context == context; });
    if (node == end) return -1;
    if (node->children == 0) return node->down;
    first = static_cast<size_t>(node->down);
    n = static_cast<size_t>(node->children);
  }
  return -1;
}

/// Neighbours that the model has not met: as elsewhere in a word, else alone.
const PhoneModel& AcousticModel::Between(int position, int base, int left, int right) const {
  int found = Find(position, base, left, right);
  for (int other = 0; found < 0 && other <= kSingle; ++other)
    found = Find(other, base, left, right);
  return models_[static_cast<size_t>(found < 0 ? base : found)];
}

AcousticModel::Best AcousticModel::FindBest(const Codebook& codebook, size_t stream,
                                            const Cepstrum& x) const {
  std::vector<float> scores = codebook.offsets[stream];
  for (size_t i = 0; i < kCepstrum; ++i) {
    const float* mean = &codebook.means[stream][i * densities_];
    const float* precision = &codebook.half_precisions[stream][i * densities_];
    for (size_t d = 0; d < densities_; ++d) {
      const float apart = x[i] - mean[d];
      scores[d] -= apart * apart * precision[d];
    }
  }
  std::array<float, kTop> top;
  top.fill(-std::numeric_limits<float>::infinity());
  Best best;
  for (size_t d = 0; d < densities_; ++d) {
    const float score = scores[d];
    if (score <= top.back()) continue;
    size_t place = kTop - 1;
    for (; place > 0 && score > top[place - 1]; --place) {
      top[place] = top[place - 1];
      best.density[place] = best.density[place - 1];
    }
    top[place] = score;
    best.density[place] = static_cast<uint16_t>(d);
  }
  best.score = top[0];
  for (size_t k = 0; k < kTop; ++k) best.share[k] = std::exp(top[k] - top[0]);
  return best;
}

void AcousticModel::ScoreFrame(const Observation& x, std::span<float> scores) const {
  std::vector<std::array<Best, kStreams>> best(codebooks_.size());
  for (size_t s = 0; s < kStreams; ++s) {
    float most = -std::numeric_limits<float>::infinity();
    for (size_t c = 0; c < codebooks_.size(); ++c) {
      best[c][s] = FindBest(codebooks_[c], s, x[s]);
      most = std::max(most, best[c][s].score);
    }
    for (auto& streams : best) streams[s].score = std::max(streams[s].score, most - kMostApart);
  }
  const auto& weight = Weights();
  for (size_t c = 0; c < codebooks_.size(); ++c) {
    const float base = best[c][0].score + best[c][1].score + best[c][2].score;
    for (const uint16_t senone : codebooks_[c].senones) {
      float product = 1;
      for (size_t s = 0; s < kStreams; ++s) {
        float sum = 0;
        for (size_t k = 0; k < kTop; ++k) {
          sum +=
              best[c][s].share[k] * weight[weights_[s][best[c][s].density[k] * senones_ + senone]];
        }
        product *= sum;
      }
      scores[senone] = base + std::log(product);
    }
  }
}

StateScores AcousticModel::Score(std::span<const Observation> sound) const {
  StateScores scores(sound.size(), senones_);
  for (size_t t = 0; t < sound.size(); ++t) ScoreFrame(sound[t], scores.Frame(static_cast<int>(t)));
  return scores;
}

}  // namespace beckon::ui_bridge::speech
