// The same work for many items, on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace beckon::perception {

/// Told how many of how many are done, one call at a time; false: stop.
using StepProgress = std::function<bool(size_t done, size_t total)>;

/// Calls work(0) .. work(count - 1), each once, on up to `threads` threads, in no order; returns
/// when all are done, or false when `progress` (may be empty) wanted to stop. An exception of
/// `work` ends it too and is thrown on.
bool ParallelFor(size_t count, int threads, const std::function<void(size_t)>& work,
                 const StepProgress& progress = {});

}  // namespace beckon::perception
