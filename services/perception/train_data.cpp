// Listing folders and manifests, reading views.
#include "services/perception/train_data.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "services/base/cloud_file.h"

namespace beckon::perception {
namespace {

namespace fs = std::filesystem;
using Row = std::map<std::string, std::string>;

std::optional<double> Number(const Row& row, const std::string& column) {
  const auto at = row.find(column);
  if (at == row.end() || at->second.empty()) return std::nullopt;
  double value = 0;
  const char* end = at->second.data() + at->second.size();
  const auto [stopped, error] = std::from_chars(at->second.data(), end, value);
  if (error != std::errc() || stopped != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string Text(const Row& row, const std::string& column) {
  const auto at = row.find(column);
  return at == row.end() ? std::string() : at->second;
}

void ApplyManifest(const Row& row, ViewRecord& record) {
  if (const std::string product = Text(row, "product"); !product.empty()) {
    record.instance = product;
  } else if (const std::string instance = Text(row, "instance"); !instance.empty()) {
    record.instance = instance;
  }
  const auto fx = Number(row, "fx"), fy = Number(row, "fy");
  const auto cx = Number(row, "cx"), cy = Number(row, "cy");
  if (fx && fy && cx && cy) record.intrinsics = Intrinsics{*fx, *fy, *cx, *cy};
  const auto u = Number(row, "crop_x"), v = Number(row, "crop_y");
  if (u && v) record.crop_px = {static_cast<int>(*u), static_cast<int>(*v)};
  const auto x = Number(row, "up_x"), y = Number(row, "up_y"), z = Number(row, "up_z");
  if (x && y && z) {
    const Eigen::Vector3d up(*x, *y, *z);
    if (up.norm() > 0.5 && up.norm() < 2) record.up_C = up.normalized();
  }
}

std::string InstanceFromName(const fs::path& relative) {
  const auto depth = std::distance(relative.begin(), relative.end());
  if (depth >= 3) return (*std::next(relative.begin())).string();
  const std::string stem = relative.stem().string();
  size_t cut = stem.rfind("__");
  if (cut == std::string::npos) cut = stem.rfind('_');
  return cut == std::string::npos || cut == 0 ? stem : stem.substr(0, cut);
}

std::string Sibling(const std::string& path, const char* ending) {
  return path.substr(0, path.size() - 4) + ending;
}

/// From depth (mm), mask and colour images, where they are all there and agree.
std::optional<LoadedView> LoadImages(const ViewRecord& record) {
  if (!record.intrinsics || !record.crop_px) return std::nullopt;
  const std::string depth_path = Sibling(record.path, "_depth.png");
  const std::string mask_path = Sibling(record.path, "_mask.png");
  if (!fs::exists(depth_path) || !fs::exists(mask_path)) return std::nullopt;
  const cv::Mat depth = cv::imread(depth_path, cv::IMREAD_UNCHANGED);
  const cv::Mat mask = cv::imread(mask_path, cv::IMREAD_GRAYSCALE);
  const cv::Mat colour = cv::imread(Sibling(record.path, "_rgb.png"), cv::IMREAD_COLOR);
  if (depth.type() != CV_16U || mask.size() != depth.size()) return std::nullopt;
  LoadedView out;
  out.image.width = depth.cols;
  out.image.height = depth.rows;
  out.image.intrinsics = *record.intrinsics;
  out.image.intrinsics.cx -= record.crop_px->first;
  out.image.intrinsics.cy -= record.crop_px->second;
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const float z = 0.001F * static_cast<float>(depth.at<uint16_t>(v, u));
      if (mask.at<uint8_t>(v, u) > 127 && z > 0) {
        out.pixels.push_back(static_cast<uint32_t>(out.image.depth_m.size()));
      }
      out.image.depth_m.push_back(z);
      if (colour.size() == depth.size()) {
        const cv::Vec3b bgr = colour.at<cv::Vec3b>(v, u);
        out.image.colour.push_back({bgr[2], bgr[1], bgr[0]});
      }
    }
  }
  return out;
}

Result<LoadedView> LoadCloud(const ViewRecord& record) {
  Result<Cloud> cloud = ReadCloudFile(record.path);
  if (!cloud) return cloud.error();
  const bool known = record.intrinsics.has_value();
  Result<RgbdImage> image = ToImage(*cloud, known ? &*record.intrinsics : nullptr);
  if (!image) return Error{record.path + ": " + image.error().message};
  LoadedView out;
  out.image = std::move(*image);
  for (size_t i = 0; i < out.image.depth_m.size(); ++i) {
    if (out.image.depth_m[i] > 0) out.pixels.push_back(static_cast<uint32_t>(i));
  }
  return out;
}

}  // namespace

Result<std::vector<Row>> ReadCsv(const std::string& path) {
  std::ifstream file(path);
  if (!file) return Error{path + ": cannot be read"};
  std::vector<std::string> header;
  std::vector<Row> rows;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) continue;
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (const char letter : line) {
      if (letter == '"') {
        quoted = !quoted;
      } else if (letter == ',' && !quoted) {
        fields.emplace_back();
      } else {
        fields.back() += letter;
      }
    }
    if (header.empty()) {
      header = fields;
      continue;
    }
    if (quoted || fields.size() != header.size()) {
      return Error{path + ":" + std::to_string(number) + ": expected " +
                   std::to_string(header.size()) + " fields, found " +
                   std::to_string(fields.size()) + "; correct the line"};
    }
    Row row;
    for (size_t i = 0; i < fields.size(); ++i) row[header[i]] = fields[i];
    rows.push_back(std::move(row));
  }
  return rows;
}

