// The siblings and the manifest's row first, the .pcd last: it is what makes a view.
#include "services/perception/told_store.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "services/base/pcd_file.h"
#include "services/perception/train_data.h"

namespace beckon::perception {
namespace {

namespace fs = std::filesystem;

constexpr char kPrefix[] = "told-";
constexpr char kUnfinished[] = ".part";
constexpr int kMargin_px = 4;  // of a crop, around the object
constexpr char kColumns[] =
    "file,category,instance,view,points,kind,units,frame,fx,fy,cx,cy,crop_x,crop_y,crop_w,crop_h,"
    "rgb_crop,depth_crop_mm,mask_crop,product,up_x,up_y,up_z";
constexpr std::array<const char*, 3> kSiblings = {"_rgb.png", "_depth.png", "_mask.png"};

Error Failed(const std::string& path, const char* what) {
  return Error{path + ": cannot " + what + " an example (" + std::strerror(errno) +
               "); check the folder's permissions and the space on its disk"};
}

/// All of it or nothing, durable.
Status WriteWhole(const std::string& path, const void* data, size_t size) {
  const std::string part = path + kUnfinished;
  const int fd = open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd < 0) return Failed(part, "write");
  const auto* bytes = static_cast<const char*>(data);
  bool written = true;
  for (size_t done = 0; written && done < size;) {
    const ssize_t n = write(fd, bytes + done, size - done);
    if (n < 0 && errno == EINTR) continue;
    if (n == 0) errno = ENOSPC;
    written = n > 0;
    done += written ? static_cast<size_t>(n) : 0;
  }
  written = written && fsync(fd) == 0;
  const int error = errno;
  close(fd);
  if (!written || rename(part.c_str(), path.c_str()) != 0) {
    if (!written) errno = error;
    const Error failed = Failed(path, "write");
    unlink(part.c_str());
    return failed;
  }
  return {};
}

void SyncFolder(const std::string& folder) {
  const int fd = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  fsync(fd);
  close(fd);
}

Status WritePng(const std::string& path, const cv::Mat& picture) {
  std::vector<uint8_t> bytes;
  if (!cv::imencode(".png", picture, bytes)) return Error{path + ": cannot be encoded"};
  return WriteWhole(path, bytes.data(), bytes.size());
}

/// The part of an image that holds an object.
struct Crop {
  int u = 0, v = 0, width = 0, height = 0;
  cv::Mat colour, depth_mm, mask;
  Cloud cloud;
};

Crop CropOf(const ObjectView& view) {
  const RgbdImage& image = view.image;
  int left = image.width, right = 0, top = image.height, bottom = 0;
  for (const uint32_t pixel : view.pixels) {
    const int u = static_cast<int>(pixel) % image.width, v = static_cast<int>(pixel) / image.width;
    left = std::min(left, u), right = std::max(right, u);
    top = std::min(top, v), bottom = std::max(bottom, v);
  }
  Crop crop;
  crop.u = std::max(0, left - kMargin_px);
  crop.v = std::max(0, top - kMargin_px);
  crop.width = std::min(image.width, right + 1 + kMargin_px) - crop.u;
  crop.height = std::min(image.height, bottom + 1 + kMargin_px) - crop.v;
  crop.colour = cv::Mat::zeros(crop.height, crop.width, CV_8UC3);
  crop.depth_mm = cv::Mat::zeros(crop.height, crop.width, CV_16U);
  crop.mask = cv::Mat::zeros(crop.height, crop.width, CV_8U);
  for (int v = 0; v < crop.height; ++v) {
    for (int u = 0; u < crop.width; ++u) {
      const size_t i = image.Index(crop.u + u, crop.v + v);
      const float mm = std::min(65535.0f, image.depth_m[i] * 1000 + 0.5f);
      crop.depth_mm.at<uint16_t>(v, u) = static_cast<uint16_t>(mm);
      if (image.colour.empty()) continue;
      const Rgb& rgb = image.colour[i];
      crop.colour.at<cv::Vec3b>(v, u) = {rgb[2], rgb[1], rgb[0]};
    }
  }
  for (const uint32_t pixel : view.pixels) {
    const int u = static_cast<int>(pixel) % image.width, v = static_cast<int>(pixel) / image.width;
    crop.mask.at<uint8_t>(v - crop.v, u - crop.u) = 255;
    if (!image.HasDepth(u, v)) continue;
    crop.cloud.points.push_back(image.Point(u, v).cast<float>());
    if (!image.colour.empty()) crop.cloud.colours.push_back(image.colour[pixel]);
  }
  crop.cloud.width = static_cast<int>(crop.cloud.points.size());
  return crop;
}

std::string ManifestRow(const std::string& stem, const std::string& category,
                        const std::string& name, int number, const Crop& crop,
                        const ObjectView& view) {
  const Intrinsics& k = view.image.intrinsics;
  std::array<char, 192> numbers{}, up{};
  std::snprintf(numbers.data(), numbers.size(), "%.3f,%.3f,%.3f,%.3f,%d,%d,%d,%d", k.fx, k.fy, k.cx,
                k.cy, crop.u, crop.v, crop.width, crop.height);
  if (view.table_C) {
    const Eigen::Vector3d& n = view.table_C->normal;
    std::snprintf(up.data(), up.size(), "%.5f,%.5f,%.5f", n.x(), n.y(), n.z());
  } else {
    std::snprintf(up.data(), up.size(), ",,");
  }
  return stem + ".pcd," + category + "," + name + "," + std::to_string(number) + "," +
         std::to_string(crop.cloud.points.size()) + ",told,m,camera optical," + numbers.data() +
         "," + stem + "_rgb.png," + stem + "_depth.png," + stem + "_mask.png," + name + "," +
         up.data();
}

std::string FileOfRow(const std::string& line) { return line.substr(0, line.find(',')); }

}  // namespace

