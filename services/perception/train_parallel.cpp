// Threads that take the next item until none is left.
#include "services/perception/train_parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace beckon::perception {

bool ParallelFor(size_t count, int threads, const std::function<void(size_t)>& work,
                 const StepProgress& progress) {
  std::atomic<size_t> next = 0;
  std::atomic<bool> stop = false;
  std::mutex mutex;
  size_t done = 0;
  std::exception_ptr failure;
  const auto take = [&] {
    for (size_t i; !stop && (i = next++) < count;) {
      try {
        work(i);
        const std::lock_guard lock(mutex);
        if (progress && !stop && !progress(++done, count)) stop = true;
      } catch (...) {  // must not leave a thread
        const std::lock_guard lock(mutex);
        failure = std::current_exception();
        stop = true;
      }
    }
  };
  {
    std::vector<std::jthread> others;
    const size_t wanted = std::min(count, static_cast<size_t>(std::max(threads, 1)));
    for (size_t i = 1; i < wanted; ++i) others.emplace_back(take);
    take();
  }
  if (failure) std::rethrow_exception(failure);
  return !stop;
}

}  // namespace beckon::perception
