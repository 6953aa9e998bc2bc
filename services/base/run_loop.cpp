#include "services/base/run_loop.h"

#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "services/base/service_manager.h"

namespace beckon {
namespace {

int64_t MonotonicMicroseconds() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

int Checked(int result, const char* what) {
  if (result < 0) throw std::system_error(errno, std::generic_category(), what);
  return result;
}

}  // namespace

struct RunLoop::State {
  struct Timer {
    TimerId id;
    Utime period_us;  // 0 = once
    Callback callback;
  };

  int epoll_fd = -1;
  int wake_fd = -1;
  int signal_fd = -1;
  std::map<int, Callback> fds;
  std::multimap<int64_t, Timer> timers;  // by deadline, monotonic us
  TimerId next_timer = 1;
  std::atomic<bool> stopping{false};
  std::atomic<bool> interrupted{false};
  std::mutex mutex;
  std::vector<Callback> posted;
  std::optional<ServiceManager> manager;  // of the process's own loop

  void Watch(int fd) {
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.fd = fd;
    Checked(epoll_ctl(epoll_fd, EPOLL_CTL_ADD, fd, &event), "epoll_ctl");
  }

  void Wake() {
    const uint64_t one = 1;
    [[maybe_unused]] const auto written = write(wake_fd, &one, sizeof one);
  }

  TimerId AddTimer(Utime delay_us, Utime period_us, Callback callback) {
    const TimerId id = next_timer++;
    timers.emplace(MonotonicMicroseconds() + std::max<Utime>(delay_us, 1),
                   Timer{id, period_us, std::move(callback)});
    return id;
  }

  /// Milliseconds until the next timer, for epoll_wait; -1 without one.
  int Timeout() const {
    if (timers.empty()) return -1;
    const int64_t left_us = timers.begin()->first - MonotonicMicroseconds();
    return static_cast<int>(std::clamp<int64_t>((left_us + 999) / 1000, 0, 1'000'000));
  }

  void RunTimers() {
    const int64_t now = MonotonicMicroseconds();
    while (!stopping && !timers.empty() && timers.begin()->first <= now) {
      auto node = timers.extract(timers.begin());
      const Callback callback = node.mapped().callback;
      if (const Utime period = node.mapped().period_us; period > 0) {
        // A late timer skips the beats it missed.
        const int64_t due = node.key() + period;
        node.key() = due > now ? due : now + period;
        timers.insert(std::move(node));
      }
      callback();
    }
  }

  void RunPosted() {
    std::vector<Callback> work;
    {
      std::lock_guard lock(mutex);
      work.swap(posted);
    }
    for (auto& callback : work) callback();
  }

  void Dispatch(int fd) {
    if (fd == wake_fd) {
      uint64_t count;
      [[maybe_unused]] const auto got = read(wake_fd, &count, sizeof count);
      RunPosted();
    } else if (fd == signal_fd) {
      signalfd_siginfo info;
      if (read(signal_fd, &info, sizeof info) == sizeof info) {
        interrupted = true;
        stopping = true;
      }
    } else if (const auto found = fds.find(fd); found != fds.end()) {
      const Callback callback = found->second;  // it may remove itself
      callback();
    }
  }
};

RunLoop::RunLoop(bool handle_signals) : state_(std::make_unique<State>()) {
  state_->epoll_fd = Checked(epoll_create1(EPOLL_CLOEXEC), "epoll_create1");
  state_->wake_fd = Checked(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK), "eventfd");
  state_->Watch(state_->wake_fd);
  if (handle_signals) {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    state_->signal_fd = Checked(signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK), "signalfd");
    state_->Watch(state_->signal_fd);
    state_->manager.emplace(ServiceManager::TakeFromEnvironment());
    if (const auto period_us = state_->manager->alive_period_us())
      Every(*period_us, [this] { state_->manager->TellAlive(); });
  }
}

RunLoop::~RunLoop() {
  for (int fd : {state_->epoll_fd, state_->wake_fd, state_->signal_fd}) {
    if (fd >= 0) close(fd);
  }
}

void RunLoop::AddFd(int fd, Callback readable) {
  state_->fds[fd] = std::move(readable);
  state_->Watch(fd);
}

void RunLoop::RemoveFd(int fd) {
  if (state_->fds.erase(fd) > 0) epoll_ctl(state_->epoll_fd, EPOLL_CTL_DEL, fd, nullptr);
}

RunLoop::TimerId RunLoop::After(Utime delay_us, Callback callback) {
  return state_->AddTimer(delay_us, 0, std::move(callback));
}

RunLoop::TimerId RunLoop::Every(Utime period_us, Callback callback) {
  return state_->AddTimer(period_us, std::max<Utime>(period_us, 1), std::move(callback));
}

void RunLoop::Cancel(TimerId timer) {
  std::erase_if(state_->timers, [timer](const auto& entry) { return entry.second.id == timer; });
}

void RunLoop::Post(Callback work) {
  {
    std::lock_guard lock(state_->mutex);
    state_->posted.push_back(std::move(work));
  }
  state_->Wake();
}

void RunLoop::Run() {
  std::array<epoll_event, 16> events;
  if (state_->manager) state_->manager->TellReady();
  while (!state_->stopping) {
    const int n = epoll_wait(state_->epoll_fd, events.data(), events.size(), state_->Timeout());
    if (n < 0 && errno != EINTR)
      throw std::system_error(errno, std::generic_category(), "epoll_wait");
    for (int i = 0; i < n && !state_->stopping; ++i) state_->Dispatch(events[i].data.fd);
    state_->RunTimers();
  }
  state_->stopping = false;
  if (state_->manager) state_->manager->TellStopping();
}

void RunLoop::Stop() {
  state_->stopping = true;
  state_->Wake();
}

bool RunLoop::interrupted() const { return state_->interrupted; }

}  // namespace beckon
