// Calibrations on disk.
#include "services/ui_bridge/bci/calibration_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>

namespace beckon::ui_bridge::bci {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class CalibrationFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "beckon-bci-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    path_ = (folder_ / "deep" / "ann.cap.2.json").string();
  }
  void TearDown() override { fs::remove_all(folder_); }

  void Write(const std::string& text) {
    fs::create_directories(fs::path(path_).parent_path());
    std::ofstream(path_) << text;
  }
  LoadedCalibration Load(size_t classes = 2) { return LoadCalibration(path_, classes, {}); }

  fs::path folder_;
  std::string path_;
};

TEST_F(CalibrationFileTest, WhatIsSavedIsLoaded) {
  Calibration calibration(2);
  for (int i = 0; i < 30; ++i)
    ASSERT_TRUE(calibration.Add({static_cast<size_t>(i % 2), {0.123456789, 0.876543211}}));
  ASSERT_TRUE(SaveCalibration(path_, calibration));
  const auto loaded = Load();
  EXPECT_EQ(loaded.warning, "");
  ASSERT_EQ(loaded.calibration.trials().size(), 30u);
  EXPECT_EQ(loaded.calibration.trials()[1].meant, 1u);
  EXPECT_NEAR(loaded.calibration.trials()[1].probabilities[0], 0.12346, 1e-9);
  EXPECT_NEAR(loaded.calibration.Fit().sharpness, calibration.Fit().sharpness, 1e-3);
  EXPECT_EQ(std::distance(fs::directory_iterator(fs::path(path_).parent_path()), {}), 1);
}

TEST_F(CalibrationFileTest, NoFileIsAFreshStartWithoutAWord) {
  const auto loaded = Load();
  EXPECT_TRUE(loaded.calibration.trials().empty());
  EXPECT_EQ(loaded.warning, "");
}

TEST_F(CalibrationFileTest, ATornFileIsPutAside) {
  Calibration calibration(2);
  ASSERT_TRUE(calibration.Add({0, {0.5, 0.5}}));
  ASSERT_TRUE(SaveCalibration(path_, calibration));
  const auto size = fs::file_size(path_);
  for (uintmax_t kept = 0; kept + 2 < size; kept += 5) {
    ASSERT_TRUE(SaveCalibration(path_, calibration));
    fs::resize_file(path_, kept);
    const auto loaded = Load();
    EXPECT_TRUE(loaded.calibration.trials().empty()) << kept;
    EXPECT_THAT(loaded.warning, HasSubstr(".bad")) << kept;
    EXPECT_FALSE(fs::exists(path_));
    EXPECT_TRUE(fs::exists(path_ + ".bad"));
  }
}

TEST_F(CalibrationFileTest, ForeignFilesArePutAside) {
  const std::string trial = R"([[0,[0.5,0.5]]])";
  for (const std::string& text :
       {std::string("[]"), std::string("{}"),
        std::string(R"({"version":2,"classes":2,"trials":[]})"),
        std::string(R"({"version":1,"classes":3,"trials":[]})"),
        std::string(R"({"version":1,"classes":2,"trials":[[0]]})"),
        std::string(R"({"version":1,"classes":2,"trials":[[2,[0.5,0.5]]]})"),
        std::string(R"({"version":1,"classes":2,"trials":[[0,[0.9,0.5]]]})"),
        std::string(R"({"version":1,"classes":2,"trials":[[-1,[0.5,0.5]]]})"),
        std::string(R"({"version":1,"classes":2,"trials":[["0",[0.5,"x"]]]})"),
        std::string(R"({"version":1,"classes":"2","trials":{}})")}) {
    Write(text);
    const auto loaded = Load();
    EXPECT_TRUE(loaded.calibration.trials().empty()) << text;
    EXPECT_THAT(loaded.warning, HasSubstr("calibration starts anew")) << text;
    EXPECT_FALSE(fs::exists(path_)) << text;
  }
  Write(R"({"version":1,"classes":2,"trials":)" + trial + "}");
  EXPECT_EQ(Load().calibration.trials().size(), 1u);
}

TEST_F(CalibrationFileTest, AFolderInItsPlaceIsNoReasonToDie) {
  fs::create_directories(path_);
  EXPECT_NE(Load().warning, "");
  fs::create_directories(path_);
  EXPECT_FALSE(SaveCalibration(folder_.string(), Calibration(2)));
}

TEST(CalibrationFileName, KeepsDecodersAndUsersApartAndStaysInItsFolder) {
  std::set<std::string> names;
  for (const auto& [user, decoder] :
       std::vector<std::pair<std::string, std::string>>{{"ann", "cap"},
                                                        {"ann", "lsl:cap"},
                                                        {"ann", "lsl/cap"},
                                                        {"ann", "../../etc"},
                                                        {"ann", "ä"},
                                                        {"a", "b.c"},
                                                        {"a.b", "c"},
                                                        {"ann", std::string(300, 'x')}}) {
    const auto name = CalibrationFileName(user, decoder, 4);
    EXPECT_EQ(name.find('/'), std::string::npos);
    EXPECT_LT(name.size(), 200u);
    EXPECT_TRUE(names.insert(name).second) << name;
  }
  EXPECT_NE(CalibrationFileName("ann", "cap", 4), CalibrationFileName("ann", "cap", 9));
}

}  // namespace
}  // namespace beckon::ui_bridge::bci
