#include "tools/beckon/log_reader.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <vector>

namespace beckon::tool {
namespace {

// A record: sync word, number (8 bytes), time (8), length of the channel's name (4) and of the data
// (4), all big-endian; the name; the data.
constexpr std::array<uint8_t, 4> kSync{0xed, 0xa1, 0xda, 0x01};
constexpr int64_t kHeaderBytes = 28;
/// LCM's own limit of a channel's name; and more data than any message of LCM's can have.
constexpr uint32_t kMostChannelBytes = 63;
constexpr uint32_t kMostDataBytes = 64 << 20;
/// So late that times can be added and subtracted: the year 148,000.
constexpr uint64_t kLatestUtime = uint64_t{1} << 62;

uint32_t BigEndian(const uint8_t* bytes) {
  return uint32_t{bytes[0]} << 24 | uint32_t{bytes[1]} << 16 | uint32_t{bytes[2]} << 8 | bytes[3];
}

int64_t SizeOf(FILE* file) {
  struct stat about {};
  return fstat(fileno(file), &about) == 0 ? about.st_size : 0;
}

}  // namespace

/// What a record says of itself, within its limits.
struct LogReader::Header {
  int64_t offset;
  int64_t end;
  Utime utime;
  size_t channel_bytes;
};

Result<LogReader> LogReader::Open(const std::string& path) {
  struct stat about {};
  if (stat(path.c_str(), &about) == 0 && !S_ISREG(about.st_mode)) {
    return Error{path + ": is no file; expected a log of lcm-logger or 'beckon record'"};
  }
  FILE* file = fopen(path.c_str(), "rb");
  if (file == nullptr) {
    return Error{path + ": cannot be read (" + std::strerror(errno) +
                 "); expected a log of lcm-logger or 'beckon record'"};
  }
  return LogReader(file);
}

std::optional<LogReader::Header> LogReader::HeaderAt(int64_t offset, int64_t size) {
  if (size - offset < kHeaderBytes) return std::nullopt;
  std::array<uint8_t, kHeaderBytes> bytes;
  if (fseeko(file_.get(), offset, SEEK_SET) != 0 ||
      fread(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size() ||
      !std::equal(kSync.begin(), kSync.end(), bytes.begin())) {
    return std::nullopt;
  }
  const uint64_t utime = uint64_t{BigEndian(&bytes[12])} << 32 | BigEndian(&bytes[16]);
  const uint32_t channel = BigEndian(&bytes[20]), data = BigEndian(&bytes[24]);
  if (utime > kLatestUtime || channel < 1 || channel > kMostChannelBytes || data > kMostDataBytes)
    return std::nullopt;
  return Header{offset, offset + kHeaderBytes + channel + data, static_cast<Utime>(utime), channel};
}

std::optional<int64_t> LogReader::NextSync(int64_t from, int64_t size) {
  std::vector<uint8_t> block(1 << 16);
  while (from + static_cast<int64_t>(kSync.size()) <= size) {
    if (fseeko(file_.get(), from, SEEK_SET) != 0) return std::nullopt;
    const size_t n = fread(block.data(), 1, block.size(), file_.get());
    if (n < kSync.size()) return std::nullopt;
    const auto end = block.begin() + static_cast<std::ptrdiff_t>(n);
    const auto found = std::search(block.begin(), end, kSync.begin(), kSync.end());
    if (found != end) return from + (found - block.begin());
    from += static_cast<int64_t>(n - kSync.size() + 1);
  }
  return std::nullopt;
}

std::optional<int64_t> LogReader::NextWhole(int64_t from, int64_t size) {
  while (const auto sync = NextSync(from, size)) {
    const auto header = HeaderAt(*sync, size);
    if (header && header->end <= size) return sync;
    from = *sync + 1;
  }
  return std::nullopt;
}

std::optional<LoggedMessage> LogReader::Read(const Header& header) {
  record_.resize(static_cast<size_t>(header.end - header.offset - kHeaderBytes));
  if (fseeko(file_.get(), header.offset + kHeaderBytes, SEEK_SET) != 0 ||
      fread(record_.data(), 1, record_.size(), file_.get()) != record_.size()) {
    return std::nullopt;
  }
  const std::span<const uint8_t> bytes(record_);
  const auto channel = bytes.first(header.channel_bytes);
  return LoggedMessage{header.offset, header.end, header.utime,
                       std::string(channel.begin(), channel.end()),
                       bytes.subspan(header.channel_bytes)};
}

std::optional<LoggedMessage> LogReader::Next() {
  const int64_t size = SizeOf(file_.get());
  cut_ = false;
  for (;;) {
    const auto header = HeaderAt(position_, size);
    if (header && header->end <= size) {
      if (auto message = Read(*header)) {
        position_ = header->end;
        return message;
      }
    }
    // Not a whole record: damage, where one follows, else the end.
    const auto whole = NextWhole(position_ + 1, size);
    if (!whole) {
      cut_ = position_ < size;
      return std::nullopt;
    }
    skipped_bytes_ += *whole - position_;
    position_ = *whole;
  }
}

}  // namespace beckon::tool
