#include "services/capture/file_source.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "services/base/cloud_file.h"

namespace beckon::capture {
namespace {

namespace fs = std::filesystem;

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

/// The run of digits at `i`, without leading zeros; moves `i` behind it.
std::string TakeNumber(const std::string& text, size_t& i) {
  while (i + 1 < text.size() && text[i] == '0' && IsDigit(text[i + 1])) ++i;
  const size_t start = i;
  while (i < text.size() && IsDigit(text[i])) ++i;
  return text.substr(start, i - start);
}

bool IsCloudFile(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension == ".pcd" || extension == ".ply" || extension == ".xyz";
}

}  // namespace

bool NaturallyBefore(const std::string& a, const std::string& b) {
  size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (IsDigit(a[i]) && IsDigit(b[j])) {
      const std::string x = TakeNumber(a, i), y = TakeNumber(b, j);
      if (x.size() != y.size()) return x.size() < y.size();
      if (x != y) return x < y;
      continue;
    }
    if (a[i] != b[j]) return a[i] < b[j];
    ++i, ++j;
  }
  if (i < a.size() || j < b.size()) return j < b.size();
  return a < b;
}

Result<std::vector<std::string>> ListCloudFiles(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code ignored;
    if (it->is_regular_file(ignored) && IsCloudFile(it->path()))
      files.push_back(it->path().string());
  }
  if (error) return Error{folder + ": the folder cannot be read: " + error.message()};
  if (files.empty()) {
    return Error{folder + ": expected a folder with .pcd, .ply or .xyz files, found none in it"};
  }
  std::sort(files.begin(), files.end(), NaturallyBefore);
  return files;
}

Result<CapturedImage> ReadImageFile(const std::string& path,
                                    const std::optional<Intrinsics>& intrinsics) {
  const auto cloud = ReadCloudFile(path);
  if (!cloud) return cloud.error();
  auto image = ToImage(*cloud, intrinsics ? &*intrinsics : nullptr);
  if (!image) return Error{path + ": " + image.error().message};
  return CapturedImage{std::make_shared<const RgbdImage>(*std::move(image)),
                       fs::path(path).filename().string()};
}

Result<std::optional<CapturedImage>> FolderSource::Next() {
  std::optional<Error> first;
  for (size_t tried = 0; tried < files_.size(); ++tried) {
    if (next_ == files_.size() && once_) break;
    next_ %= files_.size();
    auto image = ReadImageFile(files_[next_++], intrinsics_);
    if (image) return std::optional(*std::move(image));
    if (!first) first = image.error();
  }
  if (first && !(once_ && next_ == files_.size())) return *first;
  return std::optional<CapturedImage>();
}

}  // namespace beckon::capture
