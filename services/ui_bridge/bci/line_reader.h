// Lines from a descriptor as they come, for a loop that must not wait for them.
#pragma once

#include <functional>
#include <string>

#include "services/base/run_loop.h"

namespace beckon::ui_bridge::bci {

/// Reads until the end of input, then leaves the loop alone. A plain file cannot be waited for and
/// is not read. Lines over 4096 bytes are cut.
class LineReader {
 public:
  /// `loop` and what `on_line` needs must outlive it.
  LineReader(RunLoop& loop, int fd, std::function<void(const std::string&)> on_line);
  ~LineReader();
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

 private:
  void Read();
  void Leave();

  RunLoop& loop_;
  const int fd_;
  const std::function<void(const std::string&)> on_line_;
  std::string line_;
  bool watching_ = false;
};

}  // namespace beckon::ui_bridge::bci
