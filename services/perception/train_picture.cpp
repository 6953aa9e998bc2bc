// The confusion matrix as a picture.
#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

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
  bool written = false;
  try {
    written = cv::imwrite(path, picture);
  } catch (const cv::Exception&) {  // an extension OpenCV does not know
  }
  if (!written)
    return Error{path + ": cannot write the picture; expected a .png in a folder that exists"};
  return {};
}

}  // namespace beckon::perception
