// Improving a model by a few views, without its training data.
#include "services/perception/train_base.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <map>

#include "services/perception/categoriser.h"
#include "services/perception/model_file.h"
#include "services/perception/train_data.h"
#include "tests/perception/categoriser_trained.h"

namespace beckon::perception {
namespace {

using testing::HasSubstr;

Result<BaseTrainer::Outcome> Improve(const Model& base, const std::vector<LabelledView>& views) {
  std::vector<std::string> categories;
  for (const LabelledView& view : views) categories.push_back(view.category);
  BaseTrainer trainer(base, categories);
  for (const LabelledView& view : views) {
    auto said = trainer.Describe(view.shape.view());
    if (!said) return said.error();
    trainer.Add(*std::move(said), view.category, view.instance);
  }
  return trainer.Finish(SmallTraining(), {});
}

double AccuracyOn(const Model& model, const std::vector<LabelledView>& views) {
  const Categoriser categoriser(model);
  double right = 0;
  for (const LabelledView& view : views) {
    right += categoriser.Categorise(view.shape.view()).probabilities.at(0).first == view.category;
  }
  return right / static_cast<double>(views.size());
}

/// Tall cans, which the base takes for cans.
std::vector<LabelledView> Bottles(int count, uint32_t seed) {
  std::vector<LabelledView> views;
  std::mt19937 random(seed);
  for (int i = 0; i < count; ++i) {
    const double height = 0.2 + 0.05 * (random() / 4294967296.0);
    views.push_back(
        {RenderShape(CanShape(0.028, height), random), "Bottle", std::to_string(i / 2)});
  }
  return views;
}

TEST(Base, LearnsWhatItTookForSomethingElse) {
  const Model& base = TrainedOnShapes().model;
  auto own = Bottles(6, 3), others = Bottles(6, 4);
  for (auto* views : {&own, &others}) {
    for (LabelledView& view : *views) view.category = "Box";  // as this lab calls them
  }
  ASSERT_LT(AccuracyOn(base, others), 0.2);
  const auto outcome = Improve(base, own);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_GE(AccuracyOn(outcome->improved.model, others), 0.8);
  EXPECT_GE(AccuracyOn(outcome->improved.model, own), 0.8);
}

TEST(Base, LearnsANewCategory) {
  const Model& base = TrainedOnShapes().model;
  const auto outcome = Improve(base, Bottles(8, 3));
  ASSERT_TRUE(outcome) << outcome.error().message;
  const Model& improved = outcome->improved.model;
  EXPECT_EQ(improved.categories, (std::vector<std::string>{"Bottle", "Bowl", "Box", "Can"}));
  ASSERT_TRUE(Validate(improved)) << Validate(improved).error().message;
  EXPECT_GE(AccuracyOn(improved, Bottles(6, 4)), 0.8);
  const auto again = ParseModel(SerialiseModel(improved), "m");
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(SerialiseModel(*again), SerialiseModel(improved));
}

TEST(Base, ANewCategoryByItselfChangesNothing) {
  Model extended = TrainedOnShapes().model;
  AddCategory("Bottle", extended);
  AddCategory("Zebra", extended);
  AddCategory("Bowl", extended);
  EXPECT_EQ(extended.categories.size(), 5U);
  ASSERT_TRUE(Validate(extended)) << Validate(extended).error().message;
  const Categoriser before(TrainedOnShapes().model), after(extended);
  for (const LabelledView& view : RenderViews({"Bowl", "Box", "Can"}, 3, 77)) {
    const auto a = before.Categorise(view.shape.view()), b = after.Categorise(view.shape.view());
    EXPECT_EQ(a.probabilities[0].first, b.probabilities[0].first);
    EXPECT_NEAR(a.probabilities[0].second, b.probabilities[0].second, 0.02);
  }
}

TEST(Base, ThreeViewsOfOneClassDoNoHarm) {
  const Model& base = TrainedOnShapes().model;
  const auto test = RenderViews({"Bowl", "Box", "Can"}, 10, 78);
  for (const char* category : {"Bowl", "Box", "Can"}) {
    const auto outcome = Improve(base, RenderViews({category}, 3, 79));
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_GE(AccuracyOn(outcome->improved.model, test), AccuracyOn(base, test) - 0.034);
  }
}

TEST(Base, IsImprovedTwice) {
  const Model& base = TrainedOnShapes().model;
  const auto once = Improve(base, Bottles(6, 3));
  ASSERT_TRUE(once);
  const auto twice = Improve(once->improved.model, RenderViews({"Can"}, 3, 5));
  ASSERT_TRUE(twice) << twice.error().message;
  const auto& correction = twice->improved.model.deciders.front().correction;
  EXPECT_EQ(correction.vectors.rows(), 9);
  EXPECT_GE(AccuracyOn(twice->improved.model, Bottles(6, 4)), 0.8);
}

TEST(Base, SaysWhatItSaidBeforeAndWhatItSaysOfObjectsHeldOut) {
  const auto own = Bottles(6, 3);
  const auto outcome = Improve(TrainedOnShapes().model, own);
  ASSERT_TRUE(outcome);
  ASSERT_EQ(outcome->before.size(), own.size());
  ASSERT_EQ(outcome->improved.held_out.size(), outcome->improved.model.deciders.size());
  double before = 0, after = 0;
  for (size_t i = 0; i < own.size(); ++i) {
    before += outcome->before[i].probabilities[0];
    after += outcome->improved.held_out[0][i].probabilities[0];
  }
  EXPECT_GT(after, before + 1);
}

/// Views of real products, kept outside the project.
std::vector<LabelledView> RealViews() {
  const char* data = std::getenv("BECKON_DATA");
  const std::string folder =
      (data != nullptr ? std::string(data) : std::string(BECKON_SOURCE_DIR) + "/../shared/data") +
      "/objects";
  const auto records = ListViews(folder);
  std::vector<LabelledView> views;
  if (!records) return views;
  for (const ViewRecord& record : *records) {
    auto view = LoadView(record);
    if (!view) continue;
    ShapeView shape{std::move(view->image), std::move(view->pixels),
                    view->table_C.value_or(Plane{})};
    views.push_back({std::move(shape), record.category, record.instance});
  }
  return views;
}

/// Half the products are one's own, and half of their views are learnt from.
struct Halves {
  std::vector<LabelledView> own, same_products, other_products;
};

Halves Split(const std::vector<LabelledView>& views, uint32_t seed) {
  std::map<std::string, std::vector<const LabelledView*>> products;
  for (const LabelledView& view : views) {
    products[view.category + "/" + view.instance].push_back(&view);
  }
  std::vector<std::vector<const LabelledView*>> shuffled;
  std::mt19937 random(seed);
  for (auto& [name, of_product] : products) {
    for (size_t i = of_product.size(); i > 1; --i) {
      std::swap(of_product[i - 1], of_product[random() % i]);
    }
    shuffled.push_back(of_product);
  }
  for (size_t i = shuffled.size(); i > 1; --i) std::swap(shuffled[i - 1], shuffled[random() % i]);
  Halves out;
  for (size_t p = 0; p < shuffled.size(); ++p) {
    for (size_t i = 0; i < shuffled[p].size(); ++i) {
      const bool mine = p < shuffled.size() / 2, learnt = 2 * i < shuffled[p].size();
      (!mine    ? out.other_products
       : learnt ? out.own
                : out.same_products)
          .push_back(*shuffled[p][i]);
    }
  }
  return out;
}

TEST(Base, ImprovesTheShippedModelOnRealProducts) {
  const auto views = RealViews();
  if (views.empty()) GTEST_SKIP() << "no real views (set BECKON_DATA)";
  const Result<Model> base =
      ReadModelFile(std::string(BECKON_SOURCE_DIR) + "/services/perception/categories.model");
  ASSERT_TRUE(base) << base.error().message;
  constexpr uint32_t kSplits = 5;
  double same_before = 0, same_after = 0, other_before = 0, other_after = 0;
  for (uint32_t seed = 0; seed < kSplits; ++seed) {
    const Halves halves = Split(views, seed);
    const auto outcome = Improve(*base, halves.own);
    ASSERT_TRUE(outcome) << outcome.error().message;
    const Model& improved = outcome->improved.model;
    same_before += AccuracyOn(*base, halves.same_products) / kSplits;
    same_after += AccuracyOn(improved, halves.same_products) / kSplits;
    other_before += AccuracyOn(*base, halves.other_products) / kSplits;
    other_after += AccuracyOn(improved, halves.other_products) / kSplits;
  }
  std::printf("same products %.3f -> %.3f, other products %.3f -> %.3f\n", same_before, same_after,
              other_before, other_after);
  EXPECT_GE(same_after, same_before - 0.005);
  EXPECT_GE(other_after, other_before - 0.005);
  EXPECT_GT(same_after + other_after, same_before + other_before);
}

TEST(Base, NamesTheCategoryThatHasNoUsableView) {
  BaseTrainer trainer(TrainedOnShapes().model, {"Bottle", "Can"});
  const auto views = RenderViews({"Can"}, 1, 5);
  trainer.Add(*trainer.Describe(views[0].shape.view()), "Can", "1");
  const auto outcome = trainer.Finish(SmallTraining(), {});
  ASSERT_FALSE(outcome);
  EXPECT_THAT(outcome.error().message, HasSubstr("Bottle"));
}

}  // namespace
}  // namespace beckon::perception
