// The trials of a session's answers, until the confirmed task tells which class was meant in each.
#pragma once

#include <optional>
#include <vector>

#include "lcmtypes/messages.h"
#include "services/ui_bridge/bci/calibration.h"

namespace beckon::ui_bridge::bci {

/// Index of the option of `query` that is right where `task` is wanted (see lcmtypes/query_t.lcm:
/// the first that holds, the last option where none does). Empty where the task does not tell: what
/// another object is, or a question that has no right option.
std::optional<size_t> RightOption(const msg::Query& query, const msg::Task& task);

/// Answers that were taken back count too: what was wanted was the same, and leaving them out would
/// hide the decoder's errors.
class SessionTrials {
 public:
  /// An answer and the trials behind it (probabilities as received). Option i is class i.
  void Add(const msg::Query& query, std::vector<std::vector<double>> trials);
  /// Objects have other ids from now on, so what was asked before can no longer be told.
  void Renumbered() { questions_.clear(); }
  void Forget() { questions_.clear(); }
  size_t questions() const { return questions_.size(); }

  /// The session ended in `task`; forgets it.
  std::vector<KnownTrial> Confirm(const msg::Task& task);

 private:
  struct Asked {
    msg::Query query;
    std::vector<std::vector<double>> trials;
  };
  std::vector<Asked> questions_;
};

/// Whether a scene comes from another run of perception than the one before it.
class RunWatch {
 public:
  bool IsAnother(const msg::Scene& scene);

 private:
  int64_t seq_ = 0;
  Utime utime_ = 0;
};

}  // namespace beckon::ui_bridge::bci
