// The recogniser on speech that espeak-ng makes: what is said is understood, what else is said is
// not.
#include "services/ui_bridge/speech/recogniser.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "services/base/app.h"
#include "services/ui_bridge/speech/echo_gate.h"
#include "services/ui_bridge/speech/turn.h"

namespace beckon::ui_bridge::speech {
namespace {

class RecogniserTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    RecogniserConfig config;
    auto judgement = LoadJudgement(SharedFile("speech_model.toml"));
    ASSERT_TRUE(judgement) << judgement.error().message;
    config.judgement = *judgement;
    auto opened = Recogniser::Open(config);
    ASSERT_TRUE(opened) << opened.error().message;
    recogniser_ = std::move(*opened).release();
  }
  static void TearDownTestSuite() { delete recogniser_; }

  static msg::Query YesNo() {
    msg::Query query;
    query.kind = msg::QueryKind::kFull;
    for (const char* text : {"Yes", "No"}) {
      msg::Option option;
      option.text = text;
      query.options.push_back(option);
    }
    return query;
  }

  void Expect(const SpokenWords& words = {}) {
    const auto query = YesNo();
    const auto set = recogniser_->Expect(CommandsFor(&query, words));
    ASSERT_TRUE(set) << set.error().message;
  }

  /// What a user says in a quiet room, as segments.
  std::vector<Segment> Record(const std::string& text, const std::string& voice,
                              int words_per_minute = 160) {
    auto wave = SpeakToWave({.voice = voice, .words_per_minute = words_per_minute}, text);
    EXPECT_TRUE(wave);
    std::vector<int16_t> samples(8'000, 0);
    const auto said = AtSampleRate(*wave);
    samples.insert(samples.end(), said.begin(), said.end());
    samples.insert(samples.end(), 12'000, 0);
    std::normal_distribution<double> room(0, 10);
    Segmenter segmenter;
    std::vector<Segment> segments;
    for (size_t i = 0; i + kSamplesPerFrame <= samples.size(); i += kSamplesPerFrame) {
      for (size_t j = i; j < i + kSamplesPerFrame; ++j)
        samples[j] = static_cast<int16_t>(samples[j] / 3 + room(random_));
      auto segment = segmenter.Push({samples.data() + i, kSamplesPerFrame});
      if (segment && segment->ended) segments.push_back(*segment);
    }
    return segments;
  }

  /// "yes", "no", "stop", ... or "" for nothing understood.
  std::string Understood(const std::string& text, const std::string& voice) {
    for (const auto& segment : Record(text, voice)) {
      const auto decision = Decide(recogniser_->Hear(segment), recogniser_->grammar(), true, 2, {});
      if (decision.kind == Decision::Kind::kStop) return "stop";
      if (decision.kind != Decision::Kind::kCommand) continue;
      if (decision.command.kind != CommandKind::kOption) return Name(decision.command.kind);
      return decision.command.option == 0 ? "yes" : "no";
    }
    return "";
  }

  /// Says each phrase of `commands` in espeak-ng's default voices; those that are misunderstood.
  std::vector<std::string> Misunderstood(const std::vector<Command>& commands, size_t options) {
    const auto set = recogniser_->Expect(commands);
    EXPECT_TRUE(set) << set.error().message;
    std::vector<std::string> wrong;
    for (const char* voice : {"en", "en-gb", "en-us"}) {
      for (const auto& command : commands) {
        for (const auto& phrase : command.phrases) {
          if (!UnderstoodAs(command, Record(phrase, voice, 175), options))
            wrong.push_back(std::string(voice) + ": " + phrase);
        }
      }
    }
    return wrong;
  }

  bool UnderstoodAs(const Command& command, const std::vector<Segment>& segments, size_t options) {
    for (const auto& segment : segments) {
      const auto decision =
          Decide(recogniser_->Hear(segment), recogniser_->grammar(), true, options, {});
      if (decision.kind == Decision::Kind::kStop) return command.kind == CommandKind::kStop;
      if (decision.kind == Decision::Kind::kCommand)
        return decision.command.kind == command.kind && decision.command.option == command.option;
    }
    return false;
  }

  static inline Recogniser* recogniser_ = nullptr;
  std::mt19937_64 random_{1};
};

TEST_F(RecogniserTest, UnderstandsWhatIsSaid) {
  Expect();
  int right = 0;
  for (const char* voice : {"en-us", "en-gb", "en-us+f2"}) {
    for (const char* text : {"yes", "no", "stop", "undo"}) {
      const auto understood = Understood(text, voice);
      EXPECT_TRUE(understood == text || understood.empty() || understood == "stop")
          << voice << " says " << text << ", understood " << understood;
      right += understood == text ? 1 : 0;
    }
  }
  EXPECT_GE(right, 9) << "of 12";
}

TEST_F(RecogniserTest, UnderstandsTheDefaultVoicesEssentiallyAlways) {
  // Two phrases of the British voices are not understood as yet: an open "a" is none of the
  // model's, and "start" with its silent "r" ends as "stop" does. Nothing else may be.
  const auto british = [](const char* phrase) {
    return ::testing::AnyOf(std::string("en: ") + phrase, std::string("en-gb: ") + phrase);
  };
  const auto known = ::testing::AnyOf(british("take that back"), british("start"));
  const auto yes_no = YesNo();
  EXPECT_THAT(Misunderstood(CommandsFor(&yes_no, {}), 2), ::testing::Each(known));
  EXPECT_THAT(Misunderstood(CommandsFor(nullptr, {}), 0), ::testing::Each(known));
  msg::Query choice;
  choice.kind = msg::QueryKind::kChoice;
  for (const char* text :
       {"Open the carton", "Drink from the mug", "Pour from the bottle", "None of these"}) {
    msg::Option option;
    option.text = text;
    choice.options.push_back(option);
  }
  EXPECT_THAT(Misunderstood(CommandsFor(&choice, {}), 4), ::testing::Each(known));
}

TEST_F(RecogniserTest, UnderstandsNothingInOtherSpeech) {
  Expect();
  int accepted = 0;
  for (const char* text :
       {"the weather is fine today", "I would like some tea", "window", "have you seen my keys",
        "elephant", "what a lovely day", "television", "please close the door behind you"}) {
    accepted += Understood(text, "en-us").empty() ? 0 : 1;
  }
  EXPECT_LE(accepted, 1);
}

TEST_F(RecogniserTest, TakesAUsersOwnWordsAndSounds) {
  SpokenWords words;
  words.yes = {"affirmative"};
  words.no = {"/AA B AH B AH/"};
  Expect(words);
  EXPECT_EQ(Understood("affirmative", "en-us"), "yes");
}

TEST_F(RecogniserTest, PronouncesWordsThatNoDictionaryHas) {
  SpokenWords words;
  words.yes = {"gizmotronic"};
  Expect(words);
  EXPECT_EQ(Understood("gizmotronic", "en-us"), "yes");
}

TEST_F(RecogniserTest, GivesProbabilitiesForAnySound) {
  Expect();
  std::mt19937_64 random(9);
  for (int i = 0; i < 40; ++i) {
    Segment segment;
    segment.samples.resize((random() % 120) * kSamplesPerFrame);
    const auto kind = random() % 4;
    for (auto& x : segment.samples)
      x = kind == 0   ? static_cast<int16_t>(random())
          : kind == 1 ? 0
          : kind == 2 ? INT16_MAX
                      : INT16_MIN;
    segment.loud_begin = static_cast<int>(random() % 150) - 20;
    segment.loud_end = static_cast<int>(random() % 200);
    const Heard heard = recogniser_->Hear(segment);
    double sum = heard.none;
    for (const double p : heard.commands) sum += p;
    EXPECT_NEAR(sum, 1, 1e-6);
  }
}

TEST_F(RecogniserTest, IsNotThereWithoutItsModel) {
  RecogniserConfig config;
  config.model_folder = "/nonexistent";
  const auto opened = Recogniser::Open(config);
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().message, ::testing::HasSubstr("pocketsphinx-en-us"));
}

TEST_F(RecogniserTest, ItsOwnPromptIsNotHeardAtAnyLevel) {
  auto wave = SpeakToWave({}, "Do you want to open the carton? Say yes or no.");
  ASSERT_TRUE(wave);
  const auto prompt = AtSampleRate(*wave);
  for (const double gain : {0.03, 0.1, 0.3, 1.0, 1.8}) {
    for (const size_t late : {0U, 1'600U, 5'000U}) {
      std::normal_distribution<double> room(0, 12);
      Segmenter segmenter;
      EchoGate gate;
      int heard = 0;
      for (int i = 0; i < 100; ++i) {
        std::vector<int16_t> frame(kSamplesPerFrame);
        for (auto& x : frame) x = static_cast<int16_t>(room(random_));
        segmenter.Push(frame);
      }
      gate.Start(Levels_dB(prompt), segmenter.frames());
      for (size_t at = 0; at < prompt.size() + late + 16'000; at += kSamplesPerFrame) {
        std::vector<int16_t> frame(kSamplesPerFrame);
        for (size_t j = 0; j < frame.size(); ++j) {
          const size_t from = at + j - late;
          const double echo = at + j >= late && from < prompt.size() ? gain * prompt[from] : 0;
          frame[j] = static_cast<int16_t>(std::clamp(echo + room(random_), -32768.0, 32767.0));
        }
        const int64_t now = segmenter.frames();
        heard += segmenter.Push(frame, gate.Expected_dB(now)) ? 1 : 0;
        gate.Observe(now, segmenter.level_dB(), segmenter.floor_dB());
      }
      EXPECT_EQ(heard, 0) << gain << " times as loud, " << late << " samples late";
    }
  }
}

}  // namespace
}  // namespace beckon::ui_bridge::speech
