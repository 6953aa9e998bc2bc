// Real child processes in the place of a voice.
#include "services/ui_bridge/switch/speaker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <functional>

namespace beckon::ui_bridge {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class SpeakerTest : public ::testing::Test {
 protected:
  SpeakerTest() {
    char name[] = "/tmp/beckon-speaker-XXXXXX";
    folder_ = mkdtemp(name);
  }
  ~SpeakerTest() override { std::filesystem::remove_all(folder_); }

  /// A voice that writes down its process and what it is to say, a word a line, and then does
  /// `then`.
  std::string Voice(const std::string& then) {
    const std::string path = folder_ + "/voice";
    std::ofstream(path) << "#!/bin/sh\nfor word in \"$@\"; do echo \"$word\"; done >> " << folder_
                        << "/said\necho $$ >> " << folder_ << "/pid\n"
                        << then << "\n";
    chmod(path.c_str(), 0700);
    return path;
  }
  std::vector<std::string> Lines(const std::string& file) const {
    std::vector<std::string> lines;
    std::ifstream in(folder_ + "/" + file);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
  }
  void Await(const std::function<bool()>& until) {
    const auto look = loop_.Every(2'000, [&] {
      if (until()) loop_.Stop();
    });
    const auto deadline = loop_.After(10 * kSecond, [this] {
      ADD_FAILURE() << "not within 10 s";
      loop_.Stop();
    });
    loop_.Run();
    loop_.Cancel(look);
    loop_.Cancel(deadline);
  }
  std::function<void(const std::string&)> Tell() {
    return [this](const std::string& text) { told_.push_back(text); };
  }

  std::string folder_;
  RunLoop loop_{/*handle_signals=*/false};
  std::vector<std::string> told_;
};

TEST_F(SpeakerTest, GivesTheSentenceAsOneArgumentThroughNoShell) {
  Speaker speaker({Voice("exit 0"), "-v", "de"}, loop_, Tell());
  speaker.Say("Open \"it\"; $(touch x) `y` -w?");
  Await([&] { return !speaker.speaking(); });
  EXPECT_THAT(Lines("said"), ElementsAre("-v", "de", "--", "Open \"it\"; $(touch x) `y` -w?"));
  EXPECT_TRUE(told_.empty());
}

TEST_F(SpeakerTest, CutsOffASentenceByTheNext) {
  Speaker speaker({Voice("exec sleep 60")}, loop_, Tell());
  speaker.Say("first");
  Await([&] { return Lines("pid").size() == 1; });
  speaker.Say("second");
  Await([&] { return Lines("pid").size() == 2; });
  const int first = std::stoi(Lines("pid")[0]);
  Await([&] { return kill(first, 0) != 0 && errno == ESRCH; });
  EXPECT_TRUE(speaker.speaking());
  speaker.CutOff();
  EXPECT_FALSE(speaker.speaking());
  EXPECT_TRUE(told_.empty()) << "being cut off is no failure";
}

TEST_F(SpeakerTest, LeavesNoChildBehind) {
  int child = 0;
  {
    Speaker speaker({Voice("exec sleep 60")}, loop_, Tell());
    speaker.Say("first");
    Await([&] { return Lines("pid").size() == 1; });
    child = std::stoi(Lines("pid")[0]);
  }
  EXPECT_NE(kill(child, 0), 0);
}

TEST_F(SpeakerTest, ThatIsMissingIsToldOnce) {
  Speaker speaker({"/nonexistent/voice"}, loop_, Tell());
  for (int i = 0; i < 3; ++i) speaker.Say("hello");
  Await([&] { return !told_.empty() && !speaker.speaking(); });
  speaker.Say("again");
  ASSERT_EQ(told_.size(), 1u);
  EXPECT_THAT(told_[0], HasSubstr("/nonexistent/voice"));
}

TEST_F(SpeakerTest, ThatFailsIsToldOnceAndTriedAgain) {
  Speaker speaker({Voice("exit 3")}, loop_, Tell());
  for (size_t i = 1; i <= 3; ++i) {
    speaker.Say("hello");
    Await([&] { return !speaker.speaking(); });
    EXPECT_EQ(Lines("pid").size(), i);
  }
  ASSERT_EQ(told_.size(), 1u);
  EXPECT_THAT(told_[0], HasSubstr("ended with 3"));
}

}  // namespace
}  // namespace beckon::ui_bridge
