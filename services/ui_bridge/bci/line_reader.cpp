#include "services/ui_bridge/bci/line_reader.h"

#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace beckon::ui_bridge::bci {

constexpr size_t kMostBytes = 4096;

LineReader::LineReader(RunLoop& loop, int fd, std::function<void(const std::string&)> on_line)
    : loop_(loop), fd_(fd), on_line_(std::move(on_line)) {
  try {
    loop_.AddFd(fd_, [this] { Read(); });
    watching_ = true;
  } catch (const std::system_error&) {  // a plain file
  }
}

LineReader::~LineReader() { Leave(); }

void LineReader::Read() {
  char bytes[1024];
  const ssize_t n = read(fd_, bytes, sizeof bytes);
  if (n < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (n <= 0) return Leave();
  for (ssize_t i = 0; i < n; ++i) {
    if (bytes[i] == '\n') {
      on_line_(std::exchange(line_, {}));
    } else if (line_.size() < kMostBytes) {
      line_ += bytes[i];
    }
  }
}

void LineReader::Leave() {
  if (std::exchange(watching_, false)) loop_.RemoveFd(fd_);
}

}  // namespace beckon::ui_bridge::bci
