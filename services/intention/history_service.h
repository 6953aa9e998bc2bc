// Shares the history with other machines' intention services over HISTORY.
#pragma once

#include <functional>
#include <string>

#include "lcmtypes/messages.h"
#include "services/base/bus.h"
#include "services/base/run_loop.h"
#include "services/intention/core/history_sync.h"
#include "services/intention/core/name_watch.h"
#include "services/intention/store.h"

namespace beckon::intention {

class HistoryService {
 public:
  using Send = std::function<void(msg::History)>;

  /// Subscribes and begins to publish. Everything must outlive this.
  HistoryService(Store& store, Bus& bus, RunLoop& loop, const Clock& wall, Send send);
  ~HistoryService();

  /// Counters of the status, all "history.*".
  void Fill(msg::Status& status) const;
  /// What a person should know; empty: all is well.
  std::string Notice() const;

 private:
  Instant Now() const { return {steady_.Now(), wall_.Now()}; }
  void Hear(const msg::History& message);
  void Tick();
  void SendAll(std::vector<msg::History> messages);

  Store& store_;
  RunLoop& loop_;
  const Clock& wall_;
  const Send send_;
  const SteadyClock steady_;
  const std::string run_;
  HistorySync sync_;
  NameWatch watch_;
  std::string logged_;  // the last trouble
  Utime next_refresh_ = 0;
  RunLoop::TimerId timer_;
};

}  // namespace beckon::intention
