#include "services/base/cloud_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "services/base/cloud_bytes.h"
#include "services/base/pcd_file.h"
#include "services/base/ply_file.h"

namespace beckon {
namespace {

constexpr int64_t kMaxFileBytes = int64_t{4} << 30;

/// Owns a file descriptor.
struct Descriptor {
  int fd;
  ~Descriptor() {
    if (fd >= 0) close(fd);
  }
};

Result<std::string> ReadBytes(const std::string& path) {
  const Descriptor file{open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  if (file.fd < 0) return Error{path + ": cannot be opened: " + std::strerror(errno)};
  struct stat info;
  if (fstat(file.fd, &info) != 0 || !S_ISREG(info.st_mode)) {
    return Error{path + ": expected a cloud file, found something that is not a regular file"};
  }
  if (info.st_size == 0) return Error{path + ": the file is empty"};
  if (info.st_size > kMaxFileBytes) return Error{path + ": larger than 4 GB"};
  std::string bytes(static_cast<size_t>(info.st_size), '\0');
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got = read(file.fd, bytes.data() + done, bytes.size() - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return Error{path + ": cannot be read: " + std::strerror(errno)};
    if (got == 0) break;
    done += static_cast<size_t>(got);
  }
  bytes.resize(done);
  return bytes;
}

/// Lines of at least three numbers; what follows them on the line is skipped, as are lines of
/// comment.
Result<Cloud> ParseXyz(std::string_view bytes) {
  cloud::Scanner scanner(bytes, 0);
  Cloud result;
  while (const auto line = scanner.Line()) {
    const auto words = cloud::Words(*line, " \t\r,;");
    if (words.empty() || words[0][0] == '#' || words[0].substr(0, 2) == "//") continue;
    double p[3];
    for (size_t i = 0; i < 3; ++i) {
      const auto number = i < words.size() ? cloud::ParseNumber(words[i]) : std::nullopt;
      if (!number) {
        return Error{"XYZ line " + std::to_string(scanner.line()) +
                     ": expected three numbers, found " + cloud::Quote(*line)};
      }
      p[i] = *number;
    }
    result.points.push_back(cloud::MakePoint(p[0], p[1], p[2]));
    if (result.points.size() > cloud::kMaxPoints) return Error{"XYZ: more than 50 million points"};
  }
  result.width = static_cast<int>(result.points.size());
  return result;
}

Result<Cloud> Parse(const std::string& extension, std::string_view bytes) {
  if (extension == ".pcd") return cloud::ParsePcd(bytes);
  if (extension == ".ply") return cloud::ParsePly(bytes);
  return ParseXyz(bytes);
}

}  // namespace

Result<Cloud> ReadCloudFile(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (extension != ".pcd" && extension != ".ply" && extension != ".xyz") {
    return Error{path + ": expected a cloud file ending in .pcd, .ply or .xyz"};
  }
  const auto bytes = ReadBytes(path);
  if (!bytes) return bytes.error();
  auto result = Parse(extension, *bytes);
  if (!result) return Error{path + ": " + result.error().message};
  const auto& points = result->points;
  if (std::none_of(points.begin(), points.end(), [](const auto& p) { return p.allFinite(); })) {
    return Error{path + ": none of its " + std::to_string(points.size()) +
                 " points has a finite position"};
  }
  return result;
}

Status WritePcdFile(const std::string& path, const Cloud& cloud) {
  const size_t n = cloud.points.size();
  if (n == 0 || n != static_cast<size_t>(cloud.width) * static_cast<size_t>(cloud.height) ||
      (!cloud.colours.empty() && cloud.colours.size() != n) ||
      (!cloud.labels.empty() && cloud.labels.size() != n)) {
    return Error{path +
                 ": a cloud must have width x height points, and as many colours and labels "
                 "where it has any"};
  }
  const std::string bytes = cloud::FormatPcd(cloud);
  const Descriptor file{open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)};
  if (file.fd < 0) return Error{path + ": cannot be written: " + std::strerror(errno)};
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t put = write(file.fd, bytes.data() + done, bytes.size() - done);
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return Error{path + ": cannot be written: " + std::strerror(errno)};
    done += static_cast<size_t>(put);
  }
  return {};
}

}  // namespace beckon
