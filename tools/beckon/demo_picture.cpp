#include "tools/beckon/demo_picture.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "lcmtypes/frame_image.h"

namespace beckon::tool {
namespace {

// Everything is drawn at twice its size and then made smaller: smooth lines and letters.
constexpr int kFine = 2;
constexpr int kImageWidth = 800 * kFine;  // px
constexpr int kPanelWidth = 440 * kFine;
constexpr int kMargin = 22 * kFine;
constexpr int kFont = cv::FONT_HERSHEY_DUPLEX;
const cv::Scalar kPaper(250, 250, 250), kInk(45, 38, 32), kFaint(140, 130, 122),
    kGreen(60, 130, 20), kRed(50, 50, 190), kBlue(160, 80, 20), kWhite(255, 255, 255);

using Polygon = std::vector<cv::Point>;

/// Letters of a height in px of the finished picture.
struct Pen {
  double height_px = 14;
  cv::Scalar colour = kInk;
  int thickness = 1;

  double scale() const { return height_px * kFine / 21.0; }
  cv::Size Measure(const std::string& text) const {
    int below = 0;
    cv::Size size = cv::getTextSize(text, kFont, scale(), thickness * kFine, &below);
    return {size.width, size.height + below};
  }
  void Write(cv::Mat& canvas, const std::string& text, cv::Point top_left) const {
    const int ascent = cv::getTextSize(text, kFont, scale(), thickness * kFine, nullptr).height;
    cv::putText(canvas, text, {top_left.x, top_left.y + ascent}, kFont, scale(), colour,
                thickness * kFine, cv::LINE_AA);
  }
};

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
  View(const RgbdImage& image, const DemoStory& story)
      : story_(story), scene_(*story.scene()), intrinsics_(image.intrinsics) {
    zoom_ = static_cast<double>(kImageWidth) / image.width;
    cv::Mat calm;
    cv::medianBlur(ToMat(image), calm, 3);
    cv::resize(calm, canvas_, {}, zoom_, zoom_, cv::INTER_LINEAR);
    std::vector<const msg::SceneObject*> from_left;
    for (const auto& object : scene_.objects) from_left.push_back(&object);
    std::ranges::stable_sort(from_left, {}, [](const auto* o) { return o->centroid_W.x(); });
    for (size_t i = 0; i < from_left.size(); ++i)
      numbers_[from_left[i]->id] = static_cast<int>(i) + 1;
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

  /// From left to right, as the console counts; 0 for an object that is not there.
  int NumberOf(int object_id) const {
    const auto found = numbers_.find(object_id);
    return found == numbers_.end() ? 0 : found->second;
  }

 private:
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
  double zoom_ = 1;
  cv::Mat canvas_;
  std::map<int, int> numbers_;  // by object id
  std::vector<cv::Rect> names_;
};

/// A column of text that grows downwards.
class Panel {
 public:
  Panel() : canvas_(4000 * kFine, kPanelWidth, CV_8UC3, kPaper) {}

  void Add(const Pen& pen, const std::string& text, int indent = 0) {
    const int width = kPanelWidth - 2 * kMargin - indent;
    std::string line;
    for (size_t at = 0; at < text.size();) {
      const size_t end = std::min(text.find(' ', at), text.size());
      const std::string word = text.substr(at, end - at);
      const std::string longer = line.empty() ? word : line + " " + word;
      if (!line.empty() && pen.Measure(longer).width > width) {
        AddLine(pen, line, indent);
        line = word;
      } else {
        line = longer;
      }
      at = end + 1;
    }
    if (!line.empty()) AddLine(pen, line, indent);
  }
  void Space(int px) { y_ += px * kFine; }
  void Rule() {
    cv::line(canvas_, {kMargin, y_}, {kPanelWidth - kMargin, y_}, {210, 205, 200}, kFine);
    Space(12);
  }
  /// Cut, or filled up with paper, to `height`.
  cv::Mat Finish(int height) const {
    return canvas_.rowRange(0, std::min(canvas_.rows, std::max(height, y_ + kMargin))).clone();
  }

 private:
  void AddLine(const Pen& pen, const std::string& line, int indent) {
    if (y_ + 100 * kFine > canvas_.rows) return;
    pen.Write(canvas_, line, {kMargin + indent, y_});
    y_ += cvRound(pen.height_px * 1.65 * kFine);
  }

