// Pictures show what was fitted, where it is, whatever the input.
#include "services/pose/picture.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <limits>
#include <opencv2/imgcodecs.hpp>

#include "services/pose/picture_canvas.h"
#include "services/pose/picture_scene.h"
#include "services/pose/picture_shape.h"
#include "services/pose/picture_view.h"
#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

namespace fs = std::filesystem;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

class PictureTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = fs::temp_directory_path() / ("beckon_picture_" + std::string(test->name()) + "_" +
                                         std::to_string(getpid()) + ".png");
  }
  void TearDown() override { fs::remove(path_); }

  cv::Mat Draw(const std::vector<Portrait>& portraits) {
    EXPECT_TRUE(DrawPortraits(path_, portraits, gripper_));
    return cv::imread(path_.string());
  }
  cv::Mat DrawOver(const RgbdImage& image, const std::vector<SceneObjectFit>& objects) {
    EXPECT_TRUE(DrawScene(path_, image, objects, gripper_));
    return cv::imread(path_.string());
  }

  Portrait Box() const {
    Portrait portrait{.title = "box.xyz", .points_F = box_.points_C, .table_F = box_.table_C};
    portrait.estimate.fit.shape = box_.shape_C;
    portrait.estimate.fit.converged = true;
    portrait.estimate.grasps =
        ProposeGrasps(portrait.estimate.fit, box_.points_C, box_.table_C, {}, gripper_);
    return portrait;
  }

  fs::path path_;
  const GripperConfig gripper_;
  const TableView box_ =
      ViewOnTable(MakeShape({0.03, 0.04, 0.06}, 0.1, 0.1, {0, 0, 0.06}, {0, 0, 0.5}), 2000, 0.001);
};

RgbdImage GreyImage() {
  RgbdImage image{.width = 640, .height = 480, .intrinsics = {}, .depth_m = {}, .colour = {}};
  image.depth_m.assign(640 * 480, 1.0f);
  image.colour.assign(640 * 480, Rgb{128, 128, 128});
  return image;
}

int Differences(const cv::Mat& a, const cv::Mat& b) {
  EXPECT_EQ(a.size(), b.size());
  if (a.size() != b.size()) return -1;
  cv::Mat difference;
  cv::absdiff(a, b, difference);
  return cv::countNonZero(difference.reshape(1));
}

cv::Mat Panel(const cv::Mat& picture, int column) {
  return picture(cv::Rect(column * kTileWidth_px / 2 + 2, 50, kTileWidth_px / 2 - 4, 285));
}

TEST_F(PictureTest, HasATileACloudInAGrid) {
  EXPECT_EQ(Draw({}).size(), cv::Size(kTileWidth_px, kLegendHeight_px));
  EXPECT_EQ(Draw({Box()}).size(), cv::Size(kTileWidth_px, kTileHeight_px + kLegendHeight_px));
  const std::vector<Portrait> six(6, Box());
  EXPECT_EQ(Draw(six).size(), cv::Size(2 * kTileWidth_px, 3 * kTileHeight_px + kLegendHeight_px));
}

TEST_F(PictureTest, HasRoomForItsLegend) {
  const cv::Mat picture = Draw({Box()});
  const cv::Mat edge = picture(cv::Rect(kTileWidth_px - 10, kTileHeight_px, 10, kLegendHeight_px));
  EXPECT_EQ(Differences(edge, cv::Mat(edge.size(), CV_8UC3, cv::Scalar::all(255))), 0);
}

TEST_F(PictureTest, LeavesOutWhatIsTooMany) {
  Portrait small = Box();
  small.points_F.resize(20);
  const cv::Mat picture = Draw(std::vector<Portrait>(200, small));
  EXPECT_EQ(picture.size(), cv::Size(4 * kTileWidth_px, 16 * kTileHeight_px + kLegendHeight_px));
}

TEST_F(PictureTest, IsTheSameEveryTime) { EXPECT_EQ(Differences(Draw({Box()}), Draw({Box()})), 0); }

