// A picture of a whole scene: the camera's image with every object's fit over it.
#include "services/pose/picture_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>

#include "services/pose/picture_grasp.h"
#include "services/pose/picture_shape.h"

namespace beckon::pose {
namespace {

constexpr double kWidth_px = 1280;  // at least, for letters and lines to be fine
const Colour kPaper(255, 255, 255), kInk(30, 26, 22);

cv::Mat Picture(const RgbdImage& image) {
  constexpr double kNear_m = 0.4, kFar_m = 2.5;
  cv::Mat picture(image.height, image.width, CV_8UC3);
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const size_t i = image.Index(u, v);
      const double depth = std::clamp<double>(image.depth_m[i], kNear_m, kFar_m);
      const auto grey = cv::saturate_cast<uint8_t>(
          image.depth_m[i] > 0 ? 235 - 170 * (depth - kNear_m) / (kFar_m - kNear_m) : 40);
      const Rgb c = image.colour.empty() ? Rgb{grey, grey, grey} : image.colour[i];
      picture.at<cv::Vec3b>(v, u) = {c[2], c[1], c[0]};
    }
  }
  return picture;
}

std::span<const Superquadric> Shapes(const FitResult& fit) {
  if (!fit.parts.empty()) return fit.parts;
  return {&fit.shape, 1};
}

/// The scene being drawn: lines first, then labels where room is left.
class ScenePicture {
 public:
  ScenePicture(const RgbdImage& image, std::span<const SceneObjectFit> objects,
               const GripperConfig& gripper)
      : objects_(objects),
        gripper_(gripper),
        zoom_(std::max(1.0, std::ceil(kWidth_px / image.width))),
        canvas_(Picture(image), zoom_) {
    const Intrinsics& camera = image.intrinsics;
    view_.focal_px = Eigen::Array2d(camera.fx, camera.fy) * zoom_;
    // A pixel's centre, not its corner, has integer coordinates.
    view_.centre_px = (Eigen::Array2d(camera.cx, camera.cy) + 0.5) * zoom_;
    for (const auto& object : objects_) boxes_.push_back(BoxOf(object));
  }

  cv::Mat Draw() {
    canvas_.Blend(canvas_.White(), 0.25);  // lines stand out against a paler image
    const std::vector<size_t> order = FarthestFirst();
    Canvas hidden = canvas_.Copy();
    for (const size_t i : order) DrawWires(i, Sight::kHidden, &hidden);
    canvas_.Blend(hidden, 0.4);
    for (const size_t i : order) DrawWires(i, Sight::kVisible, &canvas_);
    for (const size_t i : order) {
      const Estimate& estimate = objects_[i].estimate;
      if (!estimate.grasps.empty())
        DrawGrasp(estimate.grasps.front(), gripper_, estimate.fit.shape, view_, &canvas_);
      if (estimate.fit.converged) DrawAxes(estimate.fit.shape, view_, 12, &canvas_);
    }
    for (size_t i = 0; i < objects_.size(); ++i) DrawLabel(i);
    return canvas_.Finished();
  }

 private:
  double Distance(size_t i) const {
    return objects_[i].estimate.fit.shape.X_FO.translation().norm();
  }