  cv::Mat canvas_;
  int y_ = kMargin;
};

std::string Questions(size_t n) {
  return std::to_string(n) + (n == 1 ? " question" : " questions");
}

std::string Centimetres(double metres) { return std::to_string(std::lround(100 * metres)) + " cm"; }

/// "open the carton": the question that was accepted, as an order.
std::string Order(const SessionRecord& session) {
  std::string order = session.answers.empty() ? "" : session.answers.back().question;
  if (order.ends_with('?')) order.pop_back();
  if (!order.empty()) order[0] = static_cast<char>(std::tolower(order[0]));
  return order;
}

std::string Where(const msg::Task& task) {
  const Eigen::Vector3d p = task.has_pose ? task.pose.X_WO.translation() : task.centroid_W;
  std::string text = Centimetres(p.y()) + " ahead, " + Centimetres(std::abs(p.x())) +
                     (p.x() < 0 ? " to the left" : " to the right");
  if (task.has_pose && !task.pose.grasps.empty()) {
    text += ", fingers " + Centimetres(task.pose.grasps.front().opening_m) + " apart";
  }
  return text;
}

void AddConversation(const SessionRecord& session, const View& view, Panel& panel) {
  const Pen question{15, kInk, 1};
  const int indent = 24 * kFine;
  for (const auto& given : session.answers) {
    std::string text = given.question;
    if (const int number = view.NumberOf(given.object_id); number > 0)
      text += " (number " + std::to_string(number) + ")";
    panel.Add(question, text);
    const auto colour = given.answer == "Yes" ? kGreen : given.answer == "No" ? kRed : kBlue;
    panel.Add({15, colour, 1}, given.answer, indent);
    panel.Space(9);
  }
}

cv::Mat DrawPanel(const DemoStory& story, const View& view, int height) {
  Panel panel;
  panel.Add({20, kInk, 1}, "What is wanted?");
  panel.Space(8);
  panel.Rule();
  const auto& sessions = story.sessions();
  if (sessions.empty()) return panel.Finish(height);
  const SessionRecord& first = sessions.front();
  AddConversation(first, view, panel);
  panel.Rule();
  if (first.task) {
    panel.Add({17, kInk, 1}, "Task: " + Order(first));
    panel.Add({13, kFaint, 1}, Where(*first.task));
  } else {
    panel.Add({17, kRed, 1}, "No task: " + first.outcome);
  }
  if (sessions.size() > 1) {
    panel.Space(6);
    panel.Add({13, kFaint, 1},
              "The same wish again: " + Questions(sessions.back().answers.size()) + ".");
  }
  return panel.Finish(height);
}

Error NotWritten(const std::string& path) {
  return Error{"--picture " + path +
               ": cannot be written; is the folder there, and does the name end in .png or .jpg?"};
}

}  // namespace

Status CheckPicturePath(const std::string& path) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(path).parent_path();
  const std::string type = fs::path(path).extension();
  if ((type != ".png" && type != ".jpg") || (!folder.empty() && !fs::is_directory(folder)))
    return NotWritten(path);
  return {};
}

Status WriteDemoPicture(const std::string& path, const DemoStory& story) {
  if (!story.scene() || !story.frame())
    return Error{"--picture " + path + ": nothing was asked, so there is nothing to draw"};
  auto image = DecodeImage(*story.frame());
  if (!image) return image.error();
  View view(*image, story);
  cv::Mat left = view.Draw();
  const cv::Mat right = DrawPanel(story, view, left.rows);
  cv::copyMakeBorder(left, left, 0, std::max(0, right.rows - left.rows), 0, 0, cv::BORDER_CONSTANT,
                     kPaper);
  cv::Mat both, picture;
  cv::hconcat(left, right, both);
  cv::resize(both, picture, {}, 1.0 / kFine, 1.0 / kFine, cv::INTER_AREA);
  try {
    if (!cv::imwrite(path, picture, {cv::IMWRITE_PNG_COMPRESSION, 9})) return NotWritten(path);
  } catch (const cv::Exception&) {
    return NotWritten(path);
  }
  return {};
}

}  // namespace beckon::tool
