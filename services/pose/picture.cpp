// Pictures of fits: points and wireframes as the camera saw them.
#include "services/pose/picture.h"

#include <algorithm>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "services/pose/surface.h"

namespace beckon::pose {
namespace {

constexpr int kWidth = 320, kHeight = 240, kMargin_px = 24, kTilesPerRow = 4;
constexpr size_t kMaxTiles = 64;
constexpr double kNearest_m = 1e-3;
const cv::Scalar kPaper(255, 255, 255), kPoint(150, 140, 130), kInk(40, 40, 40);
const cv::Scalar kConverged(60, 150, 0), kDoubtful(0, 110, 230);  // blue green red

using Line = std::vector<Eigen::Vector3d>;

// Seven circles of latitude and twelve meridians.
std::vector<Line> Wireframe(const Superquadric& shape) {
  constexpr int kSegments = 72, kCircles = 7, kMeridians = 12;
  constexpr double kPi = std::numbers::pi;
  std::vector<Line> lines;
  for (int i = 1; i <= kCircles; ++i) {
    Line& line = lines.emplace_back();
    const double latitude = kPi * (static_cast<double>(i) / (kCircles + 1) - 0.5);
    for (int k = 0; k <= kSegments; ++k) {
      line.push_back(SurfacePoint(shape, latitude, 2 * kPi * k / kSegments));
    }
  }
  for (int i = 0; i < kMeridians; ++i) {
    Line& line = lines.emplace_back();
    for (int k = 0; k <= kSegments / 2; ++k) {
      const double latitude = kPi * (2.0 * k / kSegments - 0.5);
      line.push_back(SurfacePoint(shape, latitude, 2 * kPi * i / kMeridians));
    }
  }
  return lines;
}

// Where a tile's pixels are on the plane of x/z and y/z.
struct View {
  Eigen::Vector2d middle;
  double px_per_unit;

  cv::Point2d At(const Eigen::Vector3d& p) const {
    const Eigen::Vector2d q = (p.head<2>() / p.z() - middle) * px_per_unit;
    return {q.x() + kWidth / 2.0, q.y() + kHeight / 2.0};
  }
};

bool InFront(const Eigen::Vector3d& p) { return p.allFinite() && p.z() > kNearest_m; }

View ViewOf(const std::vector<Eigen::Vector3f>& points, const std::vector<Line>& lines) {
  Eigen::Array2d lo(1e9, 1e9), hi(-1e9, -1e9);
  const auto include = [&](const Eigen::Vector3d& p) {
    if (!InFront(p)) return;
    lo = lo.min(p.head<2>().array() / p.z());
    hi = hi.max(p.head<2>().array() / p.z());
  };
  for (const auto& p : points) include(p.cast<double>());
  for (const Line& line : lines) std::for_each(line.begin(), line.end(), include);
  if ((hi < lo).any()) return {Eigen::Vector2d::Zero(), 525};
  const Eigen::Array2d size = (hi - lo).max(1e-6);
  return {(0.5 * (lo + hi)).matrix(),
          std::min((kWidth - 2 * kMargin_px) / size.x(), (kHeight - 2 * kMargin_px) / size.y())};
}

void DrawTile(cv::Mat tile, const Portrait& portrait) {
  constexpr int kShift = 4;  // fractional bits of coordinates
  const std::vector<Line> lines = Wireframe(portrait.shape_C);
  const View view = ViewOf(portrait.points_C, lines);
  for (const auto& p : portrait.points_C) {
    if (InFront(p.cast<double>()))
      cv::circle(tile, view.At(p.cast<double>()), 1, kPoint, cv::FILLED);
  }
  for (const Line& line : lines) {
    for (size_t i = 1; i < line.size(); ++i) {
      if (!InFront(line[i - 1]) || !InFront(line[i])) continue;
      cv::line(tile, view.At(line[i - 1]) * (1 << kShift), view.At(line[i]) * (1 << kShift),
               portrait.converged ? kConverged : kDoubtful, 1, cv::LINE_AA, kShift);
    }
  }
  cv::putText(tile, portrait.title, {6, 14}, cv::FONT_HERSHEY_SIMPLEX, 0.4, kInk, 1, cv::LINE_AA);
}

}  // namespace

Status DrawPortraits(const std::string& path, const std::vector<Portrait>& portraits) {
  const int count = static_cast<int>(std::min(portraits.size(), kMaxTiles));
  const int columns = std::clamp(count, 1, kTilesPerRow);
  const int rows = std::max((count + columns - 1) / columns, 1);
  cv::Mat picture(rows * kHeight, columns * kWidth, CV_8UC3, kPaper);
  for (int i = 0; i < count; ++i) {
    DrawTile(picture(cv::Rect((i % columns) * kWidth, (i / columns) * kHeight, kWidth, kHeight)),
             portraits[static_cast<size_t>(i)]);
  }
  bool written = false;
  try {
    written = cv::imwrite(path, picture);
  } catch (const cv::Exception&) {  // an extension that is no image's
  }
  if (!written) return Error{path + ": cannot be written; expected the name of a .png file"};
  return {};
}

}  // namespace beckon::pose
