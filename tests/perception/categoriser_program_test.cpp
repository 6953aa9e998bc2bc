// beckon-train on folders: what it writes, what it refuses, and that it can be stopped.
#include <gmock/gmock.h>
#include <unistd.h>

#include "services/base/progress.h"
#include "services/perception/cue_interface.h"
#include "services/perception/model_file.h"
#include "services/perception/train_figures.h"
#include "tests/perception/categoriser_folder.h"

namespace beckon::perception {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST_F(TrainFolder, SameSeedGivesTheSameBytesWithAnyNumberOfThreads) {
  WriteAll(4);
  TrainConfig config = SmallTraining();
  ASSERT_TRUE(RunTraining(Options(), config));
  const std::string model = Read("m.model"), card = Read("m.md");
  config.threads = 3;
  ASSERT_TRUE(RunTraining(Options(), config));
  EXPECT_EQ(Read("m.model"), model);
  EXPECT_EQ(Read("m.md"), card);
  config.seed = 8;
  ASSERT_TRUE(RunTraining(Options(), config));
  EXPECT_NE(Read("m.model"), model);
}

TEST_F(TrainFolder, WritesACardPicturesAndHeldOutLines) {
  WriteAll(4);
  std::ofstream(folder_ / "Can/broken_0.pcd") << "no cloud";
  fs::create_directories(folder_ / "Mug");
  TrainOptions options = Options();
  options.pictures = Path("pictures");
  options.jsonl = Path("held_out.jsonl");
  options.version = "1.2.3";
  ASSERT_TRUE(RunTraining(options, SmallTraining()));
  for (const char* name : {"confusions", "risk_coverage", "reliability"}) {
    EXPECT_GT(fs::file_size(folder_ / "pictures" / (std::string(name) + ".png")), 1000U) << name;
  }
  const std::string card = Read("m.md");
  for (const char* part :
       {"12 views", "| Can | 4 | 4 |", "1 more left out", "Can/broken_0.pcd", "seed 7", "1.2.3",
        "accuracy", "dissertation", "Commonest confusions", "Not good for", "Mug"}) {
    EXPECT_THAT(card, HasSubstr(part));
  }
  const std::string lines = Read("held_out.jsonl");
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 12);
  EXPECT_THAT(lines, HasSubstr("\"probabilities\":{\"Bowl\":"));
}

TEST_F(TrainFolder, IsStoppedWithoutHalfAModel) {
  WriteAll(3);
  for (const int calls : {0, 5, 12, 20, 40}) {
    TrainOptions options = Options();
    int left = calls;
    options.stopped = [&left] { return --left < 0; };
    const Status status = RunTraining(options, SmallTraining());
    ASSERT_FALSE(status) << calls;
    EXPECT_THAT(status.error().message, HasSubstr("stopped"));
    EXPECT_FALSE(fs::exists(folder_ / "m.model"));
    EXPECT_FALSE(fs::exists(folder_ / "m.model.part"));
  }
}

TEST_F(TrainFolder, TakesUncolouredViewsAndCategoriesOfWhichNoneIsReadable) {
  WriteAll(4);
  Write("Can/uncoloured_0.pcd", "Can", 40, false);
  fs::create_directories(folder_ / "Mug");
  std::ofstream(folder_ / "Mug/a_0.pcd") << "no cloud";
  ASSERT_TRUE(RunTraining(Options(), SmallTraining()));
  const auto model = ReadModelFile(Path("m.model"));
  ASSERT_TRUE(model);
  EXPECT_EQ(model->categories, (std::vector<std::string>{"Bowl", "Box", "Can"}));
  EXPECT_EQ(model->cues.size(), MakeCues().size());
}

TEST_F(TrainFolder, TestsWithSomeOfTheCues) {
  WriteAll(4);
  ASSERT_TRUE(RunTraining(Options(), SmallTraining()));
  TrainOptions test;
  test.test = folder_.string();
  test.model = Path("m.model");
  test.jsonl = Path("out.jsonl");
  std::string all;
  for (const char* cues : {"all", "dissertation", "shape", "shape,fpfh"}) {
    test.cues = cues;
    ASSERT_TRUE(RunTest(test)) << cues;
    if (all.empty()) all = Read("out.jsonl");
    EXPECT_EQ(Read("out.jsonl").empty(), false);
  }
  test.cues = "smell";
  const Status status = RunTest(test);
  ASSERT_FALSE(status);
  EXPECT_THAT(status.error().message, HasSubstr("smell"));
}

TEST_F(TrainFolder, ImprovesABaseOrSaysWhyNot) {
  WriteAll(4);
  ASSERT_TRUE(RunTraining(Options(), SmallTraining()));
  TrainOptions improve = Options();
  improve.base = Path("m.model");
  improve.model = Path("improved.model");
  ASSERT_TRUE(RunTraining(improve, SmallTraining()));
  EXPECT_THAT(Read("improved.md"), HasSubstr("It improves"));
  const std::string first = Read("improved.model");
  ASSERT_TRUE(RunTraining(improve, SmallTraining()));
  EXPECT_EQ(Read("improved.model"), first);

  std::string bytes = Read("m.model");
  bytes[8] = 1;
  std::ofstream(folder_ / "old.model", std::ios::binary) << bytes;
  improve.base = Path("old.model");
  Status status = RunTraining(improve, SmallTraining());
  ASSERT_FALSE(status);
  EXPECT_THAT(status.error().message, HasSubstr("--base"));
  EXPECT_THAT(status.error().message, HasSubstr("format 1"));
  improve.base = Path("none.model");
  EXPECT_FALSE(RunTraining(improve, SmallTraining()));
}

TEST(ProgressLine, TellsShareAndTimeLeft) {
  EXPECT_EQ(ProgressText("reading", 0, 10, 0), "reading 0 %");
  EXPECT_EQ(ProgressText("reading", 1, 4, 30), "reading 25 %, 1:30 left");
  EXPECT_EQ(ProgressText("reading", 4, 4, 30), "reading 100 %");
  EXPECT_EQ(ProgressText("learning", 0, 0, 30), "learning");
}

}  // namespace
}  // namespace beckon::perception
