#include "tools/beckon/log_slice.h"

#include <fcntl.h>
#include <lcm/eventlog.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>

#include "tools/beckon/log_reader.h"

namespace beckon::tool {
namespace {

/// A file that nobody finds; children keep it.
Result<std::string> NamelessFile() {
  std::error_code ignored;
  std::string name =
      (std::filesystem::temp_directory_path(ignored) / "beckon-replay-XXXXXX").string();
  const int fd = mkstemp(name.data());
  if (fd < 0) return Error{name + ": cannot be made: " + std::strerror(errno)};
  unlink(name.c_str());
  return "/dev/fd/" + std::to_string(fd);
}

bool Write(lcm_eventlog_t* log, LoggedMessage& message) {
  lcm_eventlog_event_t event{};
  event.timestamp = message.utime;
  event.channellen = static_cast<int32_t>(message.channel.size());
  event.datalen = static_cast<int32_t>(message.data.size());
  event.channel = message.channel.data();
  event.data = const_cast<uint8_t*>(message.data.data());
  return lcm_eventlog_write_event(log, &event) == 0;
}

}  // namespace

Result<std::string> SliceLog(const std::string& log, const LogRange& range) {
  auto reader = LogReader::Open(log);
  if (!reader) return reader.error();
  auto path = NamelessFile();
  if (!path) return path.error();
  const std::unique_ptr<lcm_eventlog_t, decltype(&lcm_eventlog_destroy)> slice(
      lcm_eventlog_create(path->c_str(), "w"), &lcm_eventlog_destroy);
  if (!slice) return Error{*path + ": cannot be written: " + std::strerror(errno)};
  reader->Seek(range.offset);
  int64_t messages = 0;
  while (auto message = reader->Next()) {
    if (message->offset >= range.end_offset) break;
    if (message->utime < range.begin || message->utime >= range.end) continue;
    if (!Write(slice.get(), *message))
      return Error{"the part of " + log + " cannot be copied: " + std::strerror(errno)};
    ++messages;
  }
  if (messages == 0) return Error{log + ": no message is in the part that is asked for"};
  if (fflush(slice->f) != 0)
    return Error{"the part of " + log + " cannot be copied: " + std::strerror(errno)};
  return *path;
}

}  // namespace beckon::tool
