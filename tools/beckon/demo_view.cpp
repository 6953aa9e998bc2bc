#include "tools/beckon/demo_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "tools/beckon/picture_pen.h"

namespace beckon::tool {
namespace {

using Polygon = std::vector<cv::Point>;

/// Colours that stay apart for neighbouring numbers (multiples of the golden angle).
cv::Scalar ColourOf(int number) {
  cv::Mat hsv(1, 1, CV_8UC3, cv::Scalar((number * 68 + 20) % 180, 190, 255)), bgr;
  cv::cvtColor(hsv, bgr, cv::COLOR_HSV2BGR);
  const auto& c = bgr.at<cv::Vec3b>(0, 0);
  return {static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])};
}

cv::Mat ToMat(const RgbdImage& image) {
  cv::Mat canvas(image.height, image.width, CV_8UC3);
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const size_t i = image.Index(u, v);
      const auto grey = cv::saturate_cast<uint8_t>(255 - 80 * image.depth_m[i]);
      const Rgb c = image.colour.empty() ? Rgb{grey, grey, grey} : image.colour[i];
      canvas.at<cv::Vec3b>(v, u) = {c[2], c[1], c[0]};
    }
  }
  return canvas;
}

/// The camera's image with what is drawn over it.
class View {
 public:
  View(const RgbdImage& image, const DemoStory& story, int width_px)
      : story_(story),
        scene_(*story.scene()),
        intrinsics_(image.intrinsics),
        zoom_(static_cast<double>(width_px) / image.width),
        numbers_(NumbersFromLeft(scene_)) {
    cv::Mat calm;
    cv::medianBlur(ToMat(image), calm, 3);
    cv::resize(calm, canvas_, {}, zoom_, zoom_, cv::INTER_LINEAR);
  }

  cv::Mat Draw() {
    for (const auto& pose : story_.poses()) DrawSuperquadric(pose);
    for (const auto& object : scene_.objects) DrawOutline(object);
    const auto& sessions = story_.sessions();
    if (!sessions.empty() && sessions[0].task && sessions[0].task->has_pose &&
        !sessions[0].task->pose.grasps.empty()) {
      DrawGrasp(sessions[0].task->pose.grasps.front());
    }
    for (const auto& object : scene_.objects) DrawName(object);
    return canvas_;
  }

 private:
  /// 0 for an object that is not there.
  int NumberOf(int object_id) const {
    const auto found = numbers_.find(object_id);
    return found == numbers_.end() ? 0 : found->second;
  }

  cv::Point Project(const Eigen::Vector3d& p_W) const {
    const Eigen::Vector3d p_C = scene_.X_WC.inverse() * p_W;
    const Eigen::Vector2d uv = intrinsics_.Project(p_C);
    return {cvRound((uv.x() + 0.5) * zoom_), cvRound((uv.y() + 0.5) * zoom_)};
  }

  /// Circles of latitude and longitude of Solina and Bajcsy's parametric form, where they face the
  /// camera.
  void DrawSuperquadric(const msg::ObjectPose& pose) {
    const int number = NumberOf(pose.object_id);
    if (number == 0 || !pose.converged) return;
    constexpr int kSteps = 96;
    const double pi = std::numbers::pi;
    for (int ring = -1; ring <= 1; ++ring)
      DrawCurve(pose, number, kSteps,
                [&](double t) { return std::pair(ring * pi / 4, -pi + 2 * pi * t); });
    for (int k = 0; k < 8; ++k)
      DrawCurve(pose, number, kSteps,
                [&](double t) { return std::pair(-pi / 2 + pi * t, -pi + k * pi / 4); });
  }

  template <typename Curve>
  void DrawCurve(const msg::ObjectPose& pose, int number, int steps, Curve curve) {
    const Eigen::Vector3d eye_W = scene_.X_WC.translation();
    std::optional<cv::Point> last;
    for (int i = 0; i <= steps; ++i) {
      const auto [eta, omega] = curve(static_cast<double>(i) / steps);
      const auto [p_O, n_O] = Surface(pose, eta, omega);
      const Eigen::Vector3d p_W = pose.X_WO * p_O;
      const bool faces = (pose.X_WO.linear() * n_O).dot(eye_W - p_W) > 0;
      const cv::Point at = Project(p_W);
      if (faces && last) cv::line(canvas_, *last, at, ColourOf(number), 1, cv::LINE_AA);
      last = faces ? std::optional(at) : std::nullopt;
    }
  }

