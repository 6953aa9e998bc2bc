// The acoustic model's files, and searches over its scores: phrases are found where they are, and
// the fast search over many words agrees with the simple one over each.
#include "services/ui_bridge/speech/search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>

#include "services/ui_bridge/speech/dictionary.h"
#include "services/ui_bridge/speech/word_tree.h"

namespace beckon::ui_bridge::speech {
namespace {

namespace fs = std::filesystem;

const std::string kFolder = std::string(kModelFolder) + "/en-us";

constexpr float kUnlikely = -25;  // of a state, nats: as in real sound

class SearchTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto model = AcousticModel::Load(kFolder);
    ASSERT_TRUE(model) << model.error().message;
    model_ = new AcousticModel(*std::move(model));
  }
  static void TearDownTestSuite() { delete model_; }

  /// Random scores of `frames`, down to `least`.
  StateScores Noise(int frames, float least = kUnlikely) {
    StateScores scores = model_->Score(std::vector<Observation>(static_cast<size_t>(frames)));
    std::uniform_real_distribution<float> score(least, -3);
    for (int t = 0; t < frames; ++t) {
      for (float& x : scores.Frame(t)) x = score(random_);
    }
    return scores;
  }

  /// As if `sounds` were said, each state for `each` frames.
  StateScores Said(const Pronunciation& sounds, int each, float least = kUnlikely) {
    const auto models = model_->Word(sounds);
    StateScores scores = Noise(static_cast<int>(models.size()) * kStates * each, least);
    int t = 0;
    for (const auto& model : models) {
      for (const uint16_t senone : model.senones) {
        for (int i = 0; i < each; ++i) scores.Frame(t++)[senone] = 0;
      }
    }
    return scores;
  }

  Pronunciation RandomSounds(size_t n) {
    Pronunciation sounds(n);
    for (auto& phone : sounds) phone = static_cast<Phone>(random_() % kPhones);
    return sounds;
  }

  static double Total(const Alignment& alignment) {
    double total = 0;
    for (const auto& span : alignment) total += span.score;
    return total;
  }

  static inline AcousticModel* model_ = nullptr;
  std::mt19937 random_{3};
};

TEST_F(SearchTest, AlignsPhonesWhereTheyWereSaid) {
  const auto sounds = *ParsePronunciation("S T AA P");
  const auto alignment = Align(Said(sounds, 4), sounds, model_->Word(sounds));
  ASSERT_TRUE(alignment);
  ASSERT_EQ(alignment->size(), 4u);
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_EQ((*alignment)[i].phone, sounds[i]);
    EXPECT_EQ((*alignment)[i].begin, static_cast<int>(12 * i));
    EXPECT_EQ((*alignment)[i].end, static_cast<int>(12 * (i + 1)));
  }
}

TEST_F(SearchTest, NeedsAFrameForEachState) {
  const auto sounds = *ParsePronunciation("S T AA P");
  EXPECT_TRUE(Align(Noise(12), sounds, model_->Word(sounds)));
  EXPECT_FALSE(Align(Noise(11), sounds, model_->Word(sounds)));
  EXPECT_FALSE(Align(Noise(0), sounds, model_->Word(sounds)));
}

TEST_F(SearchTest, FreePhonesFillAllFramesAndFitAtLeastAsWellAsAnyPhrase) {
  for (int i = 0; i < 20; ++i) {
    const auto scores = Noise(30);
    const auto free = FreePhones(scores, *model_);
    ASSERT_FALSE(free.empty());
    EXPECT_EQ(free.front().begin, 0);
    EXPECT_EQ(free.back().end, 30);
    for (size_t j = 1; j < free.size(); ++j) EXPECT_EQ(free[j].begin, free[j - 1].end);
    const auto sounds = RandomSounds(5);
    std::vector<PhoneModel> alone;
    for (const Phone phone : sounds) alone.push_back(model_->Alone(phone));
    const auto phrase = Align(scores, sounds, alone);
    ASSERT_TRUE(phrase);
    // Free phones pay for leaving the last state, too.
    EXPECT_GE(Total(free) - alone.back().leave.back(), Total(*phrase) - 1e-2);
  }
}

