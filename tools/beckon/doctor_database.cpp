// Whether the database of habits is kept on a disk of this machine.
#include <sys/vfs.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "services/base/app.h"
#include "tools/beckon/doctor.h"

namespace beckon::tool {
namespace {

namespace fs = std::filesystem;
using Grade = Finding::Grade;

/// statfs(2)'s f_type of file systems behind which another machine may be, whose locks and shared
/// memory SQLite's write-ahead log must not rely on (sqlite.org/wal.html, "all processes must be on
/// the same host computer").
constexpr std::array<std::pair<uint32_t, const char*>, 9> kShares{{{0x00006969, "NFS"},
                                                                   {0x0000517B, "SMB"},
                                                                   {0xFE534D42, "SMB"},
                                                                   {0xFF534D42, "CIFS"},
                                                                   {0x01021997, "9p"},
                                                                   {0x65735546, "FUSE, e.g. sshfs"},
                                                                   {0x5346414F, "AFS"},
                                                                   {0x00C36400, "Ceph"},
                                                                   {0x73757245, "Coda"}}};

/// The folder, or the nearest one above it that is there.
fs::path Existing(fs::path folder) {
  std::error_code ignored;
  folder = fs::absolute(folder, ignored);
  while (!fs::exists(folder, ignored) && folder.has_relative_path()) folder = folder.parent_path();
  return folder;
}

}  // namespace

Result<uint32_t> FileSystemOf(const std::string& folder) {
  struct statfs answer {};
  if (statfs(folder.c_str(), &answer) != 0) return Error{folder + ": " + std::strerror(errno)};
  return static_cast<uint32_t>(answer.f_type);
}

Finding CheckDatabaseDisk(const std::string& db, const FileSystemLookup& file_system) {
  const std::string what = "database's disk";
  const fs::path file = db.empty() ? DataFile("beckon.db") : db;
  const std::string folder = Existing(file.parent_path());
  const auto type = file_system(folder);
  if (!type) return {Grade::kWarn, what, type.error().message, "see whether that folder is there"};
  const auto share = std::ranges::find(kShares, *type, [](const auto& s) { return s.first; });
  if (share == kShares.end())
    return {Grade::kOk, what, folder + " is on a disk of this machine", {}};
  return {Grade::kWarn, what,
          folder + " is on a network share (" + share->second +
              "): two machines that write there destroy the database",
          "keep it on this machine's own disk (--db); copies go by 'beckon-intention export'"};
}

}  // namespace beckon::tool
