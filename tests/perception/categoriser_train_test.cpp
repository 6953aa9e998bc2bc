// Training: machines, folds, calibration, folders.
#include "services/perception/train.h"

#include <gmock/gmock.h>
#include <libsvm/svm.h>

#include <fstream>
#include <set>

#include "services/perception/bag_of_words.h"
#include "services/perception/model_file.h"
#include "services/perception/train_data.h"
#include "services/perception/train_program.h"
#include "services/perception/train_report.h"
#include "services/perception/train_svm.h"
#include "tests/perception/categoriser_folder.h"
#include "tests/perception/categoriser_trained.h"

namespace beckon::perception {
namespace {

using testing::HasSubstr;

SvmTrainingSet ToySet() {
  SvmTrainingSet set;
  std::mt19937 random(4);
  set.classes = 3, set.fold_count = 4;
  for (int i = 0; i < 90; ++i) {
    const int label = i % 3;
    Features x(5);
    for (auto& value : x) value = static_cast<uint8_t>(random() % 120);
    x[static_cast<size_t>(label)] = static_cast<uint8_t>(x[static_cast<size_t>(label)] + 90);
    set.features.push_back(x);
    set.labels.push_back(label);
    set.folds.push_back(i / 3 % 4);
  }
  return set;
}

/// libsvm's own decision value of the machine that tells class 0 from the rest.
double LibsvmDecision(const SvmTrainingSet& set, double gamma, double cost, const Features& query) {
  std::vector<std::vector<svm_node>> nodes;
  const auto to_nodes = [](const Features& x) {
    std::vector<svm_node> row;
    for (size_t j = 0; j < x.size(); ++j) row.push_back({static_cast<int>(j) + 1, x[j] / 255.0});
    row.push_back({-1, 0});
    return row;
  };
  std::vector<svm_node*> x;
  std::vector<double> y;
  for (const Features& f : set.features) nodes.push_back(to_nodes(f));
  for (auto& row : nodes) x.push_back(row.data());
  for (const int label : set.labels) y.push_back(label == 0 ? 1 : -1);
  svm_problem problem{static_cast<int>(x.size()), y.data(), x.data()};
  int labels[] = {1, -1};
  double weights[] = {std::sqrt(2.0), 1};
  svm_parameter parameter{};
  parameter.svm_type = C_SVC, parameter.kernel_type = RBF;
  parameter.gamma = gamma, parameter.C = cost;
  parameter.eps = 1e-3, parameter.cache_size = 10, parameter.shrinking = 1;
  parameter.nr_weight = 2, parameter.weight_label = labels, parameter.weight = weights;
  svm_model* model = svm_train(&problem, &parameter);
  double value = 0;
  std::vector<svm_node> q = to_nodes(query);
  svm_predict_values(model, q.data(), &value);
  if (model->label[0] != 1) value = -value;
  svm_free_and_destroy_model(&model);
  return value;
}

TEST(Svm, DecidesAsLibsvmDoes) {
  const SvmTrainingSet set = ToySet();
  const TrainedSvm trained = *TrainSvm(set, {.cost = 5, .gamma_scale = 1});
  for (size_t i = 0; i < 20; ++i) {
    const double expected =
        LibsvmDecision(set, static_cast<double>(trained.classifier.gamma), 5, set.features[i]);
    EXPECT_NEAR(trained.classifier.Decide(set.features[i])[0], expected, 5e-3) << i;
  }
}

TEST(Svm, GivesProbabilitiesThatFavourTheTruth) {
  const SvmTrainingSet set = ToySet();
  const TrainedSvm trained = *TrainSvm(set, {.cost = 5, .gamma_scale = 1});
  int right = 0;
  for (size_t i = 0; i < set.labels.size(); ++i) {
    const auto& p = trained.out_of_fold[i];
    right += std::max_element(p.begin(), p.end()) - p.begin() == set.labels[i];
    EXPECT_NEAR(p[0] + p[1] + p[2], 1, 1e-5);
  }
  EXPECT_GT(right, 70) << "of 90, held out";
}

TEST(Svm, FitsPlattsSigmoid) {
  // Decisions whose true probability is 1 / (1 + exp(-2 f + 0.5)).
  std::mt19937 random(8);
  std::vector<double> decisions;
  std::vector<bool> positive;
  for (int i = 0; i < 20000; ++i) {
    const double f = 6.0 * random() / 4294967296.0 - 3;
    decisions.push_back(f);
    positive.push_back(random() / 4294967296.0 < 1 / (1 + std::exp(-2 * f + 0.5)));
  }
  const Sigmoid sigmoid = FitSigmoid(decisions, positive);
  EXPECT_NEAR(sigmoid.a, -2, 0.1);
  EXPECT_NEAR(sigmoid.b, 0.5, 0.1);
}

TEST(BagOfWords, FindsTheClusters) {
  Descriptors samples(60, 2);
  for (int i = 0; i < 60; ++i) {
    samples.row(i) << static_cast<float>(i % 3) * 10 + 0.01F * static_cast<float>(i), 0;
  }
  std::mt19937 random(1);
  const Descriptors words = LearnVocabulary(samples, 3, 10, random);
  std::set<int> centres;
  for (int i = 0; i < 3; ++i) centres.insert(static_cast<int>(std::lround(words(i, 0) / 10)));
  EXPECT_EQ(centres.size(), 3U);
  const Eigen::RowVectorXf bag = BagOfWords(words, samples);
  EXPECT_NEAR(bag.squaredNorm(), 1, 1e-5);
  EXPECT_NEAR(bag.maxCoeff(), bag.minCoeff(), 1e-5);
  EXPECT_EQ(BagOfWords(words, Descriptors(0, 2)).sum(), 0);
}

TEST(Training, KeepsAnInstancesViewsInOneFoldAndDealsEvenly) {
  std::map<std::string, std::string> category_of;
  for (int i = 0; i < 20; ++i) category_of["a" + std::to_string(i)] = "A";
  for (int i = 0; i < 7; ++i) category_of["b" + std::to_string(i)] = "B";
  const auto folds = DealFolds(category_of, 5, 3);
  std::map<int, int> of_a;
  for (const auto& [instance, fold] : folds) {
    if (category_of[instance] == "A") ++of_a[fold];
  }
  for (int fold = 0; fold < 5; ++fold) EXPECT_EQ(of_a[fold], 4);
  EXPECT_EQ(DealFolds(category_of, 5, 3), folds);
}

TEST(Training, IsDeterministic) {
  const Result<TrainOutcome> again = TrainOnShapes(SmallTraining());
  ASSERT_TRUE(again);
  EXPECT_EQ(SerialiseModel(again->model), SerialiseModel(TrainedOnShapes().model));
}

TEST(Training, FindsTheTemperatureOfOverconfidentProbabilities) {
  // Right 70 % of the time, but claims 97 %.
  std::vector<std::vector<float>> probabilities;
  std::vector<int> labels;
  for (int i = 0; i < 1000; ++i) {
    probabilities.push_back({0.97F, 0.03F});
    labels.push_back(i % 10 < 7 ? 0 : 1);
  }
  const float temperature = FitTemperature(probabilities, labels);
  EXPECT_NEAR(ApplyTemperature({0.97F, 0.03F}, temperature)[0], 0.7, 0.01);
}

TEST(Training, RefusesOneCategoryAndOneInstance) {
  std::mt19937 random(2);
  const ShapeView a = RenderCategory("Box", random), b = RenderCategory("Can", random);
  for (const bool second_category : {false, true}) {
    std::vector<LabelledView> views = {{a, "Box", "1"}, {a, "Box", "2"}};
    if (second_category) views.push_back({b, "Can", "1"});
    const auto outcome = TrainOn(SmallTraining(), views);
    ASSERT_FALSE(outcome);
    EXPECT_THAT(outcome.error().message,
                HasSubstr(second_category ? "found one of Can" : "found only Box"));
  }
  EXPECT_FALSE(TrainOn(SmallTraining(), {}));
}

TEST(Report, ChoosesTheThresholdThatMeetsTheTarget) {
  std::vector<Judgement> judgements;
  for (int i = 0; i < 100; ++i) {
    // Surer than 0.5: always right. Less sure: half.
    judgements.push_back({0, i < 50 && i % 2 == 0 ? 1 : 0, true, 0.01F * static_cast<float>(i)});
  }
  const float threshold = ChooseThreshold(judgements, 0.99);
  EXPECT_NEAR(threshold, 0.48, 0.011);
  EXPECT_EQ(ChooseThreshold({{0, 1, true, 0.9F}}, 0.9), 1);
  EXPECT_NEAR(SurestAccuracy(judgements, 0.5), 1, 1e-9);
  EXPECT_NEAR(Accuracy(judgements), 0.75, 1e-9);
  EXPECT_NEAR(MacroRecall(judgements, 2), 0.75, 1e-9);
}

TEST_F(TrainFolder, NamesInstancesByManifestFolderOrFileName) {
  Write("Box/a__x_0.pcd", "Box", 1);
  Write("Box/b_0.pcd", "Box", 1);
  Write("Can/c/0.pcd", "Can", 1);
  Write("Can/d.pcd", "Can", 1);
  std::ofstream(folder_ / "manifest.csv")
      << "file,product,note,up_x,up_y,up_z,fx,fy,cx,cy\r\n"
      << "Can/d.pcd,tomatoes,\"red, round\",0,-0.8,-0.6,500,501,320,240\r\n";
  const auto views = ListViews(folder_.string());
  ASSERT_TRUE(views) << views.error().message;
  ASSERT_EQ(views->size(), 4U);
  EXPECT_EQ((*views)[0].instance, "a");
  EXPECT_EQ((*views)[1].instance, "b");
  EXPECT_EQ((*views)[2].instance, "c");
  EXPECT_EQ((*views)[3].instance, "tomatoes");
  ASSERT_TRUE((*views)[3].up_C);
  EXPECT_NEAR((*views)[3].up_C->y(), -0.8, 1e-9);
  EXPECT_EQ((*views)[3].intrinsics->fy, 501);
  EXPECT_FALSE((*views)[0].up_C);
}

TEST_F(TrainFolder, FollowsLinksToCategoriesAndEndsWhereTheyGoRound) {
  Write("kept/elsewhere/a_0.pcd", "Box", 1);
  Write("lab/Can/c_0.pcd", "Can", 1);
  fs::create_directory_symlink(folder_ / "kept/elsewhere", folder_ / "lab/Box");
  fs::create_directory_symlink(folder_ / "lab/Can", folder_ / "lab/Can/round");
  const auto views = ListViews((folder_ / "lab").string());
  ASSERT_TRUE(views) << views.error().message;
  ASSERT_GE(views->size(), 2U);
  EXPECT_EQ(views->front().category, "Box");
  EXPECT_EQ(views->front().instance, "a");
  for (size_t i = 1; i < views->size(); ++i) EXPECT_EQ((*views)[i].category, "Can");
}

TEST_F(TrainFolder, TrainsSkipsTheUnreadableAndTests) {
  for (uint32_t i = 0; i < 4; ++i) {
    for (const std::string category : {"Bowl", "Box", "Can"}) {
      Write(category + "/" + std::to_string(i) + "_0.pcd", category, 10 + i);
    }
  }
  std::ofstream(folder_ / "Can/broken_0.pcd") << "no cloud";
  TrainOptions options;
  options.data = folder_.string();
  options.model = (folder_ / "m.model").string();
  options.picture = (folder_ / "m.png").string();
  TrainConfig config = SmallTraining();
  ASSERT_TRUE(RunTraining(options, config));
  EXPECT_GT(fs::file_size(folder_ / "m.png"), 1000U);

  TrainOptions test;
  test.test = folder_.string();
  test.model = options.model;
  test.jsonl = (folder_ / "out.jsonl").string();
  ASSERT_TRUE(RunTest(test));
  std::ifstream lines(test.jsonl);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    for (const char* key : {"\"file\":", "\"category\":", "\"predicted\":", "\"probabilities\":{",
                            "\"confidence\":", "\"ask_user\":", "\"time_ms\":"}) {
      EXPECT_THAT(line, HasSubstr(key));
    }
  }
  EXPECT_EQ(count, 12);
}

TEST_F(TrainFolder, SaysWhatIsWrongWithAFolder) {
  TrainOptions options;
  options.model = (folder_ / "m.model").string();
  options.data = (folder_ / "none").string();
  Status status = RunTraining(options, SmallTraining());
  ASSERT_FALSE(status);
  EXPECT_THAT(status.error().message, HasSubstr("none"));
  options.data = folder_.string();
  status = RunTraining(options, SmallTraining());
  ASSERT_FALSE(status);
  EXPECT_THAT(status.error().message, HasSubstr("found none"));
  Write("Box/a_0.pcd", "Box", 1);
  Write("Box/b_0.pcd", "Box", 2);
  status = RunTraining(options, SmallTraining());
  ASSERT_FALSE(status);
  EXPECT_THAT(status.error().message, HasSubstr("found only Box"));
  std::ofstream(folder_ / "manifest.csv") << "file,up_x\nBox/a_0.pcd\n";
  EXPECT_FALSE(RunTraining(options, SmallTraining()));
}

}  // namespace
}  // namespace beckon::perception
