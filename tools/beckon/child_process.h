// A program that runs beside this one: started, watched, ended.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include "services/base/result.h"

namespace beckon::tool {

struct ProcessSpec {
  std::string name;     // for people and logs, e.g. "capture"
  std::string program;  // path, or a name looked up in $PATH
  std::vector<std::string> args;
  std::string log_file;    // standard output and error are appended to it; empty = /dev/null
  bool terminal = false;   // has standard input, output and error of this process instead
  std::string stdin_file;  // else standard input is this file or FIFO; empty = /dev/null
  int listening_fd = -1;   // a socket that it gets by systemd's protocol (LISTEN_FDS)
};

/// How a process ended.
struct Exit {
  int code = 0;              // of exit(), where signal is 0
  int signal = 0;            // that killed it
  std::string Text() const;  // "exit code 2", "killed by signal 9"
};

/// Ends with this process's death too (by SIGKILL, in whatever way this one dies), and runs in a
/// process group of its own, so that a terminal's Ctrl-C reaches this process alone; one that has
/// the terminal stays in this group.
class ChildProcess {
 public:
  /// Fails where the program cannot be executed.
  static Result<ChildProcess> Start(const ProcessSpec& spec);
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&& other) noexcept;
  /// Kills it where it still runs.
  ~ChildProcess();

  pid_t pid() const { return pid_; }
  /// Readable once it has ended (for RunLoop::AddFd).
  int fd() const { return fd_; }
  /// Reaps; nothing while it runs.
  std::optional<Exit> Poll();
  /// Sends a signal to it (and its group).
  void Signal(int signal);
  /// Waits at most `timeout_ms`; nothing when it still runs.
  std::optional<Exit> Wait(int timeout_ms);

 private:
  ChildProcess(pid_t pid, int fd, bool own_group) : pid_(pid), fd_(fd), own_group_(own_group) {}

  pid_t pid_ = -1;
  int fd_ = -1;
  bool own_group_ = true;
  std::optional<Exit> exit_;
};

/// The last line of a log that says something, without the time stamp before it; at most 300
/// characters.
std::string LastLine(const std::string& log_file);

}  // namespace beckon::tool
