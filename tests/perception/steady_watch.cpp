// Outlines are compared as filled polygons.
#include "tests/perception/steady_watch.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>

namespace beckon::perception {
namespace {

constexpr int kPatience = 30;       // frames in which something must be noticed,
constexpr int kAfterwards = 5;      // and after which it must still be so
constexpr double kShownWell = 0.5;  // IoU with the truth

cv::Mat Filled(const RgbdImage& image, const PerceivedObject& object) {
  cv::Mat mask = cv::Mat::zeros(image.height, image.width, CV_8U);
  std::vector<cv::Point> polygon;
  for (const auto& [u, v] : object.shape.outline_px) polygon.emplace_back(u, v);
  cv::fillPoly(mask, std::vector{polygon}, 1);
  return mask;
}

cv::Mat Marked(const RgbdImage& image, const std::vector<uint32_t>& pixels) {
  cv::Mat mask = cv::Mat::zeros(image.height, image.width, CV_8U);
  for (uint32_t pixel : pixels) mask.data[pixel] = 1;
  return mask;
}

double Overlap(const cv::Mat& a, const cv::Mat& b) {
  return static_cast<double>(cv::countNonZero(a & b)) / cv::countNonZero(a | b);
}

double Deviation(const std::vector<Eigen::Vector3d>& places) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& p : places) mean += p / static_cast<double>(places.size());
  double variance = 0;
  for (const auto& p : places) {
    variance += (p - mean).squaredNorm() / static_cast<double>(places.size());
  }
  return std::sqrt(variance);
}

/// Frames until `noticed` holds.
int FramesUntil(SteadyTable& table, Perceiver& perceiver,
                const std::function<bool(const Perception&)>& noticed) {
  for (int frame = 1; frame <= kPatience; ++frame) {
    if (noticed(perceiver.Perceive(table.Next()))) return frame;
  }
  return Notice::kNever;
}

bool StaysSo(SteadyTable& table, Perceiver& perceiver,
             const std::function<bool(const Perception&)>& holds) {
  bool all = true;
  for (int frame = 0; frame < kAfterwards; ++frame) {
    all &= holds(perceiver.Perceive(table.Next()));
  }
  return all;
}

}  // namespace

void SteadyWatch::Add(const RgbdImage& image, const Perception& perception) {
  Frame& frame = frames_.emplace_back();
  if (perception.segmentation.table_C) frame.table_C = *perception.segmentation.table_C;
  std::map<int, Sight> now;
  for (const auto& object : perception.objects) {
    Sight& sight = now[object.id] = {Filled(image, object), Marked(image, object.shape.silhouette),
                                     Marked(image, object.shape.pixels)};
    Shown& shown = frame.objects[object.id];
    shown.centroid_W = object.shape.centroid_W;
    const auto before = last_.find(object.id);
    shown.before = before != last_.end();
    if (!shown.before) continue;
    shown.outline = Overlap(sight.outline, before->second.outline);
    shown.silhouette = Overlap(sight.silhouette, before->second.silhouette);
    shown.labels = Overlap(sight.labels, before->second.labels);
  }
  last_ = std::move(now);
}

bool SteadyWatch::ChangesAt(size_t frame) const {
  const auto& now = frames_[frame].objects;
  const auto& before = frames_[frame - 1].objects;
  return !std::equal(now.begin(), now.end(), before.begin(), before.end(),
                     [](const auto& a, const auto& b) { return a.first == b.first; });
}

