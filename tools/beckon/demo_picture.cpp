#include "tools/beckon/demo_picture.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "lcmtypes/frame_image.h"
#include "tools/beckon/demo_view.h"
#include "tools/beckon/picture_pen.h"

namespace beckon::tool {
namespace {

constexpr int kImageWidth = 800 * kFine;  // px
constexpr int kPanelWidth = 440 * kFine;
constexpr int kMargin = 22 * kFine;
const cv::Scalar kPaper(250, 250, 250), kFaint(140, 130, 122), kGreen(60, 130, 20),
    kRed(50, 50, 190), kBlue(160, 80, 20);

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

void AddConversation(const SessionRecord& session, const std::map<int, int>& numbers,
                     Panel& panel) {
  const Pen question{15, kInk, 1};
  const int indent = 24 * kFine;
  for (const auto& given : session.answers) {
    std::string text = given.question;
    if (const auto number = numbers.find(given.object_id); number != numbers.end())
      text += " (number " + std::to_string(number->second) + ")";
    panel.Add(question, text);
    const auto colour = given.answer == "Yes" ? kGreen : given.answer == "No" ? kRed : kBlue;
    panel.Add({15, colour, 1}, given.answer, indent);
    panel.Space(9);
  }
}

cv::Mat DrawPanel(const DemoStory& story, int height) {
  Panel panel;
  panel.Add({20, kInk, 1}, "What is wanted?");
  panel.Space(8);
  panel.Rule();
  const auto& sessions = story.sessions();
  if (sessions.empty()) return panel.Finish(height);
  const SessionRecord& first = sessions.front();
  AddConversation(first, NumbersFromLeft(*story.scene()), panel);
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
  cv::Mat left = DrawView(*image, story, kImageWidth);
  const cv::Mat right = DrawPanel(story, left.rows);
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
