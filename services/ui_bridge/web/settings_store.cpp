#include "services/ui_bridge/web/settings_store.h"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

namespace beckon::ui_bridge::web {
namespace {

constexpr size_t kMostBytes = 64 * 1024;

Error Failed(const std::string& path) {
  return Error{path + ": cannot be written: " + std::strerror(errno)};
}

bool WriteAll(int fd, const std::string& text) {
  for (size_t done = 0; done < text.size();) {
    const ssize_t n = write(fd, text.data() + done, text.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += static_cast<size_t>(n);
  }
  return fsync(fd) == 0;
}

}  // namespace

SettingsStore::SettingsStore(std::string folder)
    : folder_(std::move(folder)), thread_([this] { Work(); }) {}

SettingsStore::~SettingsStore() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

std::string SettingsStore::PathOf(const std::string& user) const {
  return folder_ + "/" + user + ".json";
}

Result<Settings> SettingsStore::Load(const std::string& user) const {
  const std::string path = PathOf(user);
  std::string text;
  {
    std::lock_guard lock(mutex_);
    if (const auto found = waiting_.find(user); found != waiting_.end()) text = found->second;
  }
  if (text.empty()) {
    std::ifstream file(path, std::ios::binary);
    if (!file) return Settings{};
    std::ostringstream bytes;
    bytes << file.rdbuf();
    text = bytes.str();
  }
  if (text.size() > kMostBytes) return Error{path + ": too large for settings"};
  const auto json = nlohmann::ordered_json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (json.is_discarded()) return Error{path + ": no whole JSON"};
  auto settings = ReadSettings(json);
  if (!settings) return Error{path + ": " + settings.error().message};
  return settings;
}

void SettingsStore::Save(const std::string& user, const Settings& settings) {
  {
    std::lock_guard lock(mutex_);
    waiting_[user] = ToJson(settings).dump(1) + "\n";
  }
  changed_.notify_all();
}

void SettingsStore::Flush() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.empty() && !writing_; });
}

void SettingsStore::Work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    const auto [user, text] = *waiting_.begin();
    writing_ = true;
    lock.unlock();
    if (auto written = WriteWhole(PathOf(user), text); !written)
      spdlog::error("web: settings are not kept: {}", written.error().message);
    lock.lock();
    writing_ = false;
    // Until now Load gave it from here.
    if (const auto done = waiting_.find(user); done != waiting_.end() && done->second == text)
      waiting_.erase(done);
    changed_.notify_all();
  }
}

Status WriteWhole(const std::string& path, const std::string& text) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return Error{folder.string() + ": cannot be made: " + error.message()};
  const std::string half = path + ".new";
  const int fd = open(half.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (fd < 0) return Failed(half);
  const bool written = fchmod(fd, 0600) == 0 && WriteAll(fd, text);
  close(fd);
  if (!written || rename(half.c_str(), path.c_str()) != 0) {
    Error failed = Failed(path);
    unlink(half.c_str());
    return failed;
  }
  if (const int dir = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); dir >= 0) {
    fsync(dir);
    close(dir);
  }
  return {};
}

}  // namespace beckon::ui_bridge::web
