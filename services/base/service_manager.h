// What systemd is told of this process: that it is ready, alive, stopping. Its protocol is a
// datagram of KEY=VALUE lines (sd_notify(3)), so that no library of its is needed.
#pragma once

#include <optional>
#include <string>

#include "services/base/utime.h"

namespace beckon {

/// Silent in a process that no service manager waits for.
class ServiceManager {
 public:
  /// The one that $NOTIFY_SOCKET names. Takes $NOTIFY_SOCKET, $WATCHDOG_USEC and $WATCHDOG_PID out
  /// of the environment: what this process starts must not speak in its name. Call before starting
  /// threads.
  static ServiceManager TakeFromEnvironment();

  ServiceManager() = default;
  ServiceManager(ServiceManager&& other) noexcept;
  ServiceManager& operator=(ServiceManager&&) = delete;
  ~ServiceManager();

  void TellReady() const { Tell("READY=1"); }
  void TellAlive() const { Tell("WATCHDOG=1"); }
  void TellStopping() const { Tell("STOPPING=1"); }

  /// How often it is to be told that this process is alive: twice as often as it must. Nothing
  /// where it does not watch this process.
  std::optional<Utime> alive_period_us() const { return alive_period_us_; }

 private:
  void Tell(const std::string& what) const;

  int fd_ = -1;  // connected; -1: nobody listens
  std::optional<Utime> alive_period_us_;
};

}  // namespace beckon
