#include "services/intention/core/simulated_decoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "services/intention/core/error_model.h"

namespace beckon::intention {
namespace {

TEST(SimulatedDecoder, ErrsAsOftenAsItIsToldAndKnowsHowSureItIs) {
  std::mt19937_64 random(4);
  for (const int answers : {2, 5, 20}) {
    for (const double flip : {0.05, 0.2}) {
      const int trials = 4000;
      int right = 0;
      double sure = 0;
      for (int i = 0; i < trials; ++i) {
        const int meant = i % answers;
        const auto likelihoods = DecodedLikelihoods(answers, meant, flip, random);
        EXPECT_NEAR(std::accumulate(likelihoods.begin(), likelihoods.end(), 0.0), 1, 1e-12);
        right += SaidAnswer(likelihoods) == meant;
        sure += *std::max_element(likelihoods.begin(), likelihoods.end());
      }
      EXPECT_NEAR(static_cast<double>(right) / trials, 1 - flip, 0.02) << answers;
      EXPECT_NEAR(sure / trials, 1 - flip, 0.02) << answers;
    }
  }
}

TEST(SimulatedDecoder, IsSureWhereItNeverErrs) {
  std::mt19937_64 random(4);
  EXPECT_EQ(DecodedLikelihoods(3, 1, 0, random), (std::vector<double>{0, 1, 0}));
}

}  // namespace
}  // namespace beckon::intention
