// The dissertation's policy and the baselines it was compared with: different orders of the same
// queries.
#include <algorithm>
#include <random>

#include "services/intention/core/oain_network.h"
#include "services/intention/core/policies.h"
#include "services/intention/core/pruning_dialogue.h"

namespace beckon::intention {
namespace {

using Query = PruningDialogue::Query;

/// Queries that follow each other in the ranking by less than this are a tie, and full queries come
/// first in it.
constexpr double kTie = 1e-8;

using Iterator = std::vector<Query>::iterator;

/// Fisher-Yates, the same on every platform.
void Shuffle(Iterator first, Iterator last, std::mt19937_64& random) {
  for (auto n = static_cast<uint64_t>(last - first); n > 1; --n) {
    std::swap(first[static_cast<long>(n - 1)], first[static_cast<long>(random() % n)]);
  }
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

/// Sets the probability of each query.
void Weigh(std::vector<Query>& queries, const OainMarginals& marginals) {
  for (Query& query : queries) {
    query.probability = IsFull(query)       ? marginals.pairs[query.question.Accepts(0)]
                        : query.action >= 0 ? marginals.actions[query.action]
                                            : marginals.objects[query.object];
  }
}

/// Likeliest first; ties to full queries, then by chance.
void Rank(Iterator first, Iterator last, std::mt19937_64& random) {
  std::stable_sort(first, last,
                   [](const Query& a, const Query& b) { return a.probability > b.probability; });
  while (first != last) {
    Iterator end = first + 1;
    while (end != last && end[-1].probability - end->probability < kTie) ++end;
    Shuffle(first, end, random);
    std::stable_partition(first, end, IsFull);
    first = end;
  }
}

class OainPolicy : public Policy {
 public:
  OainPolicy(const Affordances& affordances, double lambda)
      : affordances_(affordances), lambda_(lambda) {}

  std::unique_ptr<Dialogue> Begin(const Situation& situation, const UserHistory& history,
                                  const Interface&, uint64_t seed) const override {
    const OainNetwork network(affordances_, situation, CountPairs(history), lambda_);
    auto queries = SceneQueries(situation);
    Weigh(queries, network.MaxMarginals());
    std::mt19937_64 random(seed);
    Rank(queries.begin(), queries.end(), random);
    return std::make_unique<PruningDialogue>(std::move(queries));
  }

 private:
  const Affordances& affordances_;
  const double lambda_;
};

/// The published count baseline: action, then object, then full queries, each by the max-marginals
/// of a network that learnt the intentions of the author's group 1 and nothing since. How often he
/// had it learn each is not told: 16 times explains his published counts best (all of them are
/// possible with it; fewer than 15 rule many out, more make ties where he has none).
class CountPolicy : public Policy {
 public:
  explicit CountPolicy(const Affordances& affordances) : affordances_(affordances) {
    constexpr int kTimes = 16;
    constexpr const char* kGroup1[][2] = {{"Box", "Grasp"},
                                          {"Box", "Open"},
                                          {"Carton", "Grasp"},
                                          {"Carton", "Open"},
                                          {"Carton", "Pour"}};
    for (const auto& [category, action] : kGroup1) {
      learnt_[{affordances.FindCategory(category), affordances.FindAction(action)}] = kTimes;
    }
  }

  std::unique_ptr<Dialogue> Begin(const Situation& situation, const UserHistory&, const Interface&,
                                  uint64_t seed) const override {
    auto queries = SceneQueries(situation);
    Weigh(queries, OainNetwork(affordances_, situation, learnt_).MaxMarginals());
    const auto objects = std::stable_partition(queries.begin(), queries.end(), [](const Query& q) {
      return q.question.kind == QuestionKind::kAction;
    });
    const auto full = std::stable_partition(objects, queries.end(), [](const Query& q) {
      return q.question.kind == QuestionKind::kObject;
    });
    std::mt19937_64 random(seed);
    Rank(queries.begin(), objects, random);
    Rank(objects, full, random);
    Rank(full, queries.end(), random);
    return std::make_unique<PruningDialogue>(std::move(queries));
  }

 private:
  const Affordances& affordances_;
  LearntPairs learnt_;
};

class RandomScenePolicy : public Policy {
 public:
  std::unique_ptr<Dialogue> Begin(const Situation& situation, const UserHistory&, const Interface&,
                                  uint64_t seed) const override {
    auto queries = SceneQueries(situation);
    std::mt19937_64 random(seed);
    Shuffle(queries.begin(), queries.end(), random);
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
    std::mt19937_64 random(seed);
    Shuffle(queries.begin(), queries.end(), random);
    return std::make_unique<PruningDialogue>(std::move(queries));
  }

 private:
  const Affordances& affordances_;
};

}  // namespace

std::unique_ptr<Policy> MakeOainPolicy(const Affordances& affordances, double lambda) {
  return std::make_unique<OainPolicy>(affordances, lambda);
}
std::unique_ptr<Policy> MakeCountPolicy(const Affordances& affordances) {
  return std::make_unique<CountPolicy>(affordances);
}
std::unique_ptr<Policy> MakeRandomScenePolicy() { return std::make_unique<RandomScenePolicy>(); }
std::unique_ptr<Policy> MakeRandomPolicy(const Affordances& affordances) {
  return std::make_unique<RandomPolicy>(affordances);
}

}  // namespace beckon::intention