Steadiness SteadyWatch::From(int first) const {
  Steadiness result;
  std::map<int, std::vector<Eigen::Vector3d>> centroids;
  std::vector<Eigen::Vector3d> normals, offsets;
  std::vector<double> outlines;
  for (size_t f = first; f < frames_.size(); ++f) {
    const Frame& frame = frames_[f];
    if (static_cast<int>(f) > first) result.id_changes += ChangesAt(f);
    normals.push_back(frame.table_C.normal);
    offsets.emplace_back(frame.table_C.offset_m, 0, 0);
    for (const auto& [id, shown] : frame.objects) {
      centroids[id].push_back(shown.centroid_W);
      if (!shown.before || static_cast<int>(f) == first) continue;
      outlines.push_back(shown.outline);
      result.least_silhouette = std::min(result.least_silhouette, shown.silhouette);
      result.least_labels = std::min(result.least_labels, shown.labels);
    }
  }
  std::sort(outlines.begin(), outlines.end());
  if (!outlines.empty()) {
    result.least_outline = outlines.front();
    result.low_outline = outlines[outlines.size() / 20];
  }
  for (const auto& [id, places] : centroids) {
    result.most_centroid_m = std::max(result.most_centroid_m, Deviation(places));
  }
  result.table_m = Deviation(offsets);
  result.table_rad = Deviation(normals);
  return result;
}

int SteadyWatch::FinalFrom() const {
  size_t frame = frames_.size() - 1;
  while (frame > 0 && !ChangesAt(frame)) --frame;
  return static_cast<int>(frame);
}

std::set<int> SteadyWatch::Ids() const {
  std::set<int> ids;
  for (const Frame& frame : frames_) {
    for (const auto& [id, shown] : frame.objects) ids.insert(id);
  }
  return ids;
}

std::set<int> Ids(const Perception& perception) {
  std::set<int> ids;
  for (const auto& object : perception.objects) ids.insert(object.id);
  return ids;
}

int IdOf(const Perception& perception, const std::vector<uint16_t>& truth, int object) {
  const auto n = std::count(truth.begin(), truth.end(), object + 1);
  for (const auto& o : perception.objects) {
    const auto hits = std::count_if(o.shape.pixels.begin(), o.shape.pixels.end(),
                                    [&](uint32_t pixel) { return truth[pixel] == object + 1; });
    if (hits * 3 > n) return o.id;
  }
  return 0;
}

double Accuracy(const Perception& perception, const std::vector<uint16_t>& truth, int object) {
  const auto n = std::count(truth.begin(), truth.end(), object + 1);
  double best = 0;
  for (const auto& o : perception.objects) {
    const auto hits = std::count_if(o.shape.pixels.begin(), o.shape.pixels.end(),
                                    [&](uint32_t pixel) { return truth[pixel] == object + 1; });
    const auto either = n + static_cast<ptrdiff_t>(o.shape.pixels.size()) - hits;
    best = std::max(best, static_cast<double>(hits) / static_cast<double>(either));
  }
  return best;
}

namespace {

/// Until an object is shown well where it is, and whether under this id.
Notice WatchShown(SteadyTable& table, Perceiver& perceiver, int object, int id) {
  Notice notice;
  notice.after_frames = FramesUntil(table, perceiver, [&](const Perception& now) {
    return Accuracy(now, table.labels(), object) > kShownWell;
  });
  notice.right_id = StaysSo(table, perceiver, [&](const Perception& now) {
    return IdOf(now, table.labels(), object) == id;
  });
  return notice;
}

}  // namespace

Notice WatchMove(SteadyTable& table, Perceiver& perceiver, int object, double dx_m, double dy_m) {
  const int id = IdOf(perceiver.Perceive(table.Next()), table.labels(), object);
  table.Move(object, dx_m, dy_m);
  return WatchShown(table, perceiver, object, id);
}

Notice WatchRemoval(SteadyTable& table, Perceiver& perceiver, int object) {
  const int id = IdOf(perceiver.Perceive(table.Next()), table.labels(), object);
  table.Remove(object);
  const auto gone = [id](const Perception& now) { return !Ids(now).contains(id); };
  Notice notice;
  notice.after_frames = FramesUntil(table, perceiver, gone);
  notice.right_id = StaysSo(table, perceiver, gone);
  return notice;
}

Notice WatchReturn(SteadyTable& table, Perceiver& perceiver, int object, int id) {
  table.PutBack(object);
  return WatchShown(table, perceiver, object, id);
}

}  // namespace beckon::perception
