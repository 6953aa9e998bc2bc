// Runs front ends on the bus: each has a Dialogue of its own, all share what is heard.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "services/base/bus.h"
#include "services/base/result.h"
#include "services/base/run_loop.h"
#include "services/ui_bridge/dialogue.h"
#include "services/ui_bridge/front_end.h"

namespace beckon::ui_bridge {

struct ServiceConfig {
  std::string user;
  std::string device;  // of a single front end; several are called DEVICE.NAME
  int exit_after_sessions = 0;
  Utime listen_us = DialogueConfig{}.listen_us;
};

/// `$USER`, with what user names may not hold replaced by '_'; "user" where there is none.
std::string DefaultUser();
/// "NAME@host".
std::string DefaultDevice(const std::string& front_end);
/// 1 .. 64 of [A-Za-z0-9_.-].
Status ValidateUser(const std::string& user);

class Service {
 public:
  /// `clock` and `steady` as in Dialogue; all outlive the service.
  Service(ServiceConfig config, Bus& bus, RunLoop& loop, const Clock& clock, const Clock& steady);
  ~Service();

  /// Adds one; call before Begin.
  Status Add(FrontEndFactory& factory);
  /// Subscribes, announces and lets every front end begin. The loop is stopped when all have
  /// finished.
  void Begin();
  /// For BECKON_STATUS.
  std::string State() const;

 private:
  class Line;  // a front end with its dialogue

  /// Of all front ends: they are in front of the same person.
  Status ChooseUser(const std::string& user);

  void StopWhenAllFinished();

  const ServiceConfig config_;
  Bus& bus_;
  RunLoop& loop_;
  const Clock& clock_;
  const Clock& steady_;
  std::vector<std::unique_ptr<Line>> lines_;
};

}  // namespace beckon::ui_bridge
