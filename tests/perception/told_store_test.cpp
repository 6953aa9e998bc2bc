// The folder of examples: read as beckon-train reads it, whole or not at all.
#include "services/perception/told_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>

#include "services/perception/train_data.h"
#include "tests/intention/temporary_folder.h"
#include "tests/perception/box_world.h"

namespace beckon::perception {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class StoreTest : public ::testing::Test {
 protected:
  void SetUp() override {
    BoxWorld world = ThreeBoxes();
    std::vector<int> boxes;
    image = world.Render(&boxes);
    for (uint32_t i = 0; i < boxes.size(); ++i) {
      if (boxes[i] == 2) pixels.push_back(i);
    }
    table = Plane{world.X_WC().linear().transpose() * Eigen::Vector3d::UnitZ(), 0.6};
  }
  ObjectView View() const { return {image, pixels, table}; }
  ToldStore Open() {
    auto store = ToldStore::Open({.folder = folder_path});
    EXPECT_TRUE(store) << (store ? "" : store.error().message);
    return *std::move(store);
  }
  int Files(const std::string& ending) const {
    int n = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder_path))
      n += entry.path().string().ends_with(ending) ? 1 : 0;
    return n;
  }

  RgbdImage image;
  std::vector<uint32_t> pixels;
  std::optional<Plane> table;
  intention::TemporaryFolder folder;
  const std::string folder_path = (folder / "examples").string();
};

TEST_F(StoreTest, WhatIsKeptIsReadByTrainingAsItWas) {
  ToldStore store = Open();
  ASSERT_TRUE(store.Add("s1/label/2", "Mug", View()));
  const auto records = ListViews(folder_path);
  ASSERT_TRUE(records) << records.error().message;
  ASSERT_EQ(records->size(), 1u);
  const ViewRecord& record = records->front();
  EXPECT_EQ(record.category, "Mug");
  EXPECT_EQ(record.instance, ToldStore::NameOf("s1/label/2"));
  EXPECT_EQ(record.file, "Mug/" + record.instance + "__0.pcd");
  ASSERT_TRUE(record.up_C);
  EXPECT_LT((*record.up_C - table->normal).norm(), 1e-4);
  const auto view = LoadView(record);
  ASSERT_TRUE(view) << view.error().message;
  EXPECT_EQ(view->pixels.size(), pixels.size());
  EXPECT_LT(Difference(LookAtInstance(view->view()), LookAtInstance(View())), 0.1);
}

TEST_F(StoreTest, AnotherRunKnowsTheObjectAgain) {
  {
    ToldStore store = Open();
    ASSERT_TRUE(store.Add("a", "Mug", View()));
    ASSERT_TRUE(store.Add("a", "Mug", View()));
    ASSERT_TRUE(store.Add("b", "Unknown", View()));
  }
  ToldStore again = Open();
  EXPECT_TRUE(again.warnings().empty());
  ASSERT_EQ(again.loaded().size(), 3u);
  EXPECT_EQ(again.loaded()[0].category, "Mug");
  EXPECT_EQ(again.loaded()[2].category, "Unknown");
  EXPECT_EQ(again.loaded()[0].label_id, ToldStore::NameOf("a"));
  EXPECT_EQ(ToldStore::NameOf(ToldStore::NameOf("a")), ToldStore::NameOf("a"));
  EXPECT_LT(Difference(again.loaded()[0].look, LookAtInstance(View())), 0.1);
  ASSERT_TRUE(again.Remove("a"));
  EXPECT_EQ(Open().loaded().size(), 1u);
  EXPECT_EQ(Files(".png"), 3);
}

