// `beckon doctor`: whether this machine has what Beckon needs, and what to do where it has not.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "services/base/result.h"

namespace beckon::tool {

struct Finding {
  enum class Grade { kOk, kWarn, kFail };
  Grade grade = Grade::kOk;
  std::string what;    // e.g. "socket buffers"
  std::string detail;  // what was found
  std::string remedy;  // what to do; empty where it is ok
};

struct DoctorOptions {
  std::string lcm_url;
  std::string db;       // of intention; empty = where it is by default
  std::string bin_dir;  // of the services
  std::string keys;     // folder; empty = messages are not signed
};

/// All checks, in the order they are read. Takes about a second.
std::vector<Finding> Examine(const DoctorOptions& options);

/// `keys`: folder of the key that messages are signed by; empty = they are not.
Finding CheckUrl(const std::string& lcm_url, const std::string& keys);
Finding CheckSocketBuffers(const std::string& lcm_url, long rmem_max);

/// Whether what is recognised and what can be wanted are the same categories. Both in alphabetical
/// order.
Finding CompareCategories(const std::vector<std::string>& of_model,
                          const std::vector<std::string>& of_affordances);

/// The kind of file system a folder is on, as statfs(2) numbers them.
using FileSystemLookup = std::function<Result<uint32_t>(const std::string& folder)>;
Result<uint32_t> FileSystemOf(const std::string& folder);

/// Warns of a database on a network share. `db`: the file; empty = where it is by default.
Finding CheckDatabaseDisk(const std::string& db,
                          const FileSystemLookup& file_system = FileSystemOf);

/// Whether a program of this name is in $PATH.
bool IsInPath(const std::string& program);

/// What the front ends need: none of it fails, a machine needs only what its user answers by.
std::vector<Finding> CheckFrontEnds();

/// A line for each, and how many were bad.
std::string Render(const std::vector<Finding>& findings);
/// 1 where anything failed.
int ExitCode(const std::vector<Finding>& findings);

}  // namespace beckon::tool
