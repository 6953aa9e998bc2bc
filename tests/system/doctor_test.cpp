// What the doctor makes of what it finds.
#include "tools/beckon/doctor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace beckon::tool {
namespace {

using Grade = Finding::Grade;
using ::testing::HasSubstr;

TEST(Doctor, WarnsOfMessagesThatLeaveTheMachine) {
  EXPECT_EQ(CheckUrl("udpm://239.255.76.67:7667?ttl=0", "").grade, Grade::kOk);
  const auto unsigned_messages = CheckUrl("udpm://239.255.76.67:7667?ttl=1", "");
  EXPECT_EQ(unsigned_messages.grade, Grade::kWarn);
  EXPECT_THAT(unsigned_messages.remedy, HasSubstr("beckon keys make"));
  EXPECT_EQ(CheckUrl("udpm://239.255.76.67:7667?ttl=1", "/etc/beckon/keys").grade, Grade::kOk);
  EXPECT_EQ(CheckUrl("memq://", "").grade, Grade::kOk);
}

TEST(Doctor, KnowsWhichBuffersLoseFrames) {
  const std::string good = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=2097152";
  EXPECT_EQ(CheckSocketBuffers(good, 4'194'304).grade, Grade::kOk);
  const auto small = CheckSocketBuffers(good, 212'992);
  EXPECT_EQ(small.grade, Grade::kWarn);
  EXPECT_THAT(small.remedy, HasSubstr("sysctl -w net.core.rmem_max=2097152"));
  EXPECT_EQ(CheckSocketBuffers("udpm://239.255.76.67:7667?ttl=0", 4'194'304).grade, Grade::kFail);
}

TEST(Doctor, ComparesWhatIsRecognisedWithWhatCanBeWanted) {
  EXPECT_EQ(CompareCategories({"Box", "Cup"}, {"Box", "Cup"}).grade, Grade::kOk);
  const auto unwanted = CompareCategories({"Box", "Vase"}, {"Box"});
  EXPECT_EQ(unwanted.grade, Grade::kWarn);
  EXPECT_THAT(unwanted.detail, HasSubstr("the model knows Vase"));
  EXPECT_THAT(unwanted.remedy, HasSubstr("affordances.toml [categories]"));
  const auto both = CompareCategories({"Box", "Vase"}, {"Box", "Pan", "Plate"});
  EXPECT_THAT(both.detail, HasSubstr("has Pan, Plate, which the model never recognises"));
  EXPECT_THAT(both.remedy, HasSubstr("train"));
}

TEST(Doctor, FailsNoMachineForAFrontEndThatItsUserDoesNotNeed) {
  std::vector<std::string> whats;
  for (const auto& finding : CheckFrontEnds()) {
    whats.push_back(finding.what);
    EXPECT_NE(finding.grade, Grade::kFail) << finding.what;
    EXPECT_EQ(finding.remedy.empty(), finding.grade == Grade::kOk) << finding.what;
  }
  EXPECT_THAT(whats, ::testing::ElementsAre("voice", "speech recognition", "switches", "page"));
  EXPECT_TRUE(IsInPath("sh"));
  EXPECT_FALSE(IsInPath("no-such-program"));
}

TEST(Doctor, WarnsOfADatabaseOnANetworkShare) {
  std::string asked;
  const auto on = [&asked](uint32_t type) {
    return [&asked, type](const std::string& folder) -> Result<uint32_t> {
      asked = folder;
      return type;
    };
  };
  constexpr uint32_t kNfs = 0x6969, kCifs = 0xFF534D42, kSmb2 = 0xFE534D42, kNineP = 0x01021997,
                     kFuse = 0x65735546, kExt4 = 0xEF53, kTmpfs = 0x01021994;
  for (const uint32_t share : {kNfs, kCifs, kSmb2, kNineP, kFuse}) {
    const auto finding = CheckDatabaseDisk("/tmp/habits.db", on(share));
    EXPECT_EQ(finding.grade, Grade::kWarn) << std::hex << share;
    EXPECT_THAT(finding.remedy, HasSubstr("own disk"));
  }
  for (const uint32_t disk : {kExt4, kTmpfs})
    EXPECT_EQ(CheckDatabaseDisk("/tmp/habits.db", on(disk)).grade, Grade::kOk) << std::hex << disk;
  // Of a folder that is not made yet, the one it will be made in counts.
  EXPECT_EQ(CheckDatabaseDisk("/proc/no/such/folder/habits.db", on(kNfs)).grade, Grade::kWarn);
  EXPECT_EQ(asked, "/proc");
}

TEST(Doctor, AsksTheSystemForTheKindOfAFolder) {
  constexpr uint32_t kProc = 0x9FA0;
  const auto proc = FileSystemOf("/proc");
  ASSERT_TRUE(proc) << proc.error().message;
  EXPECT_EQ(*proc, kProc);
  EXPECT_FALSE(FileSystemOf("/nowhere"));
}

TEST(Doctor, FailsOnlyWhereSomethingFailed) {
  std::vector<Finding> findings{{Grade::kOk, "a", "fine", ""},
                                {Grade::kWarn, "b", "so so", "do this"}};
  EXPECT_EQ(ExitCode(findings), 0);
  findings.push_back({Grade::kFail, "c", "bad", "do that"});
  EXPECT_EQ(ExitCode(findings), 1);
  const auto text = Render(findings);
  EXPECT_THAT(text, HasSubstr("FAIL  c: bad\n      -> do that"));
  EXPECT_THAT(text, HasSubstr("3 checks, 1 warnings, 1 failures"));
}

}  // namespace
}  // namespace beckon::tool