Result<std::vector<ViewRecord>> ListViews(const std::string& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    return Error{folder + ": expected a folder with a sub-folder a category, found none"};
  }
  std::map<std::string, Row> manifest;
  const std::string manifest_path = (fs::path(folder) / "manifest.csv").string();
  if (fs::exists(manifest_path)) {
    auto rows = ReadCsv(manifest_path);
    if (!rows) return rows.error();
    for (Row& row : *rows) manifest[Text(row, "file")] = std::move(row);
  }
  std::vector<ViewRecord> views;
  // A category's folder may be a link to where it is kept; how deep is bounded, so links may go
  // round.
  constexpr auto kLinks = fs::directory_options::follow_directory_symlink;
  constexpr int kDeepest = 3;
  for (fs::recursive_directory_iterator it(folder, kLinks, error), end; !error && it != end;
       it.increment(error)) {
    if (it.depth() >= kDeepest) it.disable_recursion_pending();
    if (!it->is_regular_file() || it->path().extension() != ".pcd") continue;
    const fs::path relative = it->path().lexically_relative(folder);
    if (std::distance(relative.begin(), relative.end()) < 2) continue;
    ViewRecord record;
    record.file = relative.generic_string();
    record.path = it->path().string();
    record.category = relative.begin()->string();
    record.instance = InstanceFromName(relative);
    if (const auto row = manifest.find(record.file); row != manifest.end()) {
      ApplyManifest(row->second, record);
    }
    views.push_back(std::move(record));
  }
  if (error) return Error{folder + ": cannot be listed (" + error.message() + ")"};
  if (views.empty()) {
    return Error{folder + ": expected views as <Category>/*.pcd, found none"};
  }
  std::sort(views.begin(), views.end(),
            [](const ViewRecord& a, const ViewRecord& b) { return a.file < b.file; });
  return views;
}

Result<LoadedView> LoadView(const ViewRecord& record) {
  std::optional<LoadedView> images = LoadImages(record);
  Result<LoadedView> view = images ? Result<LoadedView>(std::move(*images)) : LoadCloud(record);
  if (view && record.up_C) view->table_C = Plane{*record.up_C, 0};
  return view;
}

}  // namespace beckon::perception
