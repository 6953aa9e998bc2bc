// Embedded objects seen from two sides by the shipped model: what both views say together is right
// more often than what either says.
#include <gtest/gtest.h>

#include <cmath>

#include "services/capture/embedded_object_view.h"
#include "services/perception/category_evidence.h"
#include "tests/perception/view_score.h"

namespace beckon::perception {
namespace {

constexpr int kPerCategory = 16;

struct Seen {
  SeenAt at;
  InstanceLook look;
  Categorisation said;
};

Seen See(const capture::ObjectView& rendered, const Categoriser& categoriser) {
  RgbdImage image{.width = rendered.crop.width,
                  .height = rendered.crop.height,
                  .intrinsics = rendered.intrinsics,
                  .depth_m = rendered.depth_m,
                  .colour = rendered.colour};
  image.intrinsics.cx -= rendered.crop.u0;
  image.intrinsics.cy -= rendered.crop.v0;
  std::vector<uint32_t> pixels;
  Seen seen;
  for (uint32_t i = 0; i < rendered.mask.size(); ++i) {
    if (rendered.mask[i] == 0 || !(image.depth_m[i] > 0)) continue;
    pixels.push_back(i);
    seen.at.centroid_C +=
        image.Point(static_cast<int>(i) % image.width, static_cast<int>(i) / image.width);
  }
  seen.at.n_points = pixels.size();
  seen.at.centroid_C /= static_cast<double>(std::max<size_t>(1, pixels.size()));
  std::optional<Plane> table_C;
  if (rendered.up_C) table_C = Plane{*rendered.up_C, 0};
  const ObjectView view{image, pixels, table_C};
  seen.look = LookAtInstance(view);
  seen.said = categoriser.Categorise(view);
  return seen;
}

TEST(Evidence, OfTwoViewsIsRightMoreOftenThanOfOne) {
  const auto categoriser =
      Categoriser::Load(BECKON_SOURCE_DIR "/services/perception/categories.model");
  ASSERT_TRUE(categoriser) << categoriser.error().message;
  ViewScore one, both;
  const ToldExamples examples;
  const EvidenceConfig config{.ask_at_or_below = categoriser->threshold()};
  for (size_t c = 0; c < capture::kCategories.size(); ++c) {
    for (int i = 0; i < kPerCategory; ++i) {
      capture::Random random(capture::Random::Mix(77, c * 1000 + static_cast<uint64_t>(i)));
      const capture::Model model = capture::MakeModel(c, random);
      CategoryEvidence evidence;
      for (int view = 0; view < 2; ++view) {
        const Seen seen =
            See(*capture::RenderObjectView(model, /*any_camera=*/false, random), *categoriser);
        if (seen.said.probabilities.empty()) continue;
        one.Add(seen.said, capture::kCategories[c]);
        evidence.Add(seen.at, seen.look, seen.said, examples, config);
      }
      if (evidence.n_views() == 2)
        both.Add(evidence.Decide(examples, config), capture::kCategories[c]);
    }
  }
  ASSERT_GE(both.n, 80);
  const double right_one = 1.0 * one.right / one.n, right_both = 1.0 * both.right / both.n;
  RecordProperty("right_one_view", std::to_string(right_one));
  RecordProperty("right_two_views", std::to_string(right_both));
  std::printf("one view: %.3f right, log loss %.3f; two: %.3f, %.3f\n", right_one,
              one.log_loss / one.n, right_both, both.log_loss / both.n);
  EXPECT_GT(right_both, right_one + 0.01);
  EXPECT_LT(both.log_loss / both.n, one.log_loss / one.n);
}

}  // namespace
}  // namespace beckon::perception
