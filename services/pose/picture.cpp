// Pictures of fits: every cloud as the camera saw it and from the side that the camera did not see.
#include "services/pose/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <span>

#include "services/pose/picture_grasp.h"
#include "services/pose/picture_shape.h"

namespace beckon::pose {
namespace {

constexpr int kHeader_px = 50, kFooter_px = 20, kTilesPerRow = 4;
constexpr double kMargin_px = 20;
const Colour kPaper(255, 255, 255), kInk(40, 36, 32), kFaint(120, 112, 105), kRule(225, 220, 215);
const Colour kWire(60, 52, 40), kDoubtful(0, 94, 213), kAlternative(115, 158, 0);

std::span<const Superquadric> Shapes(const FitResult& fit) {
  if (!fit.parts.empty()) return fit.parts;
  return {&fit.shape, 1};
}

Eigen::Vector3d UpOf(const Portrait& portrait) {
  if (!portrait.table_F) return -Eigen::Vector3d::UnitY();
  const bool above = portrait.table_F->Distance(portrait.viewpoint_F) >= 0;
  return above ? portrait.table_F->normal : Eigen::Vector3d(-portrait.table_F->normal);
}

/// One panel of a tile.
class Panel {
 public:
  Panel(const Portrait& portrait, const GripperConfig& gripper, PictureView view, Canvas canvas)
      : portrait_(portrait),
        fit_(portrait.estimate.fit),
        gripper_(gripper),
        view_(view),
        canvas_(canvas) {
    std::vector<Eigen::Vector3d> shown = WithoutStrays(portrait.points_F);
    const auto add = [&](const std::vector<Eigen::Vector3d>& points) {
      shown.insert(shown.end(), points.begin(), points.end());
    };
    add(Extremes(fit_.shape));
    for (const auto& shape : fit_.parts) add(Extremes(shape));
    for (const auto& shape : fit_.alternatives) add(Extremes(shape));
    if (const auto* grasp = BestGrasp()) add(Extremes(*grasp, gripper));
    ZoomTo(shown,
           {kMargin_px, kMargin_px, canvas_.width_px() - 2 * kMargin_px,
            canvas_.height_px() - 2 * kMargin_px},
           &view_);
  }

  void Draw() {
    if (portrait_.table_F) {
      const double radius_m = 1.7 * fit_.shape.semi_axes.maxCoeff() + kGrid_m;
      DrawTable(*portrait_.table_F, fit_.shape.X_FO.translation(), radius_m, view_, &canvas_);
    }
    DrawLayer(Sight::kHidden);
    DrawLayer(Sight::kVisible);
    for (const auto& shape : fit_.alternatives)
      DrawWireframe(shape, view_, Sight::kVisible, {kAlternative, 1, true}, &canvas_);
    if (const auto* grasp = BestGrasp()) DrawGrasp(*grasp, gripper_, fit_.shape, view_, &canvas_);
    DrawAxes(fit_.shape, view_, 12, &canvas_);
  }

 private:
  const GraspCandidate* BestGrasp() const {
    return portrait_.estimate.grasps.empty() ? nullptr : &portrait_.estimate.grasps.front();
  }

  void DrawLayer(Sight sight) {
    DrawPoints(portrait_.points_F, Shapes(fit_), view_, sight, &canvas_);
    for (size_t i = 0; i < Shapes(fit_).size(); ++i) {
      const Colour colour = !fit_.converged      ? kDoubtful
                            : fit_.parts.empty() ? kWire
                                                 : DistinctColour(i);
      const bool hidden = sight == Sight::kHidden;
      DrawWireframe(Shapes(fit_)[i], view_, sight,
                    {hidden ? Lighter(colour, 0.65) : colour, hidden ? 0.6 : 1.0}, &canvas_);
    }
  }

