#include "services/intention/core/answer_errors.h"

#include <algorithm>

namespace beckon::intention {
namespace {

constexpr double kForgetting = 0.98;
constexpr size_t kOldest = 400;

}  // namespace

void Count(AnswerCounts& counts, int answers, int meant, int said) {
  if (answers > 2) {
    (meant == said ? counts.chose_right : counts.chose_wrong) += 1;
    return;
  }
  (meant == 0  ? said == 0 ? counts.meant_yes_said_yes : counts.meant_yes_said_no
   : said == 0 ? counts.meant_no_said_yes
               : counts.meant_no_said_no) += 1;
}

AnswerCounts PastAnswers(const UserHistory& history, const std::string& device) {
  AnswerCounts sum;
  double weight = 1;
  const size_t oldest = history.size() - std::min(history.size(), kOldest);
  for (size_t i = history.size(); i-- > oldest;) {
    const auto found = history[i].answers.find(device);
    if (found == history[i].answers.end()) continue;
    const AnswerCounts& counts = found->second;
    sum.meant_yes_said_yes += weight * counts.meant_yes_said_yes;
    sum.meant_yes_said_no += weight * counts.meant_yes_said_no;
    sum.meant_no_said_yes += weight * counts.meant_no_said_yes;
    sum.meant_no_said_no += weight * counts.meant_no_said_no;
    sum.chose_right += weight * counts.chose_right;
    sum.chose_wrong += weight * counts.chose_wrong;
    weight *= kForgetting;
  }
  return sum;
}

}  // namespace beckon::intention
