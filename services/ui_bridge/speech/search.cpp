#include "services/ui_bridge/speech/search.h"

#include <algorithm>

namespace beckon::ui_bridge::speech {
namespace {

/// Sum of what is passed through in `span`, from its first state to leaving its last.
struct Trellis {
  size_t states;
  std::vector<float> score;  // [frame][state], of the best path up to there
  std::vector<bool> moved;   // [frame][state]: it came from the state before

  Trellis(size_t frames, size_t n)
      : states(n), score(frames * n, kUnreachable), moved(frames * n) {}
  float& At(size_t t, size_t s) { return score[t * states + s]; }
};

}  // namespace

std::optional<Alignment> Align(const StateScores& scores, const Pronunciation& sounds,
                               const std::vector<PhoneModel>& models) {
  const auto frames = static_cast<size_t>(scores.frames());
  const size_t n = models.size() * kStates;
  if (n == 0 || frames < n) return std::nullopt;
  Trellis trellis(frames, n);
  for (size_t t = 0; t < frames; ++t) {
    const float* frame = scores.At(static_cast<int>(t));
    // No further than time allows, and not so late that the rest does not fit.
    const size_t first = n > frames - t ? n - (frames - t) : 0;
    for (size_t s = first; s < std::min(n, t + 1); ++s) {
      const PhoneModel& model = models[s / kStates];
      const size_t state = s % kStates;
      float best = t == 0 ? 0 : trellis.At(t - 1, s) + model.stay[state];
      if (t > 0 && s > 0) {
        const float leave = models[(s - 1) / kStates].leave[(s - 1) % kStates];
        const float entered = trellis.At(t - 1, s - 1) + leave;
        if (entered > best) {
          best = entered;
          trellis.moved[t * n + s] = true;
        }
      }
      trellis.At(t, s) = best + frame[model.senones[state]];
    }
  }
  if (trellis.At(frames - 1, n - 1) <= kUnreachable / 2) return std::nullopt;
  Alignment alignment;
  auto end = frames;
  float end_score = trellis.At(frames - 1, n - 1);
  for (size_t t = frames, s = n; t-- > 0;) {
    const size_t state = s - 1;
    const bool first_frame = t == 0;
    const bool moved = trellis.moved[t * n + state];
    if (!first_frame && !moved) continue;
    if (state % kStates == 0) {
      const float before = first_frame ? 0 : trellis.At(t - 1, state - 1);
      alignment.push_back({sounds[state / kStates], static_cast<int>(t), static_cast<int>(end),
                           end_score - before});
      end = t;
      end_score = before;
    }
    --s;
  }
  std::ranges::reverse(alignment);
  return alignment;
}

Alignment FreePhones(const StateScores& scores, const AcousticModel& model) {
  std::vector<PhoneModel> models;
  for (Phone phone = 0; phone <= kPhones; ++phone) models.push_back(model.Alone(phone));
  models.insert(models.end(), model.noises().begin(), model.noises().end());
  struct Token {
    float score = kUnreachable;
    int begin = 0;  // frame in which its phone began
  };
  struct Ended {
    float score = 0;  // of the best path whose last phone ends before a frame
    size_t model = 0;
    int begin = 0;
  };
  std::vector<std::array<Token, kStates>> tokens(models.size());
  const int frames = scores.frames();
  std::vector<Ended> ended(static_cast<size_t>(frames) + 1);
  for (int t = 0; t < frames; ++t) {
    const float* frame = scores.At(t);
    Ended best{.score = kUnreachable};
    for (size_t m = 0; m < models.size(); ++m) {
      const PhoneModel& phone = models[m];
      auto& token = tokens[m];
      for (size_t s = kStates; s-- > 0;) {
        Token entered = s == 0 ? Token{ended[static_cast<size_t>(t)].score, t} : token[s - 1];
        if (s > 0) entered.score += phone.leave[s - 1];
        token[s].score += phone.stay[s];
        if (entered.score > token[s].score) token[s] = entered;
        token[s].score = std::max(kUnreachable, token[s].score + frame[phone.senones[s]]);
      }
      const float score = token[kStates - 1].score + phone.leave[kStates - 1];
      if (score > best.score) best = {score, m, token[kStates - 1].begin};
    }
    ended[static_cast<size_t>(t) + 1] = best;
  }
  Alignment alignment;
  for (int t = frames; t > 0 && ended[static_cast<size_t>(t)].score > kUnreachable / 2;) {
    const Ended& last = ended[static_cast<size_t>(t)];
    const Phone phone = last.model < kPhones ? static_cast<Phone>(last.model) : kSilence;
    alignment.push_back(
        {phone, last.begin, t, last.score - ended[static_cast<size_t>(last.begin)].score});
    t = last.begin;
  }
  std::ranges::reverse(alignment);
  return alignment;
}

}  // namespace beckon::ui_bridge::speech
