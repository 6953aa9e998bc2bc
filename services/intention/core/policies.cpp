#include "services/intention/core/policies.h"

#include <cmath>

namespace beckon::intention {

Result<std::unique_ptr<Policy>> MakePolicy(const std::string& name, const Affordances& affordances,
                                           QueryFamilies families, double lambda) {
  if (name == "adaptive") {
    AdaptiveConfig config;
    config.families = families;
    return MakeAdaptivePolicy(config);
  }
  if (name == "oain") {
    if (!std::isfinite(lambda) || lambda <= 0) {
      return Error{"policy oain: learning rate " + std::to_string(lambda) +
                   ", expected a number above 0"};
    }
    return MakeOainPolicy(affordances, lambda);
  }
  if (name == "count") return MakeCountPolicy(affordances);
  if (name == "random") return MakeRandomPolicy(affordances);
  if (name == "random-scene") return MakeRandomScenePolicy();
  return Error{"unknown policy '" + name +
               "', expected adaptive, oain, count, random or random-scene"};
}

}  // namespace beckon::intention
