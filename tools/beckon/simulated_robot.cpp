#include "tools/beckon/simulated_robot.h"

namespace beckon::tool {

std::vector<msg::TaskStatus> SimulatedRobot::OnTask(const msg::Task& task, Utime now) {
  msg::TaskStatus status;
  status.utime = now;
  status.task_id = task.task_id;
  status.seal.sender = "simulated-robot";
  std::vector<msg::TaskStatus> statuses;
  const auto say = [&](msg::TaskState state, const std::string& text) {
    status.state = state;
    status.text = text;
    statuses.push_back(status);
  };
  if (done_.contains(task.task_id)) {
    say(msg::TaskState::kDone, "done before");
  } else if (stopped_) {
    say(msg::TaskState::kFailed, "stopped");
  } else if (now > task.expires_utime) {
    say(msg::TaskState::kFailed, "came too late");
  } else {
    done_.insert(task.task_id);
    say(msg::TaskState::kAccepted, "");
    say(msg::TaskState::kDone, "it is a simulated one, nothing moved");
  }
  return statuses;
}

void SimulatedRobot::OnSession(const msg::Session& message) {
  if (message.kind == msg::SessionKind::kRequestStop) stopped_ = true;
  if (message.kind == msg::SessionKind::kRequestResume) stopped_ = false;
}

}  // namespace beckon::tool
