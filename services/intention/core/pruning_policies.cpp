// The dissertation's policy and the baselines it was compared with: different orders of the same
// queries.
#include <algorithm>
#include <map>
#include <random>

#include "services/intention/core/oain_network.h"
#include "services/intention/core/policies.h"
#include "services/intention/core/pruning_dialogue.h"

namespace beckon::intention {
namespace {

using Query = PruningDialogue::Query;

/// Max-marginals closer than this are a tie, and full queries come first in it.
constexpr double kTie = 1e-8;

/// Fisher-Yates, the same on every platform.
void Shuffle(std::vector<Query>& queries, uint64_t seed) {
  std::mt19937_64 random(seed);
  for (size_t i = queries.size(); i > 1; --i) std::swap(queries[i - 1], queries[random() % i]);
}

std::vector<Query> SceneQueries(const Situation& situation) {
  std::vector<Query> queries;
  uint64_t actions = 0;
  for (int i = 0; i < situation.pair_count(); ++i) {
    const Pair& pair = situation.pairs[i];
    queries.push_back({AskPair(situation, i), pair.action, pair.object, 0});
    actions |= uint64_t{1} << pair.action;
  }
  for (int action = 0; action < kMaxActions; ++action) {
    if (actions >> action & 1) queries.push_back({AskAction(action), action, -1, 0});
  }
  const uint64_t known = situation.KnownMask();
  for (int object = 0; object < static_cast<int>(situation.objects.size()); ++object) {
    if (known >> object & 1) queries.push_back({AskObject(object), -1, object, 0});
  }
  return queries;
}

bool IsFull(const Query& query) { return query.question.kind == QuestionKind::kFull; }

class OainPolicy : public Policy {
 public:
  explicit OainPolicy(const Affordances& affordances) : affordances_(affordances) {}

  std::unique_ptr<Dialogue> Begin(const Situation& situation, const UserHistory& history,
                                  const Interface&, uint64_t seed) const override {
    const OainNetwork network(affordances_, situation, history);
    auto queries = SceneQueries(situation);
    Shuffle(queries, seed);
    for (Query& query : queries) {
      query.probability = IsFull(query)       ? network.Full(query.question.Accepts(0))
                          : query.action >= 0 ? network.Action(query.action)
                                              : network.Object(query.object);
    }
    std::stable_sort(queries.begin(), queries.end(),
                     [](const Query& a, const Query& b) { return a.probability > b.probability; });
    // Runs of ties: what is within kTie of the run's best.
    for (auto first = queries.begin(); first != queries.end();) {
      const auto last = std::find_if(first, queries.end(), [&](const Query& query) {
        return query.probability < first->probability - kTie;
      });
      std::vector<Query> run(first, last);
      Shuffle(run, seed + static_cast<uint64_t>(first - queries.begin()) + 1);
      std::stable_partition(run.begin(), run.end(), IsFull);
      first = std::copy(run.begin(), run.end(), first);
    }
    return std::make_unique<PruningDialogue>(std::move(queries));
  }

 private:
  const Affordances& affordances_;
};

/// Action, then object, then full queries, each by how often the user's past had them.
class CountPolicy : public Policy {
 public:
  std::unique_ptr<Dialogue> Begin(const Situation& situation, const UserHistory& history,
                                  const Interface&, uint64_t seed) const override {
    auto queries = SceneQueries(situation);
    Shuffle(queries, seed);
    for (Query& query : queries) {
      const int category = query.object < 0 ? -1 : situation.objects[query.object].category;
      for (const PastSession& past : history) {
        const bool counts = (query.action < 0 || past.action == query.action) &&
                            (category < 0 || past.category == category);
        query.probability += counts ? 1.0 / static_cast<double>(history.size()) : 0;
      }
    }
    const auto phase = [](const Query& query) {
      return IsFull(query) ? 2 : query.action >= 0 ? 0 : 1;
    };
    std::stable_sort(queries.begin(), queries.end(), [&](const Query& a, const Query& b) {
      return phase(a) != phase(b) ? phase(a) < phase(b) : a.probability > b.probability;
    });
    return std::make_unique<PruningDialogue>(std::move(queries));
  }
};

class RandomScenePolicy : public Policy {
 public:
  std::unique_ptr<Dialogue> Begin(const Situation& situation, const UserHistory&, const Interface&,
                                  uint64_t seed) const override {
    auto queries = SceneQueries(situation);
    Shuffle(queries, seed);
    return std::make_unique<PruningDialogue>(std::move(queries));
  }
};

/// Over the vocabulary, whatever stands there; an object query names a category and a full query
/// means the nearest of it.
class RandomPolicy : public Policy {
 public:
  explicit RandomPolicy(const Affordances& affordances) : affordances_(affordances) {}

  std::unique_ptr<Dialogue> Begin(const Situation& situation, const UserHistory&, const Interface&,
                                  uint64_t seed) const override {
    std::vector<Query> queries;
    for (int action = 0; action < static_cast<int>(affordances_.actions().size()); ++action) {
      queries.push_back({AskAction(action), action, -1, 0});
    }
    for (int category = 0; category < static_cast<int>(affordances_.categories().size());
         ++category) {
      const uint64_t objects = situation.MaskOf(category);
      queries.push_back(
          {AskYesNo(QuestionKind::kObject, {kAny, objects, -1 - category}), -1, category, 0});
      for (const int action : affordances_.categories()[category].actions) {
        const int nearest = situation.Find(category, 1, action);
        const int pair = nearest >= 0 ? nearest : -1 - category;  // absent ones differ
        queries.push_back({AskYesNo(QuestionKind::kFull, {uint64_t{1} << action, objects, pair}),
                           action, category, 0});
      }
    }
    Shuffle(queries, seed);
    return std::make_unique<PruningDialogue>(std::move(queries));
  }

 private:
  const Affordances& affordances_;
};

}  // namespace

std::unique_ptr<Policy> MakeOainPolicy(const Affordances& affordances) {
  return std::make_unique<OainPolicy>(affordances);
}
std::unique_ptr<Policy> MakeCountPolicy() { return std::make_unique<CountPolicy>(); }
std::unique_ptr<Policy> MakeRandomScenePolicy() { return std::make_unique<RandomScenePolicy>(); }
std::unique_ptr<Policy> MakeRandomPolicy(const Affordances& affordances) {
  return std::make_unique<RandomPolicy>(affordances);
}

}  // namespace beckon::intention
