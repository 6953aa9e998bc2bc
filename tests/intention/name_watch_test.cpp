#include "services/intention/core/name_watch.h"

#include <gtest/gtest.h>

namespace beckon::intention {
namespace {

constexpr Utime kStart = 1'000 * kSecond;

msg::History From(const std::string& run, Utime utime, const std::string& machine = "kitchen") {
  msg::History message;
  message.machine = machine;
  message.run = run;
  message.utime = utime;
  return message;
}

class NameWatchTest : public testing::Test {
 protected:
  bool Hear(const msg::History& message, double seconds) {
    const auto steady = static_cast<Utime>(seconds * kSecond);
    return watch.IsAnother(message, "kitchen", {steady, kStart + steady});
  }
  NameWatch watch{"mine", kStart};
};

TEST_F(NameWatchTest, AnotherThatGoesOnSpeakingIsNoticed) {
  bool noticed = false;
  for (int i = 0; i < 4; ++i) noticed = Hear(From("other", kStart + i * kSecond + 1), i * 1.5);
  EXPECT_TRUE(noticed);
}

TEST_F(NameWatchTest, OnesOwnEarlierRunIsNot) {
  // Late datagrams of before the restart, even many and over a while.
  for (int i = 0; i < 20; ++i)
    EXPECT_FALSE(Hear(From("earlier", kStart - 20 * kSecond + i * kSecond), i));
  // One that ended as this one began.
  EXPECT_FALSE(Hear(From("earlier", kStart + 1), 0.1));
  EXPECT_FALSE(Hear(From("earlier", kStart + 2), 0.2));
  // The same again and again says nothing new.
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(Hear(From("earlier", kStart + 2), 1 + i));
}

TEST_F(NameWatchTest, OneselfAndOthersAreNot) {
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(Hear(From("mine", kStart + i * kSecond + 1), i));
    EXPECT_FALSE(Hear(From("other", kStart + i * kSecond + 1, "bedroom"), i));
  }
}

}  // namespace
}  // namespace beckon::intention
