#include "services/ui_bridge/speech/word_tree.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "services/ui_bridge/speech/search.h"

namespace beckon::ui_bridge::speech {
namespace {

/// Nats: what is that much worse than the best path so far is given up.
constexpr float kBeam = 120;

}  // namespace

WordTree::WordTree(const AcousticModel& model, const std::vector<Word>& words) {
  std::map<std::tuple<size_t, std::array<uint16_t, kStates>>, size_t> children;
  for (const auto& word : words) {
    size_t node = 0;
    for (const auto& phone : model.Word(word.sounds)) {
      const auto [child, added] = children.try_emplace({node, phone.senones}, nodes_.size());
      if (added) {
        nodes_.push_back({phone, 0, nodes_[node].child});
        nodes_[node].child = child->second;
      }
      node = child->second;
    }
    const auto cost = static_cast<float>(word.cost);
    const auto [end, added] = words_.try_emplace(word.sounds, End{node, cost});
    if (!added) end->second.cost = std::min(end->second.cost, cost);
  }
  LeaveOut({});
}

void WordTree::LeaveOut(const std::set<Pronunciation>& sounds) {
  ends_.clear();
  for (const auto& [word, end] : words_) {
    if (!sounds.contains(word)) ends_.push_back(end);
  }
}

std::optional<double> WordTree::BestWord(const StateScores& scores) const {
  return Best(scores, /*sequence=*/false);
}

std::optional<double> WordTree::BestSequence(const StateScores& scores) const {
  return Best(scores, /*sequence=*/true);
}

/// Viterbi over the nodes that a path has reached.
std::optional<double> WordTree::Best(const StateScores& scores, bool sequence) const {
  struct Token {
    std::array<float, kStates> states{kUnreachable, kUnreachable, kUnreachable};
    float entered = kUnreachable;  // from the phone before
    bool active = false;
    float Most() const { return std::max({entered, states[0], states[1], states[2]}); }
  };
  std::vector<Token> tokens(nodes_.size());
  std::vector<size_t> active;
  const auto enter_children = [&](size_t node, float score) {
    for (size_t child = nodes_[node].child; child != 0; child = nodes_[child].sibling) {
      tokens[child].entered = score;
      if (!std::exchange(tokens[child].active, true)) active.push_back(child);
    }
  };
  float entry = 0;  // of a word that begins in this frame
  float best = 0;
  for (int t = 0; t < scores.frames(); ++t) {
    const float* frame = scores.At(t);
    const float least = best - kBeam;
    for (size_t i = 0, n = active.size(); i < n; ++i) {
      const size_t node = active[i];
      const float leaves = tokens[node].states.back() + nodes_[node].phone.leave.back();
      if (leaves >= least) enter_children(node, leaves);
    }
    if (entry >= least) enter_children(0, entry);
    best = kUnreachable;
    std::erase_if(active, [&](size_t node) {
      Token& token = tokens[node];
      if (token.Most() < least) {
        token = {};
        return true;
      }
      const PhoneModel& phone = nodes_[node].phone;
      auto& states = token.states;
      for (size_t s = kStates; s-- > 0;) {
        const float moved = s == 0 ? token.entered : states[s - 1] + phone.leave[s - 1];
        states[s] = std::max(states[s] + phone.stay[s], moved) + frame[phone.senones[s]];
      }
      token.entered = kUnreachable;
      best = std::max(best, token.Most());
      return false;
    });
    entry = kUnreachable;
    if (!sequence && t + 1 < scores.frames()) continue;
    for (const End& end : ends_) {
      const float leaves = tokens[end.node].states.back() + nodes_[end.node].phone.leave.back();
      entry = std::max(entry, leaves - end.cost);
    }
  }
  if (scores.frames() == 0 || entry <= kUnreachable / 2) return std::nullopt;
  return entry;
}

}  // namespace beckon::ui_bridge::speech
