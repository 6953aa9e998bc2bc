// TASK_STATUS: what became of a task.
#include <beckon/task_status_t.hpp>

#include "lcmtypes/codec.h"
#include "lcmtypes/codec/message.h"
#include "lcmtypes/codec/parts.h"

namespace beckon {

const char* msg::Name(TaskState state) {
  switch (state) {
    case TaskState::kAccepted:
      return "accepted";
    case TaskState::kRunning:
      return "running";
    case TaskState::kDone:
      return "done";
    case TaskState::kFailed:
      return "failed";
    case TaskState::kExpired:
      return "expired";
    case TaskState::kRevoked:
      return "revoked";
  }
  return "";
}

namespace codec {

static void Walk(Walker& w, const task_status_t*) {
  w.Skip(8);
  w.String("task_id", kMaxName);
  w.Skip(1);
  w.String("text", kMaxText);
  Walk(w, static_cast<const seal_t*>(nullptr));
}

static Status Check(const msg::TaskStatus& status) {
  return Rules("task status")
      .Time(status.utime)
      .Name(status.task_id, "task_id")
      .Range(static_cast<int>(status.state), "state", 1, 6)
      .Text(status.text, "text")
      .Require(Check(status.seal));
}

static task_status_t ToWire(const msg::TaskStatus& status) {
  task_status_t wire{};
  wire.utime = status.utime;
  wire.task_id = status.task_id;
  wire.state = static_cast<int8_t>(status.state);
  wire.text = status.text;
  wire.seal = ToWire(status.seal);
  return wire;
}

static Result<msg::TaskStatus> FromWire(const task_status_t& wire) {
  msg::TaskStatus status;
  status.utime = wire.utime;
  status.task_id = wire.task_id;
  status.state = static_cast<msg::TaskState>(wire.state);
  status.text = wire.text;
  status.seal = FromWire(wire.seal);
  return status;
}

}  // namespace codec

BECKON_DEFINE_CODEC(TaskStatus, task_status_t)

}  // namespace beckon
