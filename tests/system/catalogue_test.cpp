// What a simulated user may want.
#include "tools/beckon/catalogue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace beckon::tool {
namespace {

using ::testing::HasSubstr;

Result<Catalogue> Make(const std::string& toml) {
  const std::string path = ::testing::TempDir() + std::to_string(getpid()) + "_catalogue_test.toml";
  std::ofstream(path) << toml;
  auto catalogue = Catalogue::Load(path);
  std::filesystem::remove(path);
  return catalogue;
}

const char kToml[] =
    "[categories]\nCarton = [\"Grasp\", \"Open\"]\nTub = [\"Push\"]\nBox = [\"Grasp\"]\n";

TEST(Catalogue, TakesAPairThatGoesTogether) {
  const auto want = Make(kToml)->ParseWant("Open:Carton");
  ASSERT_TRUE(want);
  EXPECT_EQ(want->action, "Open");
  EXPECT_EQ(want->category, "Carton");
}

TEST(Catalogue, SaysWhatThereIsInsteadOfAnUnknownWant) {
  const auto catalogue = Make(kToml);
  for (const char* text : {"", "Open", ":Carton", "Open:", ":"}) {
    const auto want = catalogue->ParseWant(text);
    ASSERT_FALSE(want) << text;
    EXPECT_THAT(want.error().message, HasSubstr("ACTION:CATEGORY"));
  }
  EXPECT_THAT(catalogue->ParseWant("Open:Piano").error().message, HasSubstr("Box, Carton, Tub"));
  EXPECT_THAT(catalogue->ParseWant("Squeeze:Carton").error().message, HasSubstr("Grasp, Open"));
}

TEST(Catalogue, SuggestsToOpenTheCartonElseToGraspTheNearest) {
  const auto catalogue = Make(kToml);
  SceneTruth truth{true, {{"Piano", {0, 0, 0.1}}, {"Box", {0, 0, 1}}, {"Tub", {0, 0, 0.5}}}};
  EXPECT_EQ(catalogue->Suggest(truth)->Text(), "Push:Tub");
  truth.objects.push_back({"Carton", {0, 0, 2}});
  EXPECT_EQ(catalogue->Suggest(truth)->Text(), "Open:Carton");
  EXPECT_FALSE(catalogue->Suggest({true, {{"Piano", {0, 0, 1}}}}));
}

TEST(Catalogue, RefusesAFileThatIsNone) {
  EXPECT_FALSE(Catalogue::Load("/nowhere/affordances.toml"));
  EXPECT_FALSE(Make("[actions]\nOpen = \"open\"\n"));
}

}  // namespace
}  // namespace beckon::tool