TEST_F(PictureTest, ShowsTheFitInBothViews) {
  Portrait without = Box(), with = Box();
  without.points_F.clear();
  without.estimate.grasps.clear();
  with.estimate.grasps.clear();
  const cv::Mat wires = Draw({without}), points = Draw({with});
  for (const int column : {0, 1}) {
    const cv::Mat blank(Panel(wires, column).size(), CV_8UC3, cv::Scalar::all(255));
    EXPECT_GT(Differences(Panel(wires, column), blank), 10000) << column;
    EXPECT_GT(Differences(Panel(wires, column), Panel(points, column)), 10000) << column;
  }
}

TEST_F(PictureTest, ShowsTheGraspTheAlternativesAndTheParts) {
  ASSERT_FALSE(Box().estimate.grasps.empty());
  const cv::Mat whole = Draw({Box()});
  Portrait changed = Box();
  changed.estimate.grasps.clear();
  EXPECT_GT(Differences(whole, Draw({changed})), 5000);
  changed = Box();
  changed.estimate.fit.alternatives = {MakeShape({0.04, 0.04, 0.05}, 1, 1)};
  changed.estimate.fit.alternatives[0].X_FO = box_.shape_C.X_FO;
  EXPECT_GT(Differences(whole, Draw({changed})), 2000);
  changed = Box();
  changed.estimate.fit.parts = {box_.shape_C, changed.estimate.fit.shape};
  changed.estimate.fit.parts[1].semi_axes *= 0.5;
  EXPECT_GT(Differences(whole, Draw({changed})), 2000);
}

TEST_F(PictureTest, TellsWhatDidNotConverge) {
  const cv::Mat good = Draw({Box()});
  Portrait portrait = Box();
  portrait.estimate.fit.converged = false;
  portrait.estimate.fit.reason = "fewer than 20 points";
  const cv::Mat doubtful = Draw({portrait});
  const cv::Rect header(0, 0, kTileWidth_px, 48);
  EXPECT_GT(Differences(good(header), doubtful(header)), 500);
  EXPECT_GT(Differences(Panel(good, 0), Panel(doubtful, 0)), 2000);
  EXPECT_EQ(Describe(portrait.estimate.fit), "fewer than 20 points");
}

TEST_F(PictureTest, SurvivesWhatCannotBeSeen) {
  std::vector<Portrait> portraits(7, Box());
  portraits[0].points_F = {};
  portraits[1].points_F.assign(50, Eigen::Vector3f(kNaN, 0, 1));
  for (auto& p : portraits[2].points_F) p.z() = -p.z();
  portraits[3].estimate.fit.shape.X_FO.translation().setZero();  // the camera is inside
  portraits[4].viewpoint_F = box_.shape_C.X_FO.translation();    // and here
  portraits[5].table_F = Plane{Eigen::Vector3d(0, 0, -1), 0};    // seen from straight above
  portraits[6].points_F.assign(50, Eigen::Vector3f(1e30f, 1e30f, 1e-30f));
  portraits.emplace_back();  // nothing at all
  portraits.back().title = std::string(500, 'M');
  const cv::Mat picture = Draw(portraits);
  EXPECT_EQ(picture.cols, 2 * kTileWidth_px);
  const cv::Rect last_tile(kTileWidth_px, 3 * kTileHeight_px, kTileWidth_px, kTileHeight_px);
  EXPECT_LT(Differences(picture(last_tile)(cv::Rect(kTileWidth_px - 10, 0, 8, 46)),
                        cv::Mat(46, 8, CV_8UC3, cv::Scalar::all(255))),
            1)
      << "a title runs out of its tile";
}

TEST_F(PictureTest, RefusesANameThatIsNoPictures) {
  const Status written = DrawPortraits("/tmp/picture.nonsense", {Box()}, gripper_);
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("cannot be written"), std::string::npos);
}