  /// A point and an outward direction (eq. 2.10 of Solina and Bajcsy, tapering left out of the
  /// direction).
  static std::pair<Eigen::Vector3d, Eigen::Vector3d> Surface(const msg::ObjectPose& pose,
                                                             double eta, double omega) {
    const auto power = [](double x, double e) {
      return std::copysign(std::pow(std::abs(x), e), x);
    };
    const auto& a = pose.semi_axes;
    const double e1 = pose.epsilon[0], e2 = pose.epsilon[1];
    const double ce = std::cos(eta), se = std::sin(eta), co = std::cos(omega), so = std::sin(omega);
    Eigen::Vector3d p(a[0] * power(ce, e1) * power(co, e2), a[1] * power(ce, e1) * power(so, e2),
                      a[2] * power(se, e1));
    p.x() *= pose.taper[0] * p.z() / a[2] + 1;
    p.y() *= pose.taper[1] * p.z() / a[2] + 1;
    return {p,
            {power(ce, 2 - e1) * power(co, 2 - e2) / a[0],
             power(ce, 2 - e1) * power(so, 2 - e2) / a[1], power(se, 2 - e1) / a[2]}};
  }

  Polygon Outline(const msg::SceneObject& object) const {
    Polygon polygon;
    for (const auto& [u, v] : object.outline_px)
      polygon.emplace_back(cvRound((u + 0.5) * zoom_), cvRound((v + 0.5) * zoom_));
    return polygon;
  }

  void DrawOutline(const msg::SceneObject& object) {
    if (object.outline_px.empty()) return;
    cv::polylines(canvas_, Outline(object), true, ColourOf(NumberOf(object.id)), 2 * kFine,
                  cv::LINE_AA);
  }

  /// Two fingers, the palm and the wrist: a fork.
  void DrawGrasp(const msg::Grasp& grasp) {
    constexpr double kFinger_m = 0.05, kWrist_m = 0.05;
    const double half = grasp.opening_m / 2;
    const auto line = [&](const Eigen::Vector3d& from_G, const Eigen::Vector3d& to_G) {
      const cv::Point from = Project(grasp.X_WG * from_G), to = Project(grasp.X_WG * to_G);
      cv::line(canvas_, from, to, kInk, 5 * kFine, cv::LINE_AA);
      cv::line(canvas_, from, to, kWhite, 3 * kFine, cv::LINE_AA);
    };
    line({0, 0, -kFinger_m - kWrist_m}, {0, 0, -kFinger_m});
    line({-half, 0, -kFinger_m}, {half, 0, -kFinger_m});
    for (const double x : {-half, half}) line({x, 0, -kFinger_m}, {x, 0, 0});
  }

  /// Beside the object, where it covers least of other names and objects.
  void DrawName(const msg::SceneObject& object) {
    if (object.outline_px.empty()) return;
    const int number = NumberOf(object.id);
    const std::string name =
        std::to_string(number) + " " + object.category + (object.ask_user ? "?" : "");
    const Pen pen{14, kInk, 1};
    const cv::Size text = pen.Measure(name);
    const cv::Size size(text.width + 12 * kFine, text.height + 7 * kFine);
    const cv::Rect frame = PlaceFor(size, object);
    names_.push_back(frame);
    cv::rectangle(canvas_, frame, ColourOf(number), cv::FILLED);
    pen.Write(canvas_, name, {frame.x + 6 * kFine, frame.y + 5 * kFine});
  }

  cv::Rect PlaceFor(const cv::Size& size, const msg::SceneObject& object) const {
    constexpr int kGap = 4 * kFine;
    const cv::Rect box = cv::boundingRect(Outline(object));
    const int middle_x = box.x + (box.width - size.width) / 2;
    const int middle_y = box.y + (box.height - size.height) / 2;
    const cv::Point above(middle_x, box.y - size.height - kGap), below(middle_x, box.br().y + kGap),
        right(box.br().x + kGap, middle_y), left(box.x - size.width - kGap, middle_y);
    cv::Rect best;
    int least = std::numeric_limits<int>::max();
    for (const cv::Point& at : {above, below, right, left}) {
      const cv::Rect frame({std::clamp(at.x, 0, std::max(0, canvas_.cols - size.width)),
                            std::clamp(at.y, 0, std::max(0, canvas_.rows - size.height))},
                           size);
      int covered = 0;
      for (const auto& name : names_) covered += 4 * (frame & name).area();
      for (const auto& other : scene_.objects) {
        if (!other.outline_px.empty()) covered += (frame & cv::boundingRect(Outline(other))).area();
      }
      if (covered >= least) continue;
      least = covered;
      best = frame;
    }
    return best;
  }

  const DemoStory& story_;
  const msg::Scene& scene_;
  const Intrinsics intrinsics_;
  const double zoom_;
  const std::map<int, int> numbers_;  // by object id
  cv::Mat canvas_;
  std::vector<cv::Rect> names_;
};

}  // namespace

std::map<int, int> NumbersFromLeft(const msg::Scene& scene) {
  std::vector<const msg::SceneObject*> from_left;
  for (const auto& object : scene.objects) from_left.push_back(&object);
  std::ranges::stable_sort(from_left, {}, [](const auto* o) { return o->centroid_W.x(); });
  std::map<int, int> numbers;
  for (const auto* object : from_left) numbers.emplace(object->id, numbers.size() + 1);
  return numbers;
}

cv::Mat DrawView(const RgbdImage& image, const DemoStory& story, int width_px) {
  return View(image, story, width_px).Draw();
}

}  // namespace beckon::tool
