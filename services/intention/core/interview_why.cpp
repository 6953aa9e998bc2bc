// What an interview says about its reasons.
#include <algorithm>

#include "services/intention/core/interview.h"
#include "services/intention/core/why.h"

namespace beckon::intention {

void Interview::Justify(msg::Query& query, const Question& question, const Belief& belief) const {
  const Why why =
      Explain(situation_, input_.history, prior_, belief, question, InterfaceOf(input_.device));
  query.why =
      WhyText(affordances_, situation_, input_.history, belief, question, why, input_.phrases);
  query.information_bits = why.information_bits;
  for (const Prospect& prospect : why.prospects) {
    query.prospects.push_back({static_cast<float>(std::clamp(prospect.probability, 0.0, 1.0)),
                               static_cast<float>(prospect.questions_left),
                               static_cast<float>(prospect.seconds_left)});
  }
  for (const LikelyTask& task : why.likeliest) {
    const Pair& pair = situation_.pairs[task.pair];
    query.likeliest.push_back({affordances_.actions()[pair.action].name, Ref(pair.object),
                               std::clamp(task.prior, 0.0, 1.0),
                               std::clamp(task.posterior, 0.0, 1.0), task.times,
                               task.sessions_ago});
  }
}

void Interview::JustifyWhatIsIt(msg::Query& query, bool in_doubt) const {
  constexpr size_t kNamed = 2;
  std::vector<std::pair<std::string, double>> likeliest;
  for (const auto& seen : input_.table[asked_.object].object.probabilities) {
    const int category = affordances_.FindCategory(seen.category);
    const bool offered =
        std::find(asked_.offer.begin(), asked_.offer.end(), category) != asked_.offer.end();
    if (offered && likeliest.size() < kNamed)
      likeliest.emplace_back(seen.category, seen.probability);
  }
  query.why = WhyWhatIsIt(likeliest, in_doubt || situation_.pairs.empty(), input_.phrases);
}

}  // namespace beckon::intention
