// Keeps processes running: starts them, starts them again with growing patience when they die, says
// why they die, and ends them all.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "services/base/run_loop.h"
#include "services/base/utime.h"
#include "tools/beckon/back_off.h"
#include "tools/beckon/child_process.h"

namespace beckon::tool {

/// The death of a supervised process.
struct Death {
  std::string name;
  Exit exit;
  std::string last_line;  // of its log: usually the reason
  int in_a_row = 1;       // deaths without ten healthy seconds between
  Utime alive_us = 0;
  std::optional<Utime> restart_us;  // until it is started again; nothing where it is not
};

/// Runs in `loop`'s thread. `steady` tells how long processes lived.
class Supervisor {
 public:
  enum class Restart { kAlways, kOnFailure, kNever };

  Supervisor(RunLoop& loop, const Clock& steady, std::function<void(const Death&)> on_death);
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// Fails where the program cannot be executed at all; then it is not tried again.
  Status Start(ProcessSpec spec, Restart restart = Restart::kAlways);

  /// Of a running process; nothing while it is down.
  std::optional<pid_t> Pid(const std::string& name) const;
  /// Sends a signal to one. A killed one is started again.
  void Signal(const std::string& name, int signal);

  /// Ends all: SIGTERM (`signal`), and SIGKILL after `patience_ms`. Waits until all are gone.
  /// Nothing is started again.
  void Stop(int patience_ms = 3000);
  /// The same for one; forgets it.
  void Stop(const std::string& name, int signal, int patience_ms);

 private:
  struct Entry;

  Status Launch(Entry& entry);
  void LaunchIn(Entry& entry, Utime delay_us);
  void OnEnded(const std::string& name);

  RunLoop& loop_;
  const Clock& steady_;
  const std::function<void(const Death&)> on_death_;
  std::map<std::string, std::unique_ptr<Entry>> entries_;
};

}  // namespace beckon::tool