  std::vector<size_t> FarthestFirst() const {
    std::vector<size_t> order(objects_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return Distance(a) > Distance(b); });
    return order;
  }

  void DrawWires(size_t i, Sight sight, Canvas* canvas) const {
    const FitResult& fit = objects_[i].estimate.fit;
    const double width = sight == Sight::kVisible ? 1.5 : 1.0;
    const std::vector<Superquadric> in_front = InFrontOf(i);
    for (const auto& shape : Shapes(fit)) {
      if (fit.converged && sight == Sight::kVisible)  // a dark rim, seen on any ground
        DrawWireframe(shape, view_, sight, {kInk, width + 1.2, false}, canvas, in_front);
      DrawWireframe(shape, view_, sight, {DistinctColour(i), width, !fit.converged}, canvas,
                    in_front);
    }
  }

  /// What may hide an object: the shapes of nearer ones that it meets in the picture.
  std::vector<Superquadric> InFrontOf(size_t i) const {
    std::vector<Superquadric> in_front;
    for (size_t k = 0; k < objects_.size(); ++k) {
      const FitResult& fit = objects_[k].estimate.fit;
      if (k == i || !fit.converged || Distance(k) >= Distance(i)) continue;
      if ((boxes_[k] & boxes_[i]).empty()) continue;
      in_front.insert(in_front.end(), Shapes(fit).begin(), Shapes(fit).end());
    }
    return in_front;
  }

  /// Around all that is drawn of an object, letters too; empty where nothing of it is in front of
  /// the camera.
  cv::Rect2d BoxOf(const SceneObjectFit& object) const {
    constexpr double kLetter_px = 20;
    std::vector<Eigen::Vector3d> points;
    const auto add = [&](const std::vector<Eigen::Vector3d>& more) {
      points.insert(points.end(), more.begin(), more.end());
    };
    for (const auto& shape : Shapes(object.estimate.fit)) add(Extremes(shape));
    if (!object.estimate.grasps.empty()) add(Extremes(object.estimate.grasps.front(), gripper_));
    Eigen::Array2d lo(1e9, 1e9), hi(-1e9, -1e9);
    for (const auto& p : points) {
      const auto px = view_.At(p);
      if (!px) continue;
      lo = lo.min(Eigen::Array2d(px->x, px->y) - kLetter_px);
      hi = hi.max(Eigen::Array2d(px->x, px->y) + kLetter_px);
    }
    if ((hi < lo).any()) return {};
    return {lo.x(), lo.y(), hi.x() - lo.x(), hi.y() - lo.y()};
  }

  void DrawLabel(size_t i) {
    constexpr double kTitle_px = 13, kSize_px = 10, kPad_px = 5;
    if (boxes_[i].empty()) return;
    const FitResult& fit = objects_[i].estimate.fit;
    char size[80] = "not converged";
    if (fit.converged) {
      const Eigen::Vector3d whole_mm = 2000 * fit.shape.semi_axes;
      std::snprintf(size, sizeof size, "%.0f x %.0f x %.0f mm%s", whole_mm.x(), whole_mm.y(),
                    whole_mm.z(), fit.ambiguous ? ", ambiguous" : "");
    }
    const std::string title = Canvas::Fitted(objects_[i].title, kTitle_px, 220);
    const double width =
        std::max(Canvas::TextWidth(title, kTitle_px), Canvas::TextWidth(size, kSize_px));
    const cv::Rect2d label = PlaceFor({width + 2 * kPad_px + 4, 36}, i);
    labels_.push_back(label);
    const auto corners = [](const cv::Rect2d& r) {
      return PicturePolygon{r.tl(), {r.x + r.width, r.y}, r.br(), {r.x, r.y + r.height}};
    };
    canvas_.Fill(corners(label), kPaper);
    canvas_.Fill(corners({label.x, label.y, 4, label.height}), DistinctColour(i));
    canvas_.Text(title, {label.x + 4 + kPad_px, label.y + 16}, kTitle_px, kInk);
    canvas_.Text(size, {label.x + 4 + kPad_px, label.y + 30}, kSize_px, Lighter(kInk, 0.3));
  }

  /// Above, below or beside the object: where it covers least of other labels and of objects.
  cv::Rect2d PlaceFor(const cv::Size2d& size, size_t i) const {
    constexpr double kGap_px = 0;
    const cv::Rect2d& box = boxes_[i];
    const double middle_x = box.x + (box.width - size.width) / 2;
    const double middle_y = box.y + (box.height - size.height) / 2;
    const double above = box.y - size.height - kGap_px, below = box.br().y + kGap_px;
    const double left = box.x - size.width - kGap_px, right = box.br().x + kGap_px;
    cv::Rect2d best;
    double least = std::numeric_limits<double>::max();
    for (const cv::Point2d& at : std::initializer_list<cv::Point2d>{{middle_x, above},
                                                                    {middle_x, below},
                                                                    {right, middle_y},
                                                                    {left, middle_y},
                                                                    {left, above},
                                                                    {right, above},
                                                                    {left, below},
                                                                    {right, below},
                                                                    {middle_x, middle_y},
                                                                    {middle_x, above - 40},
                                                                    {middle_x, below + 40}}) {
      const cv::Rect2d place(
          {std::clamp(at.x, 0.0, std::max(0.0, canvas_.width_px() - size.width)),
           std::clamp(at.y, 0.0, std::max(0.0, canvas_.height_px() - size.height))},
          size);
      double covered = 0;
      for (const auto& label : labels_) covered += 10 * (place & label).area();
      for (const auto& other : boxes_) covered += (place & other).area();
      if (covered >= least) continue;
      least = covered;
      best = place;
    }
    return best;
  }

  std::span<const SceneObjectFit> objects_;
  const GripperConfig& gripper_;
  double zoom_;
  Canvas canvas_;
  PictureView view_;
  std::vector<cv::Rect2d> boxes_;   // px, one an object
  std::vector<cv::Rect2d> labels_;  // px, those that are placed
};

}  // namespace

Status DrawScene(const std::string& path, const RgbdImage& image,
                 std::span<const SceneObjectFit> objects, const GripperConfig& gripper) {
  const size_t pixels = static_cast<size_t>(std::max(image.width, 0)) *
                        static_cast<size_t>(std::max(image.height, 0));
  if (pixels == 0 || image.depth_m.size() != pixels ||
      (!image.colour.empty() && image.colour.size() != pixels)) {
    return Error{path + ": no picture: expected an image with depth (and colour) at each of its " +
                 std::to_string(pixels) + " pixels, found " + std::to_string(image.depth_m.size()) +
                 " and " + std::to_string(image.colour.size())};
  }
  return WritePicture(path, ScenePicture(image, objects, gripper).Draw());
}

}  // namespace beckon::pose