  const Portrait& portrait_;
  const FitResult& fit_;
  const GripperConfig& gripper_;
  PictureView view_;
  Canvas canvas_;
};

std::string Verdict(const FitResult& fit) {
  if (!fit.converged) return "not converged";
  std::string verdict;
  if (!fit.parts.empty()) verdict = std::to_string(fit.parts.size()) + " parts";
  if (fit.ambiguous) verdict += verdict.empty() ? "ambiguous" : ", ambiguous";
  return verdict;
}

void DrawHeader(const Portrait& portrait, Canvas* tile) {
  const FitResult& fit = portrait.estimate.fit;
  const double width = tile->width_px() - 24;
  const std::string verdict = Verdict(fit);
  const double verdict_width = Canvas::TextWidth(verdict, 12);
  tile->Text(Canvas::Fitted(portrait.title, 14, width - verdict_width - 16), {12, 22}, 14, kInk);
  tile->Text(verdict, {12 + width - verdict_width, 22}, 12,
             fit.converged && !fit.ambiguous ? kFaint : kDoubtful);
  tile->Text(Canvas::Fitted(Describe(fit), 10.5, width), {12, 43}, 10.5, kFaint);
}

cv::Mat DrawTile(const Portrait& portrait, const GripperConfig& gripper) {
  Canvas tile(kTileWidth_px, kTileHeight_px, kPaper);
  constexpr int kPanelWidth = kTileWidth_px / 2;
  constexpr int kPanelHeight = kTileHeight_px - kHeader_px - kFooter_px;
  const Eigen::Vector3d eye = portrait.viewpoint_F, up = UpOf(portrait);
  const Eigen::Vector3d target = portrait.estimate.fit.shape.X_FO.translation();
  const auto panel = [&](int column, const PictureView& view, const std::string& caption) {
    const cv::Rect area(column * kPanelWidth, kHeader_px, kPanelWidth, kPanelHeight);
    Panel(portrait, gripper, view, tile.Part(area)).Draw();
    const double left = area.x + (kPanelWidth - Canvas::TextWidth(caption, 9.5)) / 2;
    tile.Text(caption, {left, kTileHeight_px - 7}, 9.5, kFaint);
  };
  panel(0, CameraView(eye, target, up), "as the camera saw it");
  panel(1, SideView(eye, target, up), "from the side, the camera on the left");
  tile.Line({kPanelWidth, kHeader_px + 8}, {kPanelWidth, kTileHeight_px - 8}, kRule, 1);
  DrawHeader(portrait, &tile);
  tile.Line({0, kTileHeight_px - 0.5}, {kTileWidth_px, kTileHeight_px - 0.5}, kRule, 1);
  tile.Line({kTileWidth_px - 0.5, 0}, {kTileWidth_px - 0.5, kTileHeight_px}, kRule, 1);
  return tile.Finished();
}

cv::Mat DrawLegend(int width_px, size_t shown, size_t all) {
  constexpr double kText = 9, kBaseline = 22;
  Canvas legend(width_px, kLegendHeight_px, kPaper);
  double x = 12;
  const auto text = [&](const std::string& words, double gap) {
    legend.Text(words, {x, kBaseline}, kText, kInk);
    x += Canvas::TextWidth(words, kText) + gap;
  };
  text("residual 0", 6);
  constexpr int kSteps = 30;
  for (int i = 0; i < kSteps; ++i, x += 2)
    legend.Line({x, 13}, {x, 23}, DistanceColour(kFarDistance_m * i / (kSteps - 1)), 2);
  x += 6;
  char words[64];
  std::snprintf(words, sizeof words, "%.0f mm", 1000 * kFarDistance_m);
  text(words, 16);
  const auto key = [&](const Colour& colour, double width, bool dashed, const char* name) {
    for (int i = 0; i < 3; ++i, x += 8)
      legend.Line({x, 18}, {x + (dashed ? 5 : 8), 18}, colour, width);
    x += 6;
    text(name, 11);
  };
  key(kWire, 1.2, false, "fit");
  key(Lighter(kWire, 0.65), 0.8, false, "hidden");
  key(kDoubtful, 1.2, false, "not converged");
  key(kAlternative, 1.2, true, "alternative");
  std::snprintf(words, sizeof words, "grid %.0f mm", 1000 * kGrid_m);
  text(words, 11);
  if (shown < all) text("first " + std::to_string(shown) + " of " + std::to_string(all), 0);
  return legend.Finished();
}

}  // namespace

std::string Describe(const FitResult& fit) {
  if (!fit.converged && !fit.reason.empty()) return fit.reason;
  const Superquadric& s = fit.shape;
  char text[200];
  std::snprintf(text, sizeof text,
                "semi-axes %.1f x %.1f x %.1f mm, eps %.2f %.2f, residual %.1f mm",
                1000 * s.semi_axes.x(), 1000 * s.semi_axes.y(), 1000 * s.semi_axes.z(),
                s.epsilon.x(), s.epsilon.y(), 1000 * fit.mean_radial_distance_m);
  std::string words = text;
  if (!s.taper.isZero()) {
    std::snprintf(text, sizeof text, ", taper %.2f %.2f", s.taper.x(), s.taper.y());
    words += text;
  }
  return words;
}

Status DrawPortraits(const std::string& path, const std::vector<Portrait>& portraits,
                     const GripperConfig& gripper) {
  const int count = static_cast<int>(std::min(portraits.size(), kMostPortraits));
  const int columns =
      std::clamp(static_cast<int>(std::ceil(std::sqrt(count / 2.0))), 1, kTilesPerRow);
  const int rows = (count + columns - 1) / columns;
  cv::Mat picture(rows * kTileHeight_px + kLegendHeight_px, columns * kTileWidth_px, CV_8UC3,
                  kPaper);
  for (int i = 0; i < count; ++i) {
    const cv::Rect place(i % columns * kTileWidth_px, i / columns * kTileHeight_px, kTileWidth_px,
                         kTileHeight_px);
    DrawTile(portraits[static_cast<size_t>(i)], gripper).copyTo(picture(place));
  }
  DrawLegend(picture.cols, static_cast<size_t>(count), portraits.size())
      .copyTo(picture.rowRange(rows * kTileHeight_px, picture.rows));
  return WritePicture(path, picture);
}

}  // namespace beckon::pose
