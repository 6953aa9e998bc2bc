// A child process that is started without a shell and ends with the object that owns it.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "services/base/result.h"

namespace beckon::ui_bridge {

class Child {
 public:
  struct Streams {
    int input = -1;            // becomes its standard input; -1: nothing to read
    bool pipe_output = false;  // its standard output can be read; else it is thrown away
  };

  /// `command` is the program, looked up in PATH, and its arguments. What it writes to standard
  /// error is thrown away.
  static Result<Child> Start(const std::vector<std::string>& command, const Streams& streams);
  Child(Child&& other) noexcept;
  Child& operator=(Child&& other) noexcept;
  /// Kills it if it still runs.
  ~Child();

  /// The reading end of its standard output, not blocking; -1 without.
  int output() const { return output_; }
  /// Readable once it has ended; -1 where the kernel has no pidfd.
  int ended_fd() const { return pidfd_; }
  /// Whether it has ended; does not block. Wait then tells how.
  bool Ended();
  /// Blocks until it ends; its exit code, or 128 + the signal that ended it.
  int Wait();
  void Kill();

 private:
  Child() = default;
  void Close();

  pid_t pid_ = -1;  // -1 once it was waited for
  int pidfd_ = -1;
  int output_ = -1;
  int code_ = 0;
};

}  // namespace beckon::ui_bridge
