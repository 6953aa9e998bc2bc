// TASK: what the robot is to do.
#include <beckon/task_t.hpp>

#include "lcmtypes/codec.h"
#include "lcmtypes/codec/message.h"
#include "lcmtypes/codec/parts.h"

namespace beckon {
namespace codec {

static void Walk(Walker& w, const task_t*) {
  w.Skip(8);
  w.String("task_id", kMaxName);
  w.String("user", kMaxName);
  w.String("action", kMaxName);
  Walk(w, static_cast<const object_ref_t*>(nullptr));
  w.Skip(3 * 8 + 1);
  Walk(w, static_cast<const object_pose_t*>(nullptr));
  w.Skip(7 * 8 + 8 + 4 + 8);
  Walk(w, static_cast<const seal_t*>(nullptr));
}

static Status Check(const msg::Task& task) {
  Rules rules("task");
  rules.Time(task.utime)
      .Name(task.task_id, "task_id")
      .Name(task.user, "user")
      .Name(task.action, "action")
      .Require(Check(task.object))
      .Require(Finite(task.centroid_W) && task.centroid_W.norm() < 1000,
               "centroid_W is not a place")
      .Require(Sane(task.X_WC), "X_WC is not a pose")
      .Range(task.posterior, "posterior", 0, 1)
      .Require(task.questions >= 0, "questions is negative")
      .Require(task.expires_utime > task.utime, "expires before it is confirmed")
      .Require(Check(task.seal));
  if (task.has_pose) rules.Require(Check(task.pose));
  return rules;
}

/// What stands in `pose` where there is none: valid, and a millimetre in size.
static msg::ObjectPose NoPose() {
  msg::ObjectPose pose;
  pose.object_id = 1;
  pose.semi_axes = {1e-3, 1e-3, 1e-3};
  return pose;
}

static task_t ToWire(const msg::Task& task) {
  task_t wire{};
  wire.utime = task.utime;
  wire.task_id = task.task_id;
  wire.user = task.user;
  wire.action = task.action;
  wire.object = ToWire(task.object);
  ToArray(task.centroid_W, wire.centroid_W);
  wire.has_pose = task.has_pose;
  wire.pose = ToWire(task.has_pose ? task.pose : NoPose());
  PoseToArrays(task.X_WC, wire.X_WC_position, wire.X_WC_rotation);
  wire.posterior = task.posterior;
  wire.questions = task.questions;
  wire.expires_utime = task.expires_utime;
  wire.seal = ToWire(task.seal);
  return wire;
}

static Result<msg::Task> FromWire(const task_t& wire) {
  if (!IsBool(wire.has_pose)) return Error{"has_pose is neither 0 nor 1"};
  const auto X_WC = PoseFromArrays(wire.X_WC_position, wire.X_WC_rotation);
  if (!X_WC) return X_WC.error();
  msg::Task task;
  task.utime = wire.utime;
  task.task_id = wire.task_id;
  task.user = wire.user;
  task.action = wire.action;
  task.object = FromWire(wire.object);
  task.centroid_W = FromArray(wire.centroid_W);
  task.has_pose = wire.has_pose != 0;
  if (task.has_pose) {
    auto pose = FromWire(wire.pose);
    if (!pose) return pose.error();
    task.pose = *std::move(pose);
  }
  task.X_WC = *X_WC;
  task.posterior = wire.posterior;
  task.questions = wire.questions;
  task.expires_utime = wire.expires_utime;
  task.seal = FromWire(wire.seal);
  return task;
}

}  // namespace codec

BECKON_DEFINE_CODEC(Task, task_t)

}  // namespace beckon
