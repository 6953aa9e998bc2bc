#include "services/base/trust/key_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "tests/base/trust/temporary_keys.h"

namespace beckon::trust {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class KeyFolderTest : public ::testing::Test {
 protected:
  TemporaryKeys kitchen_{"kitchen"}, bedroom_{"bedroom"};
};

TEST_F(KeyFolderTest, NothingIsThereAtFirst) {
  const TemporaryKeys empty;
  const auto own = empty.folder().Own();
  ASSERT_TRUE(own.ok());
  EXPECT_FALSE(own->has_value());
  EXPECT_THAT(empty.folder().Others().trusted, IsEmpty());
}

TEST_F(KeyFolderTest, AMachineTrustsItselfAndWhomItWasTold) {
  EXPECT_THAT(kitchen_.folder().Others().trusted, SizeIs(1));
  ASSERT_TRUE(kitchen_.folder().Trust(bedroom_.public_file(), std::nullopt).ok());
  const auto others = kitchen_.folder().Others();
  ASSERT_THAT(others.trusted, SizeIs(2));
  EXPECT_EQ(others.trusted[1].name, "bedroom");
  EXPECT_EQ(others.trusted[1].key, (*bedroom_.folder().Own())->node.key);
  EXPECT_THAT(others.faults, IsEmpty());
}

TEST_F(KeyFolderTest, MakingASecondKeyIsRefused) {
  EXPECT_FALSE(kitchen_.folder().Make("kitchen", Roles::All()).ok());
}

TEST_F(KeyFolderTest, NamesCannotLeaveTheFolder) {
  for (const char* name : {"", "../x", ".hidden", "a b", "a/b"})
    EXPECT_FALSE(TemporaryKeys().folder().Make(name, Roles::All()).ok()) << name;
}

TEST_F(KeyFolderTest, RolesMayBeNarrowed) {
  const auto front_end = *Roles::FromNames({"front-end"});
  ASSERT_TRUE(kitchen_.folder().Trust(bedroom_.public_file(), front_end).ok());
  EXPECT_EQ(kitchen_.folder().Others().trusted[1].may, front_end);
}

TEST_F(KeyFolderTest, ARevokedKeyStaysRevoked) {
  ASSERT_TRUE(kitchen_.folder().Trust(bedroom_.public_file(), std::nullopt).ok());
  ASSERT_TRUE(kitchen_.folder().Revoke("bedroom").ok());
  EXPECT_THAT(kitchen_.folder().Others().trusted, SizeIs(1));
  EXPECT_THAT(kitchen_.folder().Others().revoked, SizeIs(1));
  const auto again = kitchen_.folder().Trust(bedroom_.public_file(), std::nullopt);
  ASSERT_FALSE(again.ok());
  EXPECT_THAT(again.error().message, HasSubstr("revoked"));
  // Nor does copying the file past the command help.
  fs::copy(bedroom_.public_file(), kitchen_.path() + "/trusted/bedroom.pub");
  EXPECT_THAT(kitchen_.folder().Others().trusted, SizeIs(1));
}

TEST_F(KeyFolderTest, ASecondKeyForANameIsRefused) {
  ASSERT_TRUE(kitchen_.folder().Trust(bedroom_.public_file(), std::nullopt).ok());
  const TemporaryKeys impostor("bedroom");
  EXPECT_FALSE(kitchen_.folder().Trust(impostor.public_file(), std::nullopt).ok());
}

TEST_F(KeyFolderTest, AKeyThatEverybodyCanReadIsRefused) {
  chmod((kitchen_.path() + "/node.key").c_str(), 0644);
  const auto own = kitchen_.folder().Own();
  ASSERT_FALSE(own.ok());
  EXPECT_THAT(own.error().message, HasSubstr("chmod"));
}

TEST_F(KeyFolderTest, OneBadFileSpoilsNoOther) {
  ASSERT_TRUE(kitchen_.folder().Trust(bedroom_.public_file(), std::nullopt).ok());
  std::ofstream(kitchen_.path() + "/trusted/broken.pub")
      << "node = \"x\"\npublic = \"short\"\nmay = []\n";
  const auto others = kitchen_.folder().Others();
  EXPECT_THAT(others.trusted, SizeIs(2));
  EXPECT_THAT(others.faults, ElementsAre(HasSubstr("broken.pub")));
}

TEST_F(KeyFolderTest, ItsVersionTellsOfChanges) {
  const auto before = kitchen_.folder().Version();
  EXPECT_EQ(kitchen_.folder().Version(), before);
  ASSERT_TRUE(kitchen_.folder().Trust(bedroom_.public_file(), std::nullopt).ok());
  const auto trusted = kitchen_.folder().Version();
  EXPECT_NE(trusted, before);
  ASSERT_TRUE(kitchen_.folder().Revoke("bedroom").ok());
  EXPECT_NE(kitchen_.folder().Version(), trusted);
}

}  // namespace
}  // namespace beckon::trust
