#include "services/intention/core/error_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace beckon::intention {
namespace {

constexpr int kLevels = ErrorModel::kLevels;

/// Mean rates over the levels at which answers mean something.
ErrorRates Mean(const ErrorModel& model) {
  ErrorRates mean;
  double sum = 0;
  for (int i = 0; i < kLevels; ++i) {
    if (!model.Means(i)) continue;
    sum += model.weights[i];
    mean.false_yes += model.weights[i] * model.rates[i].false_yes;
    mean.false_no += model.weights[i] * model.rates[i].false_no;
  }
  return {mean.false_yes / sum, mean.false_no / sum};
}

const std::vector<std::vector<float>> kConfusion = {
    {0.9f, 0.1f, 0.0f}, {0.0f, 0.8f, 0.2f}, {0.02f, 0.0f, 0.98f}};

TEST(ErrorModel, AnswersAreDistributionsAtEveryLevel) {
  for (const ErrorModel& model :
       {ErrorModel::Unknown(), ErrorModel::Announced({0.05, 0.1}),
        ErrorModel::Announced({0.1, 0.1}, kConfusion), ErrorModel::Announced({0, 0}, kConfusion)}) {
    double weights = 0;
    for (int level = 0; level < kLevels; ++level) {
      weights += model.weights[level];
      for (int answers = 2; answers <= 5; ++answers) {
        for (int meant = 0; meant < answers; ++meant) {
          double sum = 0;
          for (int said = 0; said < answers; ++said) {
            const double p = model.Probability(level, answers, meant, said);
            EXPECT_GE(p, 0);
            sum += p;
          }
          EXPECT_NEAR(sum, 1, 1e-6);
        }
      }
    }
    EXPECT_NEAR(weights, 1, 1e-12);
  }
}

TEST(ErrorModel, KnowsAnsweringAtRandomAndStuckSwitches) {
  const ErrorModel model = ErrorModel::Unknown();
  int meaningless = 0;
  for (int level = 0; level < kLevels; ++level) {
    if (model.Means(level)) continue;
    ++meaningless;
    for (int answers = 2; answers <= 4; ++answers) {
      for (int said = 0; said < answers; ++said)
        EXPECT_DOUBLE_EQ(model.Probability(level, answers, 0, said),
                         model.Probability(level, answers, answers - 1, said));
    }
  }
  EXPECT_EQ(meaningless, 3);
}

TEST(ErrorModel, LearnsThatPressesAreMissedButNeverInvented) {
  const ErrorRates mean = Mean(ErrorModel::Unknown().Learnt({70, 30, 0, 100, 0, 0}));
  EXPECT_NEAR(mean.false_no, 0.3, 0.03);
  EXPECT_LT(mean.false_yes, 0.05);
}

TEST(ErrorModel, AnnouncedRatesAreOnlyAStart) {
  const ErrorModel start = ErrorModel::Announced({0.05, 0.05});
  EXPECT_NEAR(Mean(start).false_yes, 0.05, 0.025);
  EXPECT_NEAR(Mean(start.Learnt({80, 20, 20, 80, 0, 0})).false_yes, 0.2, 0.02);
  // Also where one kind of error was said to be impossible.
  const ErrorModel one_sided = ErrorModel::Announced({0, 0.1});
  for (int level = 0; level < kLevels; ++level) {
    if (one_sided.Means(level)) {
      EXPECT_GT(one_sided.rates[level].false_yes, 0);
    }
  }
}

TEST(ErrorModel, ANewDeviceIsNeverOutOfTheQuestion) {
  const ErrorModel start = ErrorModel::Unknown();
  const ErrorModel learnt = start.Learnt({1000, 0, 0, 1000, 0, 0});
  for (int level = 0; level < kLevels; ++level)
    EXPECT_GE(learnt.weights[level], 0.01 * start.weights[level]);
}

TEST(ErrorModel, ChoicesAreLearntFromWhatWasChosen) {
  const ErrorModel start = ErrorModel::Announced({0.1, 0.1}, kConfusion);
  double before = 0, after = 0;
  const ErrorModel learnt = start.Learnt({0, 0, 0, 0, 70, 30});
  for (int level = 0; level < kLevels; ++level) {
    before += start.weights[level] * start.Probability(level, 3, 0, 0);
    after += learnt.weights[level] * learnt.Probability(level, 3, 0, 0);
  }
  EXPECT_LT(after, before - 0.05);
}

TEST(ErrorModel, AnnouncedConfusionSaysWhichWrongAnswerIsLikely) {
  const ErrorModel model = ErrorModel::Announced({0.1, 0.1}, kConfusion);
  const Evidence heard = model.Hear({0, 1, 0});
  EXPECT_EQ(heard.said, 1);
  for (int level = 0; level < kLevels; ++level) {
    if (model.Means(level)) {
      EXPECT_GT(heard.likelihood[0][level], 5 * heard.likelihood[2][level]);
    }
  }
}

TEST(ErrorModel, ScaleOfLikelihoodsDoesNotMatter) {
  const ErrorModel model = ErrorModel::Unknown();
  for (const double scale : {1e-300, 1e-30, 1e12}) {
    const Evidence heard = model.Hear({0.8 * scale, 0.2 * scale});
    for (int level = 0; level < kLevels; ++level)
      EXPECT_NEAR(heard.likelihood[0][level], model.Hear({0.8, 0.2}).likelihood[0][level], 1e-12);
  }
}

TEST(ErrorModel, AnswerTakenBackSpeaksOfNoiseOnly) {
  const Evidence undone = TakenBack(ErrorModel::Unknown().Hear({1, 0}));
  EXPECT_EQ(undone.said, Evidence::kNothing);
  EXPECT_EQ(undone.likelihood[0], undone.likelihood[1]);
  EXPECT_GT(undone.likelihood[0][5], 2 * undone.likelihood[0][0]);  // 30 % against 0.5 %
  const Evidence exact = TakenBack(ErrorModel::Exact({}).Hear({1, 0}));
  for (int level = 0; level < kLevels; ++level) EXPECT_GT(exact.likelihood[0][level], 0);
}

TEST(ErrorModel, RefusesHostileLikelihoods) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(CheckLikelihoods({1, 0}, 2).ok());
  EXPECT_TRUE(CheckLikelihoods({0.2, 0.3, 0.1}, 3).ok());
  for (const std::vector<double>& bad : std::vector<std::vector<double>>{{},
                                                                         {1},
                                                                         {1, 0, 0},
                                                                         {0, 0},
                                                                         {1, -0.1},
                                                                         {nan, 1},
                                                                         {1, nan},
                                                                         {infinity, 0},
                                                                         {0, -infinity}})
    EXPECT_FALSE(CheckLikelihoods(bad, 2).ok());
}

TEST(ErrorModel, ASoftAnswerIsDoubtedNoMoreThanItDoubtsItself) {
  const ErrorModel model = ErrorModel::Exact({0.1, 0.1});
  const auto odds = [&](double sure) {
    const Evidence heard = model.Hear({sure, 1 - sure});
    return heard.likelihood[0][0] / heard.likelihood[1][0];
  };
  EXPECT_NEAR(odds(1), 9, 1e-12);    // a press is wrong as often as the device is
  EXPECT_NEAR(odds(0.8), 4, 1e-12);  // more doubtful than that: taken at its word
  EXPECT_NEAR(odds(0.9), 9, 1e-12);
  EXPECT_NEAR(odds(0.999), 9, 0.1);  // too sure of itself
}

}  // namespace
}  // namespace beckon::intention
