// Reading a folder's views, several at a time, for whatever is made of each.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "services/perception/train_data.h"
#include "services/perception/train_parallel.h"
#include "services/base/progress.h"

namespace beckon::perception {

using Skipped = std::map<std::string, std::string>;  // file -> why

/// Reads `records`, several at a time, and makes of each what `make` does; names those that cannot
/// be used. One entry a record, in their order whatever the threads do; false where it was told to
/// stop.
template <typename Made>
bool ReadAll(const std::vector<ViewRecord>& records, const std::string& step, int threads,
             const std::function<Result<Made>(const ObjectView&)>& make, Progress& progress,
             std::vector<std::optional<Made>>& made, Skipped& skipped) {
  made.resize(records.size());
  std::vector<std::string> why(records.size());
  const bool whole = ParallelFor(
      records.size(), threads,
      [&](size_t i) {
        const Result<LoadedView> view = LoadView(records[i]);
        Result<Made> result = view ? make(view->view()) : Result<Made>(view.error());
        if (result) {
          made[i] = std::move(*result);
        } else {
          why[i] = result.error().message;
        }
      },
      [&](size_t done, size_t total) { return progress.Tell(step, done, total); });
  for (size_t i = 0; i < records.size(); ++i) {
    if (why[i].empty() || skipped.contains(records[i].file)) continue;
    progress.Say("skipped " + records[i].file + ": " + why[i]);
    skipped[records[i].file] = why[i];
  }
  return whole;
}

/// Takes away the records nothing was made of; `made` keeps its order.
template <typename Made>
void KeepMade(std::vector<ViewRecord>& records, std::vector<std::optional<Made>>& made) {
  std::vector<ViewRecord> used;
  for (size_t i = 0; i < records.size(); ++i) {
    if (made[i]) used.push_back(std::move(records[i]));
  }
  records = std::move(used);
  std::erase_if(made, [](const auto& entry) { return !entry; });
}

}  // namespace beckon::perception
