// Stands in for the robot arm: takes each task once, says so, and does nothing.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "lcmtypes/messages.h"
#include "services/base/utime.h"

namespace beckon::tool {

class SimulatedRobot {
 public:
  /// What to publish for a TASK that arrived. A task seen before is only acknowledged again; one
  /// that has expired, or that comes while stopped, is refused.
  std::vector<msg::TaskStatus> OnTask(const msg::Task& task, Utime now);
  /// A robot stops by itself on REQUEST_STOP.
  void OnSession(const msg::Session& message);

  int tasks_done() const { return static_cast<int>(done_.size()); }
  bool stopped() const { return stopped_; }

 private:
  std::set<std::string> done_;  // task ids
  bool stopped_ = false;
};

}  // namespace beckon::tool