TEST_F(PictureTest, PutsAFitWhereItsObjectIsInTheImage) {
  const RgbdImage image = GreyImage();
  SceneObjectFit object{.title = "box", .estimate = {}};
  object.estimate.fit.shape = box_.shape_C;
  object.estimate.fit.converged = true;
  const cv::Mat before = DrawOver(image, {}), after = DrawOver(image, {object});
  ASSERT_EQ(after.size(), cv::Size(1280, 960));
  for (const auto& p : SampleSurface(box_.shape_C, 50)) {
    const Eigen::Vector2d px = 2 * image.intrinsics.Project(p);
    const cv::Rect around(cvRound(px.x()) - 24, cvRound(px.y()) - 24, 48, 48);
    EXPECT_GT(Differences(before(around), after(around)), 30) << px.transpose();
  }
  const cv::Rect elsewhere(0, 0, 300, 960);
  EXPECT_EQ(Differences(before(elsewhere), after(elsewhere)), 0);
}

TEST_F(PictureTest, DrawsAScenesDepthWhereItHasNoColour) {
  RgbdImage image = GreyImage();
  image.colour.clear();
  image.depth_m[0] = 0;
  EXPECT_EQ(DrawOver(image, {}).size(), cv::Size(1280, 960));
}

TEST_F(PictureTest, SurvivesObjectsThatTheImageDoesNotShow) {
  std::vector<SceneObjectFit> objects(40);
  for (auto& object : objects) object.title = "same place";
  objects[0].estimate.fit.shape.X_FO.translation() = Eigen::Vector3d(0, 0, -2);
  objects[1].estimate.fit.shape.X_FO.translation() = Eigen::Vector3d(50, 0, 1);
  EXPECT_FALSE(DrawOver(GreyImage(), objects).empty());
}

TEST_F(PictureTest, RefusesAnImageWithoutItsPixels) {
  RgbdImage image = GreyImage();
  image.depth_m.pop_back();
  EXPECT_FALSE(DrawScene(path_, image, {}, gripper_));
  EXPECT_FALSE(DrawScene(path_, RgbdImage{}, {}, gripper_));
}

TEST(PictureViews, SeeTheSideThatTheCameraDoesNot) {
  const Eigen::Vector3d target(0, 0, 1), up(0, -1, 0);
  const PictureView side = SideView(Eigen::Vector3d::Zero(), target, up);
  EXPECT_NEAR((side.eye_F() - target).dot(target), 0, 1e-9) << "not a quarter turn";
  EXPECT_NEAR((side.eye_F() - target).norm(), 1, 1e-9);
  PictureView zoomed = side;
  const Eigen::Vector3d front(0, 0, 0.9), back(0, 0, 1.1);
  ZoomTo({front, back}, {10, 20, 100, 80}, &zoomed);
  EXPECT_NEAR(zoomed.At(front)->x, 10, 1e-6);
  EXPECT_NEAR(zoomed.At(back)->x, 110, 1e-6);
  EXPECT_NEAR(zoomed.At(back)->y, 60, 1e-6);
}

TEST(PictureViews, KnowWhatAShapeHides) {
  const Superquadric ball = MakeShape({0.1, 0.1, 0.1}, 1, 1, {0, 0, 1});
  const Eigen::Vector3d eye = Eigen::Vector3d::Zero();
  EXPECT_TRUE(Hides(ball, eye, {0, 0, 1.2}));
  EXPECT_TRUE(Hides(ball, eye, {0, 0, 1}));
  EXPECT_FALSE(Hides(ball, eye, {0, 0, 0.8}));
  EXPECT_FALSE(Hides(ball, eye, {0.15, 0, 1}));
}

TEST(PictureColours, GrowLighterWithTheDistance) {
  double last = -1;
  for (int i = 0; i <= 10; ++i) {
    const Colour c = DistanceColour(kFarDistance_m * i / 10);
    const double lightness = 0.114 * c[0] + 0.587 * c[1] + 0.299 * c[2];
    EXPECT_GT(lightness, last);
    last = lightness;
  }
  EXPECT_EQ(DistanceColour(1), DistanceColour(kFarDistance_m));
  EXPECT_EQ(DistanceColour(std::numeric_limits<double>::quiet_NaN()),
            DistanceColour(kFarDistance_m));
}

}  // namespace
}  // namespace beckon::pose
