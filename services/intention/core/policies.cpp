#include "services/intention/core/policies.h"

namespace beckon::intention {

Result<std::unique_ptr<Policy>> MakePolicy(const std::string& name, const Affordances& affordances,
                                           QueryFamilies families, double lambda) {
  if (name == "adaptive") {
    AdaptiveConfig config;
    config.families = families;
    return MakeAdaptivePolicy(config);
  }
  if (name == "oain") return MakeOainPolicy(affordances, lambda);
  if (name == "count") return MakeCountPolicy(affordances);
  if (name == "random") return MakeRandomPolicy(affordances);
  if (name == "random-scene") return MakeRandomScenePolicy();
  return Error{"unknown policy '" + name +
               "', expected adaptive, oain, count, random or random-scene"};
}

}  // namespace beckon::intention
