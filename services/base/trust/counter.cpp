#include "services/base/trust/counter.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <utility>

namespace beckon::trust {
namespace {

constexpr int64_t kReserve = 60 * kSecond;  // so seldom is the file written

}  // namespace

Counter::Counter(std::string file) : file_(std::move(file)) {
  int64_t used = 0;
  if (std::ifstream(file_) >> used) last_ = reserved_ = used;
}

int64_t Counter::Next(Utime now) {
  last_ = std::max(last_ + 1, now);
  if (last_ > reserved_) Reserve();
  return last_;
}

void Counter::Reserve() {
  namespace fs = std::filesystem;
  reserved_ = last_ + kReserve;
  if (file_.empty()) return;
  std::error_code failed;
  fs::create_directories(fs::path(file_).parent_path(), failed);
  const std::string fresh = file_ + ".new";
  const bool written = static_cast<bool>(std::ofstream(fresh) << reserved_ << "\n" << std::flush);
  if (written) fs::rename(fresh, file_, failed);
  if ((!written || failed) && !std::exchange(complained_, true)) {
    spdlog::warn(
        "{}: cannot be written; should the clock be put back before a restart, others will "
        "take what this process says for old",
        file_);
  }
}

}  // namespace beckon::trust
