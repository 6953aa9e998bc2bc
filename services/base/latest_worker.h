// A worker thread that always takes the newest input: a slow computation skips what it cannot keep
// up with, and counts it, instead of falling behind.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

namespace beckon {

/// One thread, one slot. `Offer` replaces what is waiting; `work` runs in the worker's thread.
template <typename T>
class LatestWorker {
 public:
  explicit LatestWorker(std::function<void(T)> work)
      : work_(std::move(work)), thread_([this] { Loop(); }) {}
  ~LatestWorker() {
    {
      std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    changed_.notify_one();
    thread_.join();
  }

  void Offer(T input) {
    {
      std::lock_guard lock(mutex_);
      if (slot_) ++dropped_;
      slot_ = std::move(input);
    }
    changed_.notify_one();
  }

  /// Inputs that were replaced before they were taken.
  int64_t dropped() const {
    std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  void Loop() {
    for (;;) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return stopping_ || slot_; });
      if (stopping_) return;
      T input = std::move(*slot_);
      slot_.reset();
      lock.unlock();
      work_(std::move(input));
    }
  }

  std::function<void(T)> work_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<T> slot_;
  int64_t dropped_ = 0;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace beckon