TEST_F(StoreTest, ATornViewIsLeftOutWithAWarning) {
  {
    ToldStore store = Open();
    for (const char* label : {"whole", "torn", "halved"})
      ASSERT_TRUE(store.Add(label, "Mug", View()));
  }
  const std::string mug = folder_path + "/Mug/";
  fs::remove(mug + ToldStore::NameOf("torn") + "__0_mask.png");
  const std::string depth = mug + ToldStore::NameOf("halved") + "__0_depth.png";
  fs::resize_file(depth, fs::file_size(depth) / 4);
  std::ofstream(mug + "x.pcd.part") << "half a";
  ToldStore store = Open();
  EXPECT_EQ(store.warnings().size(), 3u);
  ASSERT_EQ(store.loaded().size(), 1u);
  EXPECT_EQ(store.loaded()[0].label_id, ToldStore::NameOf("whole"));
  EXPECT_EQ(Files(".part"), 0);
  EXPECT_TRUE(store.Add("more", "Mug", View()));
}

TEST_F(StoreTest, AKillBeforeTheLastFileLeavesNoView) {
  { ASSERT_TRUE(Open().Add("a", "Mug", View())); }
  fs::remove(folder_path + "/Mug/" + ToldStore::NameOf("a") + "__0.pcd");
  ToldStore store = Open();
  EXPECT_TRUE(store.loaded().empty());
  ASSERT_TRUE(store.Add("a", "Mug", View()));
  EXPECT_EQ(Open().loaded().size(), 1u);
}

TEST_F(StoreTest, SomebodyElsesViewsStayAndAreNotTaken) {
  { ASSERT_TRUE(Open().Add("a", "Mug", View())); }
  const std::string mug = folder_path + "/Mug/";
  fs::copy(mug + ToldStore::NameOf("a") + "__0.pcd", mug + "ours__0.pcd");
  EXPECT_EQ(Open().loaded().size(), 1u);
  EXPECT_TRUE(Open().Remove("a"));
  EXPECT_TRUE(fs::exists(mug + "ours__0.pcd"));
}

TEST_F(StoreTest, AManifestOfOtherColumnsIsNotTouched) {
  fs::create_directories(folder_path);
  std::ofstream(folder_path + "/manifest.csv") << "file,colour\n";
  const auto store = ToldStore::Open({.folder = folder_path});
  ASSERT_FALSE(store);
  EXPECT_THAT(store.error().message, HasSubstr("manifest.csv"));
  EXPECT_THAT(store.error().message, HasSubstr("[learning] folder"));
}

TEST_F(StoreTest, AFolderThatCannotBeMadeIsAnError) {
  std::ofstream(folder / "file") << "x";
  const auto store = ToldStore::Open({.folder = (folder / "file/examples").string()});
  ASSERT_FALSE(store);
  EXPECT_THAT(store.error().message, HasSubstr("file/examples"));
}

TEST_F(StoreTest, HoldsNoMoreThanItMay) {
  auto store = ToldStore::Open({.folder = folder_path, .most_views = 2});
  ASSERT_TRUE(store);
  EXPECT_TRUE(store->Add("a", "Mug", View()));
  EXPECT_TRUE(store->Add("b", "Mug", View()));
  const Status third = store->Add("c", "Mug", View());
  ASSERT_FALSE(third);
  EXPECT_THAT(third.error().message, HasSubstr("most_views"));
}

/// As on a full disk: no file may grow beyond so many bytes.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

TEST_F(StoreTest, AFullDiskIsAnErrorThatLeavesNothingAndPasses) {
  ToldStore store = Open();
  ASSERT_TRUE(store.Add("a", "Mug", View()));
  for (const rlim_t bytes : {0, 100, 500, 2000}) {
    const FullDisk full(bytes);
    const Status kept = store.Add("b", "Mug", View());
    ASSERT_FALSE(kept) << bytes;
    EXPECT_THAT(kept.error().message, HasSubstr("space"));
  }
  EXPECT_EQ(Files(".part"), 0);
  EXPECT_EQ(Files(".pcd"), 1);
  EXPECT_EQ(Files(".png"), 3);
  EXPECT_EQ(Open().loaded().size(), 1u);
  EXPECT_TRUE(store.Add("b", "Mug", View()));
  EXPECT_EQ(Open().loaded().size(), 2u);
}

}  // namespace
}  // namespace beckon::perception
