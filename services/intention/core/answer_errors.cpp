#include "services/intention/core/answer_errors.h"

#include <algorithm>

namespace beckon::intention {
namespace {

constexpr double kForgetting = 0.98;
constexpr size_t kOldest = 400;

}  // namespace

void Count(AnswerCounts& counts, bool meant_yes, bool said_yes) {
  (meant_yes  ? said_yes ? counts.meant_yes_said_yes : counts.meant_yes_said_no
   : said_yes ? counts.meant_no_said_yes
              : counts.meant_no_said_no) += 1;
}

AnswerCounts PastAnswers(const UserHistory& history, const std::string& device) {
  AnswerCounts sum;
  double weight = 1;
  const size_t oldest = history.size() - std::min(history.size(), kOldest);
  for (size_t i = history.size(); i-- > oldest;) {
    if (history[i].device != device) continue;
    const AnswerCounts& counts = history[i].answers;
    sum.meant_yes_said_yes += weight * counts.meant_yes_said_yes;
    sum.meant_yes_said_no += weight * counts.meant_yes_said_no;
    sum.meant_no_said_yes += weight * counts.meant_no_said_yes;
    sum.meant_no_said_no += weight * counts.meant_no_said_no;
    weight *= kForgetting;
  }
  return sum;
}

}  // namespace beckon::intention
