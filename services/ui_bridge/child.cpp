#include "services/ui_bridge/child.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

extern char** environ;

namespace beckon::ui_bridge {
namespace {

int CodeOf(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status)
                           : 128 + (WIFSIGNALED(status) ? WTERMSIG(status) : 0);
}

/// Signals as a program expects them: RunLoop blocks some for all of our threads.
void DefaultSignals(posix_spawnattr_t& attributes) {
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  sigset_t all;
  sigfillset(&all);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
}

}  // namespace

Result<Child> Child::Start(const std::vector<std::string>& command, const Streams& streams) {
  if (command.empty() || command.front().empty()) return Error{"no program to start"};
  int pipe_fds[2] = {-1, -1};
  if (streams.pipe_output && pipe2(pipe_fds, O_CLOEXEC) != 0)
    return Error{std::string("pipe: ") + std::strerror(errno)};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (streams.input >= 0) {
    posix_spawn_file_actions_adddup2(&actions, streams.input, STDIN_FILENO);
  } else {
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  }
  if (streams.pipe_output) {
    posix_spawn_file_actions_adddup2(&actions, pipe_fds[1], STDOUT_FILENO);
  } else {
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  }
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  DefaultSignals(attributes);
  std::vector<char*> arguments;
  for (const auto& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  Child child;
  const int failed =
      posix_spawnp(&child.pid_, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (pipe_fds[1] >= 0) close(pipe_fds[1]);
  if (failed != 0) {
    if (pipe_fds[0] >= 0) close(pipe_fds[0]);
    child.pid_ = -1;
    return Error{command.front() + ": cannot be started: " + std::strerror(failed)};
  }
  if (pipe_fds[0] >= 0) fcntl(pipe_fds[0], F_SETFL, fcntl(pipe_fds[0], F_GETFL) | O_NONBLOCK);
  child.output_ = pipe_fds[0];
  child.pidfd_ = static_cast<int>(syscall(SYS_pidfd_open, child.pid_, 0));
  return child;
}

Child::Child(Child&& other) noexcept { *this = std::move(other); }

Child& Child::operator=(Child&& other) noexcept {
  if (this == &other) return *this;
  Close();
  pid_ = std::exchange(other.pid_, -1);
  pidfd_ = std::exchange(other.pidfd_, -1);
  output_ = std::exchange(other.output_, -1);
  code_ = other.code_;
  return *this;
}

Child::~Child() { Close(); }

void Child::Close() {
  Kill();
  if (pidfd_ >= 0) close(std::exchange(pidfd_, -1));
  if (output_ >= 0) close(std::exchange(output_, -1));
}

bool Child::Ended() {
  if (pid_ < 0) return true;
  int status = 0;
  const pid_t waited = waitpid(pid_, &status, WNOHANG);
  if (waited == 0 || (waited < 0 && errno == EINTR)) return false;
  code_ = waited == pid_ ? CodeOf(status) : 0;
  pid_ = -1;
  return true;
}

int Child::Wait() {
  while (pid_ >= 0) {
    int status = 0;
    const pid_t waited = waitpid(pid_, &status, 0);
    if (waited < 0 && errno == EINTR) continue;
    code_ = waited == pid_ ? CodeOf(status) : 0;
    pid_ = -1;
  }
  return code_;
}

void Child::Kill() {
  if (pid_ < 0) return;
  kill(pid_, SIGKILL);
  Wait();
}

}  // namespace beckon::ui_bridge
