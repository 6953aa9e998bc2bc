// A front end as the model knows it: what it can ask, how long that takes, how wrong its answers
// are.
#pragma once

#include "services/intention/core/error_model.h"
#include "services/intention/core/question.h"

namespace beckon::intention {

enum class InterfaceKind {
  kYesNo,   // yes/no questions only
  kChoice,  // all options at once, one is chosen
  kScan,    // options one after another, a press takes the one that is shown
  kVector   // all options at once, an answer is a probability for each
};

struct Interface {
  InterfaceKind kind = InterfaceKind::kYesNo;
  int max_options = 2;              // answers of a question, "none of these" among them; >= 2
  double seconds_per_question = 1;  // > 0
  double seconds_per_option = 0;    // >= 0; of a scan: until the next one is shown
  ErrorModel errors;

  /// Without errors, a second a question: seconds are questions.
  static Interface YesNo(const ErrorModel& errors = ErrorModel::Exact({})) {
    Interface interface;
    interface.errors = errors;
    return interface;
  }

  /// Whether more than yes/no questions can be asked.
  bool Choices() const { return kind != InterfaceKind::kYesNo && max_options > 2; }

  /// Expected time of a question with `answers` answers of which `said` is given. A scan is over as
  /// soon as the wanted option comes.
  double Seconds(int answers, int said) const {
    const int shown = kind == InterfaceKind::kScan ? said + 1 : answers;
    return seconds_per_question + seconds_per_option * shown;
  }
};

}  // namespace beckon::intention