std::string ToldStore::NameOf(const std::string& label_id) {
  if (label_id.starts_with(kPrefix)) return label_id;
  uint64_t hash = 14695981039346656037ull;  // FNV-1a
  for (const char c : label_id) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  std::array<char, 24> hex{};
  std::snprintf(hex.data(), hex.size(), "%016llx", static_cast<unsigned long long>(hash));
  return std::string(kPrefix) + hex.data();
}

Result<ToldStore> ToldStore::Open(const ToldStoreConfig& config) {
  ToldStore store(config);
  // Made when there is something to keep; that it can be is told now.
  fs::path there = fs::absolute(config.folder);
  std::error_code ignored;
  while (!fs::exists(there, ignored) && there.has_relative_path()) there = there.parent_path();
  if (!fs::is_directory(there, ignored) || access(there.c_str(), W_OK) != 0) {
    return Error{config.folder + ": expected a folder for examples, cannot make or write it (" +
                 there.string() + " is no folder that may be written); see [learning] folder"};
  }
  if (Status loaded = store.Load(); !loaded) return loaded.error();
  return store;
}

Status ToldStore::Load() {
  const std::string manifest = config_.folder + "/manifest.csv";
  std::ifstream file(manifest);
  for (std::string line; std::getline(file, line);) lines_.push_back(line);
  if (lines_.empty()) lines_ = {kColumns};
  if (lines_.front() != kColumns) {
    return Error{manifest + ": expected the columns '" + kColumns +
                 "', found others; name another folder in [learning] folder"};
  }
  std::error_code error;
  if (!fs::exists(config_.folder, error)) return {};
  std::vector<fs::path> unfinished;
  bool any = false;
  for (fs::recursive_directory_iterator it(config_.folder, error), end; !error && it != end;
       it.increment(error)) {
    if (it->path().extension() == kUnfinished) unfinished.push_back(it->path());
    any |= it->path().extension() == ".pcd";
  }
  if (error) return Error{config_.folder + ": cannot be listed (" + error.message() + ")"};
  for (const fs::path& path : unfinished) {
    warnings_.push_back(path.string() + ": was not written to its end, removed");
    fs::remove(path, error);
  }
  if (!any) return {};
  auto records = ListViews(config_.folder);
  if (!records) return records.error();
  for (const ViewRecord& record : *records) {
    const std::string stem = record.path.substr(0, record.path.size() - 4);
    const std::string name = record.instance;
    if (!name.starts_with(kPrefix)) continue;  // somebody else's
    files_[record.file] = name;
    const bool whole = record.intrinsics && record.crop_px &&
                       std::ranges::all_of(kSiblings, [&](const char* ending) {
                         return fs::exists(stem + ending) &&
                                !cv::imread(stem + ending, cv::IMREAD_UNCHANGED).empty();
                       });
    const auto view = whole ? LoadView(record) : Result<LoadedView>(Error{"a part is missing"});
    const InstanceLook look = view ? LookAtInstance(view->view()) : InstanceLook();
    if (look.n_points == 0) {
      warnings_.push_back(record.path + ": is no whole view, left out (" +
                          (view ? "too few points" : view.error().message) +
                          "); remove it and its siblings");
      continue;
    }
    loaded_.push_back({name, record.category, look});
  }
  return {};
}

