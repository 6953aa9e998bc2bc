// Whole dialogues over lines that mislead: what must never end in a task that was not wanted.
#include <gtest/gtest.h>

#include <functional>

#include "services/intention/core/evaluation.h"
#include "services/intention/core/seeded_random.h"
#include "services/intention/core/simulated_user.h"
#include "tests/intention/fixtures.h"

namespace beckon::intention {
namespace {

/// How a dialogue ended.
struct End {
  std::optional<int> accepted;
  Ending why = Ending::kOpen;
  int questions = 0;
};

class UnreliableAnswers : public testing::Test {
 protected:
  /// `said`: the answer to a question, by its number from 0 and what was meant.
  using Answering = std::function<std::vector<double>(int number, int meant)>;

  End Converse(const Situation& table, const UserHistory& history, const ErrorModel& errors,
               int want, const Answering& said) const {
    const auto dialogue = policy->Begin(table, history, Interface::YesNo(errors), 1);
    End end;
    while (!end.accepted) {
      const auto question = dialogue->Ask();
      if (!question) break;
      const int meant = question->Meant(table.pairs[want]);
      dialogue->Hear(*question, errors.Hear(said(end.questions++, meant)));
      end.accepted = dialogue->Accepted();
      if (end.questions > 500) break;
    }
    end.why = dialogue->End();
    return end;
  }
  static Answering Flipping(double rate, SeededRandom& random) {
    return
        [&random, rate](int, int meant) { return Press(random.Chance(rate) ? 1 - meant : meant); };
  }
  static std::vector<double> Press(int answer) {
    return answer == 0 ? std::vector<double>{1, 0} : std::vector<double>{0, 1};
  }
  const Affordances a = TestAffordances();
  const std::unique_ptr<Policy> policy = MakeAdaptivePolicy({});
  SeededRandom random{77};
};

TEST_F(UnreliableAnswers, StuckSwitchNeverEndsInATask) {
  for (const int stuck : {0, 1}) {
    int accepted = 0;
    for (int i = 0; i < 100; ++i) {
      const Situation table = MakeSituation(a, DrawTable(a, random));
      const End end =
          Converse(table, {}, ErrorModel::Unknown(), 0, [&](int, int) { return Press(stuck); });
      accepted += end.accepted.has_value();
      EXPECT_NE(end.why, Ending::kOpen);
      EXPECT_LE(end.questions, 40);
    }
    EXPECT_EQ(accepted, 0) << stuck;
  }
}

TEST_F(UnreliableAnswers, NeitherDoContradictions) {
  const Situation table = MakeSituation(a, DrawTable(a, random));
  const ErrorModel errors = ErrorModel::Unknown();
  const auto dialogue = policy->Begin(table, {}, Interface::YesNo(errors), 1);
  int heard = 0;
  while (dialogue->Ask() && heard < 500) {
    dialogue->Hear(AskPair(table, 3), errors.Hear(Press(heard++ % 2)));
    EXPECT_FALSE(dialogue->Accepted());
  }
  EXPECT_EQ(dialogue->End(), Ending::kUnclear);
}

TEST_F(UnreliableAnswers, NorAnswersThatSayNothing) {
  const Situation table = MakeSituation(a, DrawTable(a, random));
  const End end = Converse(table, {}, ErrorModel::Unknown(), 0, [](int, int) {
    return std::vector<double>{0.5, 0.5};
  });
  EXPECT_FALSE(end.accepted);
  EXPECT_EQ(end.why, Ending::kUnclear);
}

TEST_F(UnreliableAnswers, AHabitDoesNotOutvoteTheUser) {
  int wrong = 0, none = 0;
  for (int i = 0; i < 400; ++i) {
    const Situation table = MakeSituation(a, DrawTable(a, random));
    const int usual = random.Below(table.pair_count());
    const Instance& object = table.objects[table.pairs[usual].object];
    PastSession past{object.category, table.pairs[usual].action, object.rank, {}, 0, {}};
    past.answers[""] = {1.9, 0.1, 0, 0, 0, 0};
    int want = usual;
    while (want == usual) want = random.Below(table.pair_count());
    const UserHistory habit(10, past);
    const ErrorModel errors = ErrorModel::Unknown().Learnt({19, 1, 0, 0, 0, 0});
    const End end = Converse(table, habit, errors, want, Flipping(0.05, random));
    wrong += end.accepted && *end.accepted != want;
    none += !end.accepted;
  }
  EXPECT_LE(wrong, 8);  // 2 %; measured 0.4 %, 4.1 % with a posterior of 99.5 % and no other rule
  EXPECT_LE(none, 2);
}

TEST_F(UnreliableAnswers, AnnouncedRateMayBeFarOff) {
  int wrong = 0, none = 0;
  const ErrorModel errors = ErrorModel::Announced({0.05, 0.05});
  for (int i = 0; i < 400; ++i) {
    const Situation table = MakeSituation(a, DrawTable(a, random));
    const int want = random.Below(table.pair_count());
    const End end = Converse(table, {}, errors, want, Flipping(0.2, random));
    wrong += end.accepted && *end.accepted != want;
    none += !end.accepted;
  }
  EXPECT_LE(wrong, 8);
  EXPECT_LE(none, 4);
}

TEST_F(UnreliableAnswers, MissedPressesAreUnderstood) {
  int wrong = 0, none = 0;
  for (int i = 0; i < 300; ++i) {
    const Situation table = MakeSituation(a, DrawTable(a, random));
    const int want = random.Below(table.pair_count());
    const End end = Converse(table, {}, ErrorModel::Unknown(), want, [&](int, int meant) {
      return Press(meant == 0 && random.Chance(0.25) ? 1 : meant);
    });
    wrong += end.accepted && *end.accepted != want;
    none += !end.accepted;
  }
  EXPECT_LE(wrong, 3);
  EXPECT_LE(none, 3);
}

TEST_F(UnreliableAnswers, SoftVectorsAreTakenAsWhatTheySay) {
  int wrong = 0, none = 0;
  const ErrorModel errors = ErrorModel::Announced({0.01, 0.01});
  for (int i = 0; i < 200; ++i) {
    const Situation table = MakeSituation(a, DrawTable(a, random));
    const int want = random.Below(table.pair_count());
    const End end = Converse(table, {}, errors, want, [&](int, int meant) {
      const double sure = random.Between(0.5, 1);  // calibrated: right with this probability
      const int likelier = random.Chance(sure) ? meant : 1 - meant;
      return likelier == 0 ? std::vector<double>{sure, 1 - sure}
                           : std::vector<double>{1 - sure, sure};
    });
    wrong += end.accepted && *end.accepted != want;
    none += !end.accepted;
  }
  EXPECT_LE(wrong, 3);
  EXPECT_LE(none, 2);
}

TEST_F(UnreliableAnswers, AnUndoneAnswerIsAskedAgain) {
  const Situation table = MakeSituation(a, DrawTable(a, random));
  const ErrorModel errors = ErrorModel::Exact({0.1, 0.1});
  const auto dialogue = policy->Begin(table, {}, Interface::YesNo(errors), 1);
  const Question first = *dialogue->Ask();
  const std::vector<double> before = dialogue->CurrentBelief().posterior;
  dialogue->Hear(first, TakenBack(errors.Hear(Press(0))));
  EXPECT_EQ(dialogue->Ask(), first);
  for (size_t i = 0; i < before.size(); ++i)
    EXPECT_NEAR(dialogue->CurrentBelief().posterior[i], before[i], 1e-12);
}

TEST_F(UnreliableAnswers, AsksForAPairThatIsLikelierThanAllOthers) {
  for (int i = 0; i < 30; ++i) {
    const Situation table = MakeSituation(a, DrawTable(a, random));
    const int want = random.Below(table.pair_count());
    const ErrorModel errors = ErrorModel::Exact({0.1, 0.1});
    const auto dialogue = policy->Begin(table, {}, Interface::YesNo(errors), 1);
    while (!dialogue->Accepted()) {
      const auto question = dialogue->Ask();
      ASSERT_TRUE(question);
      const Belief belief = dialogue->CurrentBelief();
      if (belief.best_posterior > 0.5) {
        EXPECT_EQ(*question, AskPair(table, belief.best_pair));
      }
      dialogue->Hear(*question, errors.Hear(Press(question->Meant(table.pairs[want]))));
    }
    EXPECT_EQ(dialogue->Accepted(), want);
  }
}

TEST_F(UnreliableAnswers, ChoicesEndSoonerThanYesAndNo) {
  const auto evaluated = [&](InterfaceKind kind, int max_options) {
    EvaluationConfig config;
    config.flip = 0.2;
    config.interface.kind = kind;
    config.interface.max_options = max_options;
    Evaluation evaluation(a, *policy, config, [] { return 0.0; });
    SeededRandom tables(5);
    int questions = 0;
    for (int i = 0; i < 60; ++i) {
      ScenarioSession session;
      session.user = "user" + std::to_string(i);
      session.scene = DrawTable(a, tables);
      const Situation table = MakeSituation(a, session.scene);
      const Pair want = table.pairs[tables.Below(table.pair_count())];
      session.want_category = table.objects[want.object].category;
      session.want_rank = table.objects[want.object].rank;
      session.want_action = want.action;
      const SessionOutcome outcome = evaluation.Live(session);
      EXPECT_TRUE(outcome.answered);
      questions += outcome.questions;
    }
    return questions;
  };
  const int yes_no = evaluated(InterfaceKind::kYesNo, 2);
  for (const auto kind : {InterfaceKind::kChoice, InterfaceKind::kScan, InterfaceKind::kVector}) {
    const int few = evaluated(kind, 4), many = evaluated(kind, 8);
    EXPECT_LT(few, yes_no);
    EXPECT_LT(many, few);
  }
}

}  // namespace
}  // namespace beckon::intention
