// The configuration that ships, and those that are wrong.
#include "services/perception/perception_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace beckon::perception {
namespace {

Result<PerceptionConfig> Read(const std::string& text, const Overrides& overrides = {}) {
  auto table = ConfigTable::Parse(text, "test.toml");
  if (!table) return table.error();
  return ReadPerceptionConfig(*table, overrides);
}

TEST(PerceptionConfig, TheShippedFileHoldsTheDefaults) {
  auto table = ConfigTable::Load(BECKON_SOURCE_DIR "/services/perception/perception.toml");
  ASSERT_TRUE(table) << table.error().message;
  auto read = ReadPerceptionConfig(*table);
  ASSERT_TRUE(read) << read.error().message;
  const PerceptionConfig defaults;
  const SegmentationConfig &a = read->perceiver.segmentation, &b = defaults.perceiver.segmentation;
  EXPECT_EQ(a.method, b.method);
  EXPECT_EQ(a.sensor.floor_m, b.sensor.floor_m);
  EXPECT_EQ(a.sensor.growth_per_m, b.sensor.growth_per_m);
  EXPECT_EQ(a.sensor.from_m, b.sensor.from_m);
  EXPECT_EQ(a.reference_min_range_m, b.reference_min_range_m);
  EXPECT_EQ(a.min_object_m2, b.min_object_m2);
  EXPECT_EQ(a.min_range_m, b.min_range_m);
  EXPECT_EQ(a.max_range_m, b.max_range_m);
  EXPECT_EQ(a.voxel_m, b.voxel_m);
  EXPECT_EQ(a.use_normals, b.use_normals);
  EXPECT_EQ(a.normal_neighbours, b.normal_neighbours);
  EXPECT_EQ(a.normal_weight, b.normal_weight);
  EXPECT_EQ(a.plane_distance_m, b.plane_distance_m);
  EXPECT_EQ(a.plane_iterations, b.plane_iterations);
  EXPECT_EQ(a.plane_min_points, b.plane_min_points);
  EXPECT_EQ(a.table_max_tilt_deg, b.table_max_tilt_deg);
  EXPECT_EQ(a.table_gap_m, b.table_gap_m);
  EXPECT_EQ(a.min_height_m, b.min_height_m);
  EXPECT_EQ(a.max_height_m, b.max_height_m);
  EXPECT_EQ(a.cluster_tolerance_m, b.cluster_tolerance_m);
  EXPECT_EQ(a.cluster_min_points, b.cluster_min_points);
  EXPECT_EQ(a.border_m, b.border_m);
  EXPECT_EQ(a.max_objects, b.max_objects);
  EXPECT_EQ(read->perceiver.tracker.max_step_m, defaults.perceiver.tracker.max_step_m);
  EXPECT_EQ(read->perceiver.tracker.min_overlap, defaults.perceiver.tracker.min_overlap);
  EXPECT_EQ(read->perceiver.tracker.forget_after_frames,
            defaults.perceiver.tracker.forget_after_frames);
  EXPECT_EQ(read->perceiver.tracker.max_jump_m, defaults.perceiver.tracker.max_jump_m);
  EXPECT_EQ(read->perceiver.tracker.min_likeness, defaults.perceiver.tracker.min_likeness);
  EXPECT_EQ(read->perceiver.tracker.steady, defaults.perceiver.tracker.steady);
  EXPECT_EQ(read->perceiver.tracker.settle_after_frames,
            defaults.perceiver.tracker.settle_after_frames);
  EXPECT_EQ(read->perceiver.recategorise_step_m, defaults.perceiver.recategorise_step_m);
  EXPECT_EQ(read->perceiver.recategorise_growth, defaults.perceiver.recategorise_growth);
  EXPECT_EQ(read->learning.folder, defaults.learning.folder);
  EXPECT_EQ(read->learning.most_views, defaults.learning.most_views);
  EXPECT_EQ(read->perceiver.views_per_object, defaults.perceiver.views_per_object);
  EXPECT_EQ(read->perceiver.evidence.dependence, defaults.perceiver.evidence.dependence);
  EXPECT_EQ(read->perceiver.threads, defaults.perceiver.threads);
  EXPECT_EQ(read->categories, defaults.categories);
  EXPECT_EQ(read->model, defaults.model);
  EXPECT_EQ(read->ask_at_or_below, defaults.ask_at_or_below);
  EXPECT_EQ(read->cues, defaults.cues);
  EXPECT_EQ(read->unknown_prior, defaults.unknown_prior);
}

TEST(PerceptionConfig, RefusesWhatIsWrong) {
  for (const char* text :
       {"[segmentation]\nvoxel_m = 0", "[segmentation]\nvoxel = 0.002",
        "[segmentation]\nmethod = \"magic\"", "threads = 0",
        "[segmentation]\nmin_range_m = 2.0\nmax_range_m = 1.0",
        "[segmentation]\nmin_height_m = 0.6", "[segmentation]\nnoise_floor_m = 0",
        "[segmentation]\nreference_min_range_m = 3.5", "[tracker]\nmin_overlap = \"a\""}) {
    const auto read = Read(text);
    ASSERT_FALSE(read) << text;
    EXPECT_THAT(read.error().message, testing::HasSubstr("test.toml")) << text;
  }
}

TEST(PerceptionConfig, TheCommandLineGoesOverTheFile) {
  const auto read = Read("threads = 2\n[categoriser]\nmodel = \"a\"",
                         {.model = "b", .no_categories = true, .threads = 3});
  ASSERT_TRUE(read);
  EXPECT_EQ(read->perceiver.threads, 3);
  EXPECT_EQ(read->model, "b");
  EXPECT_FALSE(read->categories);
  EXPECT_FALSE(Read("", {.segmentation = "magic"}));
}

TEST(PerceptionConfig, ChoosesTheCuesThatHaveASay) {
  const std::string model = BECKON_SOURCE_DIR "/services/perception/categories.model";
  const auto read = Read("[categoriser]\ncues = \"shape\"\nunknown_prior = 3.0",
                         {.model = model, .cues = "dissertation"});
  ASSERT_TRUE(read);
  EXPECT_EQ(read->cues, "dissertation");
  PerceptionConfig plain;
  plain.model = model;
  const auto all = LoadCategoriser(plain), some = LoadCategoriser(*read);
  ASSERT_TRUE(all) << all.error().message;
  ASSERT_TRUE(some) << some.error().message;
  EXPECT_NE((*all)->threshold(), (*some)->threshold());
  EXPECT_EQ((*some)->unknown_prior(), 3);
  PerceptionConfig wrong = plain;
  wrong.cues = "smell";
  const auto refused = LoadCategoriser(wrong);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, testing::HasSubstr("smell"));
}

TEST(PerceptionConfig, AMissingModelIsClear) {
  PerceptionConfig config;
  config.model = "/no/such.model";
  const auto categoriser = LoadCategoriser(config);
  ASSERT_FALSE(categoriser);
  EXPECT_THAT(categoriser.error().message, testing::HasSubstr("/no/such.model"));
  EXPECT_THAT(categoriser.error().message, testing::HasSubstr("--no-categories"));
  config.categories = false;
  EXPECT_TRUE(LoadCategoriser(config));
}

}  // namespace
}  // namespace beckon::perception
