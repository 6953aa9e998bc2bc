// The confusion matrix and two curves as pictures.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "services/perception/train_figures.h"
#include "services/perception/train_report.h"

namespace beckon::perception {
namespace {

constexpr int kCell_px = 56;
constexpr int kMargin_px = 110;
const cv::Scalar kInk(40, 40, 40);

void Write(cv::Mat& picture, const std::string& text, cv::Point middle, double size,
           const cv::Scalar& colour) {
  int baseline = 0;
  const cv::Size box = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size, 1, &baseline);
  cv::putText(picture, text, middle + cv::Point(-box.width / 2, box.height / 2),
              cv::FONT_HERSHEY_SIMPLEX, size, colour, 1, cv::LINE_AA);
}

Status Save(const cv::Mat& picture, const std::string& path) {
  bool written = false;
  try {
    written = cv::imwrite(path, picture);
  } catch (const cv::Exception&) {  // an extension OpenCV does not know
  }
  if (!written)
    return Error{path + ": cannot write the picture; expected a .png in a folder that exists"};
  return {};
}

/// A square of 0..1 by low_..1 to draw in.
class Chart {
 public:
  Chart(const std::string& title, const std::string& across, const std::string& upwards, double low)
      : low_(low), picture_(kSide_px + 130, kSide_px + 120, CV_8UC3, cv::Scalar(255, 255, 255)) {
    Write(picture_, title, {picture_.cols / 2, 24}, 0.55, kInk);
    Write(picture_, across, {picture_.cols / 2, kSide_px + 110}, 0.45, kInk);
    Write(picture_, upwards, {60, 46}, 0.45, kInk);
    for (int i = 0; i <= 5; ++i) {
      const double at = 0.2 * i, level = low + (1 - low) * at;
      cv::line(picture_, At(at, low), At(at, 1), cv::Scalar(225, 225, 225));
      cv::line(picture_, At(0, level), At(1, level), cv::Scalar(225, 225, 225));
      Write(picture_, Digits(at), At(at, low) + cv::Point(0, 18), 0.4, kInk);
      Write(picture_, Digits(level), At(0, level) - cv::Point(26, 0), 0.4, kInk);
    }
  }
  void Line(double x0, double y0, double x1, double y1, const cv::Scalar& colour, int width) {
    cv::line(picture_, At(x0, y0), At(x1, y1), colour, width, cv::LINE_AA);
  }
  void Dot(double x, double y, const cv::Scalar& colour) {
    cv::circle(picture_, At(x, y), 5, colour, cv::FILLED, cv::LINE_AA);
  }
  void Note(double x, double y, const std::string& text) {
    Write(picture_, text, At(x, y), 0.45, kInk);
  }
  const cv::Mat& picture() const { return picture_; }

 private:
  static constexpr int kSide_px = 420;
  cv::Point At(double x, double y) const {
    const double up = std::clamp((y - low_) / (1 - low_), 0.0, 1.0);
    return {70 + static_cast<int>(kSide_px * x), 60 + static_cast<int>(kSide_px * (1 - up))};
  }
  static std::string Digits(double value) {
    char text[16];
    std::snprintf(text, sizeof(text), "%.2f", value);
    return text;
  }
  double low_;
  cv::Mat picture_;
};

const cv::Scalar kCurve(170, 90, 20), kFaint(170, 170, 170);

}  // namespace

Status DrawConfusions(const std::vector<Judgement>& judgements,
                      const std::vector<std::string>& categories, const std::string& path) {
  const auto counts = Confusions(judgements, categories.size());
  const int k = static_cast<int>(categories.size());
  const int side = kMargin_px + k * kCell_px + 20;
  cv::Mat picture(side, side, CV_8UC3, cv::Scalar(255, 255, 255));
  Write(picture, "is \\ taken for", {kMargin_px / 2, kMargin_px / 2}, 0.4, kInk);
  for (int row = 0; row < k; ++row) {
    const auto& line = counts[static_cast<size_t>(row)];
    int views = 0;
    for (const int count : line) views += count;
    const int y = kMargin_px + row * kCell_px;
    const std::string& name = categories[static_cast<size_t>(row)];
    Write(picture, name, {kMargin_px / 2, y + kCell_px / 2}, 0.45, kInk);
    Write(picture, name,
          {kMargin_px + row * kCell_px + kCell_px / 2, kMargin_px - 14 - 18 * (row % 2)}, 0.4,
          kInk);
    for (int column = 0; column < k; ++column) {
      const int count = line[static_cast<size_t>(column)];
      const double share = static_cast<double>(count) / std::max(1, views);
      const cv::Rect cell(kMargin_px + column * kCell_px, y, kCell_px, kCell_px);
      const double pale = 255 * (1 - share);
      picture(cell).setTo(row == column ? cv::Scalar(pale, 255 - 90 * share, pale)
                                        : cv::Scalar(pale, pale, 255 - 20 * share));
      cv::rectangle(picture, cell, cv::Scalar(210, 210, 210));
      if (count > 0) {
        Write(picture, std::to_string(count), (cell.tl() + cell.br()) / 2, 0.5, kInk);
      }
    }
  }
  return Save(picture, path);
}

Status DrawRiskCoverage(const std::vector<Judgement>& judgements, float threshold,
                        const std::string& path) {
  std::vector<Judgement> sorted = judgements;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Judgement& a, const Judgement& b) {
    return a.confidence > b.confidence;
  });
  std::vector<double> accuracy;
  int right = 0, answered = 0;
  for (const Judgement& j : sorted) {
    right += j.label == j.predicted;
    answered += j.confidence > threshold;
    accuracy.push_back(right / static_cast<double>(accuracy.size() + 1));
  }
  const double n = static_cast<double>(std::max<size_t>(1, sorted.size()));
  const double least = accuracy.empty() ? 0 : *std::min_element(accuracy.begin(), accuracy.end());
  Chart chart("Accuracy of the surest views", "share of the views (coverage)", "accuracy",
              std::floor(5 * std::min(least, 0.95)) / 5);
  for (size_t i = 1; i < accuracy.size(); ++i) {
    chart.Line(static_cast<double>(i) / n, accuracy[i - 1], static_cast<double>(i + 1) / n,
               accuracy[i], kCurve, 2);
  }
  if (answered > 0) {
    const double at = answered / n, level = accuracy[static_cast<size_t>(answered - 1)];
    chart.Dot(at, level, kCurve);
    chart.Note(std::min(at, 0.9), level + 0.02, "T");
  }
  return Save(chart.picture(), path);
}

Status DrawReliability(const std::vector<Judgement>& judgements, const std::string& path) {
  Chart chart("What is said with a probability, and comes true", "claimed probability", "accuracy",
              0);
  chart.Line(0, 0, 1, 1, kFaint, 1);
  const auto bins = Reliability(judgements);
  for (size_t i = 0; i < bins.size(); ++i) {
    chart.Line(bins[i].probability, bins[i].probability, bins[i].probability, bins[i].accuracy,
               kFaint, 2);
    chart.Dot(bins[i].probability, bins[i].accuracy, kCurve);
  }
  char text[64];
  std::snprintf(text, sizeof(text), "calibration error %.3f", CalibrationError(judgements));
  chart.Note(0.3, 0.95, text);
  return Save(chart.picture(), path);
}

}  // namespace beckon::perception
