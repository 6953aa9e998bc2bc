// Reads an LCM event log message by message, also one that is still written, was cut off, or is
// damaged: what is whole is found. liblcm's own reader trusts the lengths it reads: it takes
// gigabytes, or ends the process, and gives up at the first damage.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/base/result.h"
#include "services/base/utime.h"

namespace beckon::tool {

/// One record of a log; of the reader until its next Next.
struct LoggedMessage {
  int64_t offset = 0;  // of its record in the file, bytes
  int64_t end = 0;     // where the next may begin
  Utime utime = 0;     // when the logger received it
  std::string channel;
  std::span<const uint8_t> data;
};

class LogReader {
 public:
  /// Fails where the file cannot be read.
  static Result<LogReader> Open(const std::string& path);

  /// The next whole message; nothing at the end, for now: a log that grows has more later.
  std::optional<LoggedMessage> Next();
  /// Goes on at a record's offset.
  void Seek(int64_t offset) { position_ = offset; }

  /// Up to where it has read.
  int64_t position() const { return position_; }
  /// Bytes that belonged to no message.
  int64_t skipped_bytes() const { return skipped_bytes_; }
  /// Whether the log ended amid a message when Next found nothing.
  bool cut() const { return cut_; }

 private:
  struct Header;
  struct Close {
    void operator()(FILE* file) const { fclose(file); }
  };

  explicit LogReader(FILE* file) : file_(file) {}
  std::optional<Header> HeaderAt(int64_t offset, int64_t size);
  std::optional<int64_t> NextWhole(int64_t from, int64_t size);
  std::optional<int64_t> NextSync(int64_t from, int64_t size);
  std::optional<LoggedMessage> Read(const Header& header);

  std::unique_ptr<FILE, Close> file_;
  std::vector<uint8_t> record_;  // channel and data of the latest message
  int64_t position_ = 0;
  int64_t skipped_bytes_ = 0;
  bool cut_ = false;
};

}  // namespace beckon::tool
