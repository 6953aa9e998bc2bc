#include "services/ui_bridge/switch/key_map.h"

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

namespace beckon::ui_bridge {
namespace {

InputEvent Key(int code, bool down) { return {.code = code, .down = down}; }

TEST(KeyNames, AreNamesCodesOrAny) {
  EXPECT_EQ(ParseKey("KEY_SPACE")->code, KEY_SPACE);
  EXPECT_EQ(ParseKey("BTN_0")->code, BTN_0);
  EXPECT_EQ(ParseKey("57")->code, 57);
  EXPECT_EQ(ParseKey("any")->code, KeyChoice::kAny);
  EXPECT_EQ(ParseKey("")->code, KeyChoice::kNone);
  for (const char* odd : {"KEY_", "space", "-1", "0", "768", "57x", "99999999999"}) {
    ASSERT_FALSE(ParseKey(odd)) << odd;
    EXPECT_NE(ParseKey(odd).error().message.find(odd), std::string::npos);
  }
}

TEST(KeyMap, MakesOneSwitchOfManyKeys) {
  KeyMap map({KeyChoice::kAny}, {});
  EXPECT_TRUE(map.OnKey(Key(1, true))->down);
  EXPECT_FALSE(map.OnKey(Key(2, true)));
  EXPECT_FALSE(map.OnKey(Key(1, false)));
  EXPECT_FALSE(map.OnKey(Key(2, false))->down);
}

TEST(KeyMap, TellsTwoSwitchesApart) {
  KeyMap map({KeyChoice::kAny}, {KEY_ENTER});
  EXPECT_EQ(map.OnKey(Key(KEY_ENTER, true))->which, scan::Switch::kSelect);
  EXPECT_EQ(map.OnKey(Key(KEY_SPACE, true))->which, scan::Switch::kMain);
  KeyMap named({KEY_SPACE}, {KEY_ENTER});
  EXPECT_FALSE(named.OnKey(Key(KEY_A, true)));
}

TEST(KeyMap, TakesAReleaseWithoutAPressForNothing) {
  KeyMap map({KeyChoice::kAny}, {});
  EXPECT_FALSE(map.OnKey(Key(1, false)));
  map.OnKey(Key(1, true));
  map.Reset();
  EXPECT_FALSE(map.OnKey(Key(1, false)));
}

}  // namespace
}  // namespace beckon::ui_bridge
