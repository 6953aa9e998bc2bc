// The intention service: the conversation on the bus, with its memory on disk.
#pragma once

#include <memory>
#include <string>

#include "services/base/bus.h"
#include "services/base/config.h"
#include "services/base/run_loop.h"
#include "services/base/utime.h"

namespace beckon::intention {

struct ServiceConfig {
  std::string db;                   // file; empty: $XDG_DATA_HOME/beckon/beckon.db
  std::string policy = "adaptive";  // or "oain"
  std::string queries = "all";      // or "aof": action, object and full questions only
  std::string affordances;          // file; empty: the one that ships with Beckon
  std::string phrases;              // file of the words; empty: the one that ships with Beckon
  std::string machine;              // name of this machine in the history; empty: its host name
  bool share_history = true;        // with the intention services of other machines on the bus
  double task_lifetime_s = 30;      // a task that no robot took by then is void
  double scene_max_age_s = 5;       // no session begins on a scene that arrived longer ago
};

/// Reads the keys above and fills in the defaults that depend on the machine.
Result<ServiceConfig> ReadServiceConfig(ConfigTable table);
void FillDefaults(ServiceConfig& config);

class Service {
 public:
  /// Opens the database, subscribes, publishes what an earlier run left. `bus`, `loop` and `clock`
  /// must outlive the service; the loop is not started here.
  static Result<std::unique_ptr<Service>> Start(const ServiceConfig& config, Bus& bus,
                                                RunLoop& loop, const Clock& clock);
  ~Service();

 private:
  struct State;
  explicit Service(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace beckon::intention
