// Many words as one tree of their beginnings, so that all of them are compared with sound at once:
// rivals of what may be said.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "services/ui_bridge/speech/acoustic_model.h"

namespace beckon::ui_bridge::speech {

class WordTree {
 public:
  struct Word {
    Pronunciation sounds;
    double cost = 0;  // nats, of saying it
  };

  WordTree(const AcousticModel& model, const std::vector<Word>& words);

  /// Words that sound like these are not compared from now on.
  void LeaveOut(const std::set<Pronunciation>& sounds);
  /// Score of the best word that fills all frames, less its cost; nothing where all are too long.
  std::optional<double> BestWord(const StateScores& scores) const;
  /// Likewise of any sequence of words.
  std::optional<double> BestSequence(const StateScores& scores) const;

 private:
  struct Node {
    PhoneModel phone;
    size_t child = 0;    // the first one; 0: none
    size_t sibling = 0;  // the next child of its parent; 0: none
  };
  struct End {
    size_t node = 0;
    float cost = 0;
  };
  std::optional<double> Best(const StateScores& scores, bool sequence) const;

  std::vector<Node> nodes_{1};  // the first one is where words begin
  std::map<Pronunciation, End> words_;
  std::vector<End> ends_;  // of the words that are compared
};

}  // namespace beckon::ui_bridge::speech
