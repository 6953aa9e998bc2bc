// One pair of ears on the bus: follows the conversations, plays the robot, remembers what services
// say of themselves.
#pragma once

#include <map>
#include <string>

#include "services/base/bus.h"
#include "services/base/utime.h"
#include "tools/beckon/session_observer.h"
#include "tools/beckon/simulated_robot.h"

namespace beckon::tool {

class BusWatch {
 public:
  /// Subscribes; `bus` and the clocks must outlive it, `clock` for messages, `steady` for
  /// durations.
  BusWatch(Bus& bus, const Clock& clock, const Clock& steady, std::string user,
           std::function<void(const SessionRecord&)> on_end);

  const SessionObserver& observer() const { return observer_; }
  const SimulatedRobot& robot() const { return robot_; }
  /// The latest status of a service; null where it was not heard.
  const msg::Status* StatusOf(const std::string& service) const;
  /// "perception says 'no table in view'", "nothing is heard of perception".
  std::string Says(const std::string& service) const;

 private:
  Bus& bus_;
  const Clock& clock_;
  const Clock& steady_;
  SessionObserver observer_;
  SimulatedRobot robot_;
  std::map<std::string, msg::Status> statuses_;
};

}  // namespace beckon::tool