TEST_F(SearchTest, ATreeOfWordsScoresAsItsBestWordDoes) {
  for (int round = 0; round < 20; ++round) {
    std::vector<WordTree::Word> words;
    for (int i = 0; i < 40; ++i)
      words.push_back({RandomSounds(1 + random_() % 5), static_cast<double>(random_() % 8)});
    const auto scores = round % 2 == 0 ? Noise(25) : Said(words[7].sounds, 3);
    std::optional<double> best;
    for (const auto& word : words) {
      const auto models = model_->Word(word.sounds);
      const auto alignment = Align(scores, word.sounds, models);
      if (!alignment) continue;
      const double score = Total(*alignment) + models.back().leave.back() - word.cost;
      best = std::max(best.value_or(score), score);
    }
    const WordTree tree(*model_, words);
    const auto found = tree.BestWord(scores);
    ASSERT_EQ(found.has_value(), best.has_value());
    if (best) EXPECT_NEAR(*found, *best, 1e-2);
    if (best) EXPECT_GE(tree.BestSequence(scores).value_or(-1e9), *best - 1e-2);
  }
}

TEST_F(SearchTest, ASequenceOfWordsMayRepeatThem) {
  const auto go = *ParsePronunciation("G OW");
  auto scores = Said(*ParsePronunciation("G OW G OW"), 3);
  // The words are said one by one: the phones at their ends have no neighbours.
  const auto models = model_->Word(go);
  for (int t = 0; t < scores.frames(); ++t) {
    scores.Frame(
        t)[models[static_cast<size_t>(t / 9 % 2)].senones[static_cast<size_t>(t / 3 % 3)]] = 0;
  }
  const WordTree tree(*model_, {{go, 1}});
  ASSERT_TRUE(tree.BestSequence(scores));
  ASSERT_TRUE(tree.BestWord(scores));
  EXPECT_GT(*tree.BestSequence(scores), *tree.BestWord(scores) + 20);
}

TEST_F(SearchTest, WordsThatAreLeftOutAreNoRivals) {
  const auto stop = *ParsePronunciation("S T AA P");
  const auto step = *ParsePronunciation("S T EH P");
  WordTree tree(*model_, {{stop}, {step}});
  const auto scores = Said(stop, 2, -6);  // near enough for the beam
  const auto with = tree.BestWord(scores);
  tree.LeaveOut({stop});
  const auto without = tree.BestWord(scores);
  ASSERT_TRUE(with && without);
  EXPECT_GT(*with, *without + 20);
  tree.LeaveOut({stop, step});
  EXPECT_FALSE(tree.BestWord(scores));
  tree.LeaveOut({});
  EXPECT_EQ(tree.BestWord(scores), with);
}

TEST_F(SearchTest, AModelThatIsCutOffNamesItsFile) {
  const fs::path folder = fs::path(::testing::TempDir()) / "beckon-cut-model";
  for (const char* cut : {"mdef", "means", "variances", "sendump", "transition_matrices"}) {
    fs::remove_all(folder);
    fs::create_directories(folder);
    for (const auto& file : fs::directory_iterator(kFolder))
      fs::copy_file(file, folder / file.path().filename());
    for (const auto size : {fs::file_size(folder / cut) / 2, uintmax_t{100}, uintmax_t{0}}) {
      fs::resize_file(folder / cut, size);
      const auto model = AcousticModel::Load(folder.string());
      ASSERT_FALSE(model) << cut << " of " << size << " bytes";
      EXPECT_THAT(model.error().message, ::testing::HasSubstr(cut));
    }
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace beckon::ui_bridge::speech
