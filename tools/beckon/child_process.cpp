#include "tools/beckon/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <utility>

namespace beckon::tool {
namespace {

constexpr std::streamoff kTail = 4096;
constexpr size_t kLongestLine = 300;

void Redirect(const char* path, int flags, int to) {
  const int fd = open(path, flags, 0644);
  if (fd < 0) return;
  dup2(fd, to);
  if (fd > STDERR_FILENO) close(fd);
}

constexpr int kFirstListeningFd = 3;  // of systemd's protocol

/// Arguments and environment for exec, made before the fork.
struct Image {
  explicit Image(const ProcessSpec& spec) {
    argv.push_back(const_cast<char*>(spec.program.c_str()));
    for (const auto& arg : spec.args) argv.push_back(const_cast<char*>(arg.c_str()));
    argv.push_back(nullptr);
    for (char** variable = environ; *variable != nullptr; ++variable) {
      if (std::strncmp(*variable, "LISTEN_", 7) != 0) env.push_back(*variable);
    }
    if (spec.listening_fd >= 0) {
      env.push_back(listen_fds.data());
      env.push_back(listen_pid.data());
    }
    env.push_back(nullptr);
  }

  /// In the child: digits by hand, nothing may be allocated there.
  void WriteOwnPid() {
    auto pid = getpid();
    for (size_t i = listen_pid.size(); listen_pid[i - 1] != '='; --i, pid /= 10)
      listen_pid[i - 1] = static_cast<char>('0' + pid % 10);
  }

  std::string listen_fds = "LISTEN_FDS=1";
  std::string listen_pid = "LISTEN_PID=0000000000";
  std::vector<char*> argv;
  std::vector<char*> env;
};

/// Moves the socket to where the child looks for it; `report` may have to make room.
int PassSocket(int socket, int report) {
  if (report == kFirstListeningFd) report = fcntl(report, F_DUPFD_CLOEXEC, kFirstListeningFd + 1);
  if (socket == kFirstListeningFd) {
    fcntl(socket, F_SETFD, 0);
  } else {
    dup2(socket, kFirstListeningFd);
  }
  return report;
}

/// In the child, between fork and exec: system calls only. Tells `report` the error and ends.
[[noreturn]] void Become(const ProcessSpec& spec, Image& image, pid_t parent, int report) {
  if (!spec.terminal) {
    setpgid(0, 0);
    Redirect(spec.stdin_file.empty() ? "/dev/null" : spec.stdin_file.c_str(), O_RDONLY,
             STDIN_FILENO);
    Redirect(spec.log_file.empty() ? "/dev/null" : spec.log_file.c_str(),
             O_WRONLY | O_CREAT | O_APPEND, STDOUT_FILENO);
    dup2(STDOUT_FILENO, STDERR_FILENO);
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  for (const int s : {SIGINT, SIGTERM, SIGPIPE, SIGHUP}) signal(s, SIG_DFL);
  if (spec.listening_fd >= 0) {
    report = PassSocket(spec.listening_fd, report);
    image.WriteOwnPid();
  }
  execvpe(image.argv[0], image.argv.data(), image.env.data());
  const int error = errno;
  [[maybe_unused]] const auto told = write(report, &error, sizeof error);
  _exit(127);
}

Exit FromStatus(int status) {
  if (WIFSIGNALED(status)) return {.code = 0, .signal = WTERMSIG(status)};
  return {.code = WEXITSTATUS(status), .signal = 0};
}

}  // namespace

std::string Exit::Text() const {
  if (signal != 0)
    return "killed by signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
  return "exit code " + std::to_string(code);
}

Result<ChildProcess> ChildProcess::Start(const ProcessSpec& spec) {
  Image image(spec);
  std::array<int, 2> report;
  if (pipe2(report.data(), O_CLOEXEC) != 0)
    return Error{spec.name + ": no pipe: " + std::strerror(errno)};
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) Become(spec, image, parent, report[1]);
  close(report[1]);
  int error = pid < 0 ? errno : 0;
  if (pid > 0 && read(report[0], &error, sizeof error) > 0) waitpid(pid, nullptr, 0);
  close(report[0]);
  if (error != 0) {
    return Error{spec.name + ": " + spec.program + " cannot be started: " + std::strerror(error)};
  }
  return ChildProcess(pid, static_cast<int>(syscall(SYS_pidfd_open, pid, 0)), !spec.terminal);
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept { *this = std::move(other); }

ChildProcess& ChildProcess::operator=(ChildProcess&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(fd_, other.fd_);
  std::swap(own_group_, other.own_group_);
  std::swap(exit_, other.exit_);
  return *this;
}

ChildProcess::~ChildProcess() {
  if (pid_ < 0) return;
  if (!Poll()) {
    Signal(SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  close(fd_);
}

std::optional<Exit> ChildProcess::Poll() {
  int status = 0;
  if (!exit_ && waitpid(pid_, &status, WNOHANG) == pid_) exit_ = FromStatus(status);
  return exit_;
}

void ChildProcess::Signal(int signal) {
  if (!exit_) kill(own_group_ ? -pid_ : pid_, signal);
}

std::optional<Exit> ChildProcess::Wait(int timeout_ms) {
  pollfd ended{.fd = fd_, .events = POLLIN, .revents = 0};
  while (!exit_ && poll(&ended, 1, timeout_ms) < 0 && errno == EINTR) {
  }
  return Poll();
}

std::string LastLine(const std::string& log_file) {
  std::ifstream log(log_file);
  if (!log) return {};
  log.seekg(0, std::ios::end);
  log.seekg(std::max<std::streamoff>(0, log.tellg() - kTail));
  std::string last;
  for (std::string line; std::getline(log, line);) {
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  }
  // "2026-01-31 10:00:00.000 " at its head is of no use to who reads it at once.
  if (last.size() > 24 && last[4] == '-' && last[7] == '-' && last[10] == ' ' && last[19] == '.')
    last.erase(0, 24);
  return last.substr(0, kLongestLine);
}

}  // namespace beckon::tool
