#include "services/base/config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace beckon {
namespace {

using ::testing::HasSubstr;

ConfigTable Parsed(const std::string& text) { return *ConfigTable::Parse(text, "test.toml"); }

TEST(Config, KeepsDefaultsWhereKeysAreAbsent) {
  ConfigTable table = Parsed("");
  double voxel_m = 0.002;
  table.Section("segmentation").Get("voxel_m", voxel_m, 0, 1);
  EXPECT_EQ(voxel_m, 0.002);
  EXPECT_TRUE(table.Finish().ok());
}

TEST(Config, ReadsEveryKindOfValue) {
  ConfigTable table = Parsed(
      "a = 1.5\nb = 3\nc = true\nd = 'text'\ne = ['x', 'y']\nf = [1, 2.5]\n[inner]\nmode = "
      "'fast'\n");
  double a = 0, b_as_double = 0;
  int b = 0;
  bool c = false;
  std::string d, mode = "slow";
  std::vector<std::string> e;
  std::vector<double> f;
  table.Get("a", a);
  table.Get("b", b);
  table.Get("b", b_as_double);
  table.Get("c", c);
  table.Get("d", d);
  table.Get("e", e);
  table.Get("f", f);
  table.Section("inner").Get("mode", mode, {"slow", "fast"});
  ASSERT_TRUE(table.Finish().ok());
  EXPECT_EQ(a, 1.5);
  EXPECT_EQ(b, 3);
  EXPECT_EQ(b_as_double, 3.0);
  EXPECT_TRUE(c);
  EXPECT_EQ(d, "text");
  EXPECT_EQ(mode, "fast");
  EXPECT_EQ(e, (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(f, (std::vector<double>{1, 2.5}));
}

TEST(Config, RefusesAnUnknownKeyWithLineAndSuggestion) {
  ConfigTable table = Parsed("[segmentation]\n\nvoxel_mm = 2\n");
  double voxel_m = 0.002;
  table.Section("segmentation").Get("voxel_m", voxel_m);
  const Status status = table.Finish();
  ASSERT_FALSE(status.ok());
  EXPECT_THAT(status.error().message, HasSubstr("test.toml:3"));
  EXPECT_THAT(status.error().message, HasSubstr("'segmentation.voxel_mm'"));
  EXPECT_THAT(status.error().message, HasSubstr("did you mean 'segmentation.voxel_m'"));
}

TEST(Config, RefusesAnUnknownSection) {
  EXPECT_FALSE(Parsed("[colours]\nred = 1\n").Finish().ok());
}

TEST(Config, RefusesWrongTypesAndRanges) {
  for (const char* text : {"x = 'two'", "x = 5", "x = nan", "x = true", "x = [1]"}) {
    ConfigTable table = Parsed(text);
    double x = 1;
    table.Get("x", x, 0, 4);
    EXPECT_FALSE(table.Finish().ok()) << text;
    EXPECT_EQ(x, 1) << text;
  }
  ConfigTable table = Parsed("n = 99999999999");
  int n = 1;
  table.Get("n", n, 0, 10);
  EXPECT_FALSE(table.Finish().ok());
  EXPECT_EQ(n, 1);
}

TEST(Config, RefusesWhatIsNoChoice) {
  ConfigTable table = Parsed("mode = 'faster'");
  std::string mode = "slow";
  table.Get("mode", mode, {"slow", "fast"});
  EXPECT_THAT(table.Finish().error().message, HasSubstr("'faster' is none of slow, fast"));
}

TEST(Config, RefusesWhatIsNotToml) {
  const auto table = ConfigTable::Parse("a = = 1", "broken.toml");
  ASSERT_FALSE(table.ok());
  EXPECT_THAT(table.error().message, HasSubstr("broken.toml:1"));
}

TEST(Config, RefusesAFileThatIsNotThere) {
  const auto table = ConfigTable::Load("/nonexistent/beckon.toml");
  ASSERT_FALSE(table.ok());
  EXPECT_THAT(table.error().message, HasSubstr("/nonexistent/beckon.toml"));
}

}  // namespace
}  // namespace beckon