Status ToldStore::WriteManifest(const std::vector<std::string>& lines) const {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return WriteWhole(config_.folder + "/manifest.csv", text.data(), text.size());
}

Status ToldStore::Add(const std::string& label_id, const std::string& category,
                      const ObjectView& view) {
  if (view.pixels.empty()) return Error{"an example of " + category + " has no pixels"};
  if (n_views() >= config_.most_views) {
    return Error{config_.folder + ": holds " + std::to_string(n_views()) +
                 " examples, as many as it may ([learning] most_views); move some elsewhere"};
  }
  const std::string name = NameOf(label_id), folder = config_.folder + "/" + category;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return Error{folder + ": cannot be made (" + error.message() + ")"};
  int number = 0;
  const auto stem_of = [&] { return category + "/" + name + "__" + std::to_string(number); };
  while (files_.contains(stem_of() + ".pcd")) ++number;
  const std::string stem = stem_of(), path = config_.folder + "/" + stem;
  const Crop crop = CropOf(view);
  const std::string pcd = cloud::FormatPcd(crop.cloud);
  std::vector<std::string> lines = lines_;
  std::erase_if(lines, [&](const auto& line) { return FileOfRow(line) == stem + ".pcd"; });
  lines.push_back(ManifestRow(stem, category, name, number, crop, view));

  Status status = WritePng(path + "_rgb.png", crop.colour);
  if (status) status = WritePng(path + "_depth.png", crop.depth_mm);
  if (status) status = WritePng(path + "_mask.png", crop.mask);
  if (status) status = WriteManifest(lines);
  if (status) status = WriteWhole(path + ".pcd", pcd.data(), pcd.size());
  if (!status) {
    for (const char* ending : kSiblings) fs::remove(path + ending, error);
    return status;
  }
  SyncFolder(folder);
  SyncFolder(config_.folder);
  lines_ = std::move(lines);
  files_[stem + ".pcd"] = name;
  return {};
}

Status ToldStore::Remove(const std::string& label_id) {
  const std::string name = NameOf(label_id);
  std::set<std::string> gone;
  Status status;
  for (const auto& [file, whose] : files_) {
    if (whose != name) continue;
    const std::string path = config_.folder + "/" + file;
    std::error_code error;
    fs::remove(path, error);
    if (error) {
      status = Error{path + ": cannot be removed (" + error.message() + ")"};
      continue;
    }
    for (const char* ending : kSiblings)
      fs::remove(path.substr(0, path.size() - 4) + ending, error);
    gone.insert(file);
  }
  if (gone.empty()) return status;
  std::erase_if(files_, [&](const auto& entry) { return gone.contains(entry.first); });
  std::erase_if(lines_, [&](const auto& line) { return gone.contains(FileOfRow(line)); });
  const Status written = WriteManifest(lines_);
  return status ? written : status;
}

}  // namespace beckon::perception
