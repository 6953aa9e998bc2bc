// Child processes, microphones that come and go, prompts that are ended.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "services/ui_bridge/speech/audio_source.h"
#include "services/ui_bridge/speech/config.h"
#include "services/ui_bridge/speech/phone_decoder.h"
#include "services/ui_bridge/speech/speaker.h"

namespace beckon::ui_bridge::speech {
namespace {

using ::testing::HasSubstr;

/// A loop that ends with a failure after 30 s.
class DeviceTest : public ::testing::Test {
 protected:
  DeviceTest() {
    loop_.After(30 * kSecond, [this] {
      ADD_FAILURE() << "not done after 30 s";
      loop_.Stop();
    });
    folder_ =
        std::filesystem::temp_directory_path() / ("beckon_speech_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  ~DeviceTest() override { std::filesystem::remove_all(folder_); }

  RunLoop loop_;
  std::filesystem::path folder_;
};

TEST_F(DeviceTest, AChildThatCannotBeStartedIsAnErrorThatNamesIt) {
  const auto child = Child::Start({"no-such-program-of-beckon"}, {});
  ASSERT_FALSE(child);
  EXPECT_THAT(child.error().message, HasSubstr("no-such-program-of-beckon"));
  EXPECT_FALSE(Child::Start({}, {}));
}

TEST_F(DeviceTest, AChildEndsWithItsOwner) {
  const auto begin = SteadyClock().Now();
  {
    auto child = Child::Start({"sleep", "60"}, {});
    ASSERT_TRUE(child);
  }
  EXPECT_LT(SteadyClock().Now() - begin, 20 * kSecond);
}

TEST_F(DeviceTest, OutputOfAProgramThatHangsIsAnError) {
  const auto output = OutputOf({"sleep", "60"}, 100);
  ASSERT_FALSE(output);
  EXPECT_THAT(output.error().message, HasSubstr("killed"));
  EXPECT_FALSE(OutputOf({"false"}, 5000));
}

TEST_F(DeviceTest, EspeakSpeaksAnyText) {
  for (const char* text :
       {"Open the carton?", "--version", "-v no", "$(reboot); `x`", "<b>[[x]]"}) {
    const auto wave = SpeakToWave({}, text);
    ASSERT_TRUE(wave) << text << ": " << wave.error().message;
    EXPECT_GT(wave->samples.size(), 2000u) << text;
  }
}

TEST_F(DeviceTest, EspeakPronouncesWordsThatNoDictionaryHas) {
  const auto sounds = PronounceByEspeak({}, "gizmotron");
  ASSERT_TRUE(sounds) << sounds.error().message;
  EXPECT_GE(sounds->size(), 7u);
}

TEST_F(DeviceTest, AMicrophoneThatEndsIsTriedAgain) {
  size_t samples = 0;
  std::vector<bool> states;
  AudioSource source({.command = {"head", "-c", "3201", "/dev/zero"}, .input = "", .retry_s = 0.05},
                     loop_,
                     {.samples = [&](std::span<const int16_t> s) { samples += s.size(); },
                      .state =
                          [&](bool runs, const std::string& reason) {
                            states.push_back(runs);
                            if (!runs) {
                              EXPECT_THAT(reason, HasSubstr("head"));
                            }
                            if (states.size() == 4) loop_.Stop();
                          }});
  source.Start();
  loop_.Run();
  EXPECT_EQ(states, (std::vector<bool>{true, false, true, false}));
  EXPECT_EQ(samples, 3200u) << "an odd byte at the end is left out";
}

TEST_F(DeviceTest, AMissingInputIsToldOnceAndTakenUpWhenItComes) {
  const auto path = folder_ / "mic.raw";
  int lost = 0;
  AudioSource source({.command = {}, .input = path, .retry_s = 0.05}, loop_,
                     {.samples = [&](std::span<const int16_t>) { loop_.Stop(); },
                      .state = [&](bool runs, const std::string&) { lost += runs ? 0 : 1; }});
  source.Start();
  loop_.After(400'000, [&] { std::ofstream(path) << std::string(4000, 'x'); });
  loop_.Run();
  EXPECT_EQ(lost, 1);
  EXPECT_GE(source.failures(), 2);
  EXPECT_TRUE(source.running());
}

TEST_F(DeviceTest, AFolderIsNoMicrophone) {
  std::string told;
  AudioSource source({.command = {}, .input = folder_}, loop_,
                     {.samples = [](std::span<const int16_t>) {},
                      .state = [&](bool, const std::string& reason) { told = reason; }});
  source.Start();
  EXPECT_THAT(told, HasSubstr("folder"));
}

TEST_F(DeviceTest, APromptThatIsHushedEndsAtOnce) {
  bool whole = true;
  Utime begun = 0;
  const SteadyClock clock;
  Speaker speaker({.espeak = {}, .play = {"sleep", "60"}}, loop_,
                  {.begun =
                       [&](const auto& samples) {
                         EXPECT_GT(samples.size(), 3000u);
                         begun = clock.Now();
                         loop_.Post([&] { speaker.Hush(); });
                       },
                   .over =
                       [&](bool w) {
                         whole = w;
                         loop_.Stop();
                       },
                   .failed = [](const std::string& why) { ADD_FAILURE() << why; }});
  speaker.Say("Do you want to open the carton?");
  loop_.Run();
  EXPECT_FALSE(whole);
  EXPECT_FALSE(speaker.busy());
  EXPECT_LT(clock.Now() - begun, 5 * kSecond);
}

TEST_F(DeviceTest, OnlyTheNewestPromptIsPlayed) {
  int begun = 0;
  Speaker speaker({.espeak = {}, .play = {"true"}}, loop_,
                  {.begun = [&](const auto&) { ++begun; },
                   .over = [&](bool) { loop_.Stop(); },
                   .failed = [](const std::string& why) { ADD_FAILURE() << why; }});
  for (const char* text : {"One.", "Two.", "Three."}) speaker.Say(text);
  loop_.Run();
  EXPECT_EQ(begun, 1);
}

TEST_F(DeviceTest, AMissingLoudspeakerIsToldAndLivedWith) {
  int failed = 0;
  Speaker speaker({.espeak = {}, .play = {"no-such-player-of-beckon"}}, loop_,
                  {.begun = [](const auto&) { ADD_FAILURE(); },
                   .over = [](bool) {},
                   .failed =
                       [&](const std::string& why) {
                         ++failed;
                         EXPECT_THAT(why, HasSubstr("no-such-player-of-beckon"));
                         loop_.Stop();
                       }});
  speaker.Say("Yes?");
  loop_.Run();
  EXPECT_EQ(failed, 1);
  EXPECT_FALSE(speaker.busy());
}

TEST(Configuration, TakesAUsersWordsAndNamesWrongOnes) {
  const auto read = [](const std::string& text) {
    auto table = ConfigTable::Parse(text, "test.toml");
    SpeechConfig config;
    ReadConfig(*table, config);
    return std::make_pair(config, table->Finish());
  };
  const auto [right, status] = read("accept = 0.7\n[words]\nyes = [\"Aye\", \"/AA Y/\"]\n");
  ASSERT_TRUE(status) << status.error().message;
  EXPECT_EQ(right.words.yes, (std::vector<std::string>{"aye", "/AA Y/"}));
  for (const char* wrong : {"accept = 2", "[words]\nyes = []", "[words]\nno = [\"/Q Q/\"]",
                            "[words]\nno = [\"/N OW\"]", "[words]\nno = [\"/S/\"]", "record = []",
                            "[words]\nstop = [\"!\"]", "loud = 1", "kind = \"song\""}) {
    EXPECT_FALSE(read(wrong).second) << wrong;
  }
}

TEST(Configuration, WordsOfOneSoundCanBeSaidInAnOptionsName) {
  const auto lexicon = LoadLexicon(SpeechConfig{}.ears.recogniser.model_folder);
  ASSERT_TRUE(lexicon) << lexicon.error().message;
  EXPECT_FALSE(lexicon->Find("a").empty()) << "a box";
}

TEST(Configuration, TheShippedDefaultsCanBePronounced) {
  const auto right = CheckWords({});
  EXPECT_TRUE(right) << right.error().message;
  SpeechConfig config;
  config.words.yes = {"qqqxz"};
  config.speaker.espeak.program = "no-such-program-of-beckon";
  const auto wrong = CheckWords(config);
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().message, HasSubstr("qqqxz"));
}

}  // namespace
}  // namespace beckon::ui_bridge::speech
