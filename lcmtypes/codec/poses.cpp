// POSES: the superquadrics of a scene's objects.
#include <beckon/poses_t.hpp>

#include "lcmtypes/codec.h"
#include "lcmtypes/codec/message.h"
#include "lcmtypes/codec/parts.h"

namespace beckon {
namespace codec {

static void Walk(Walker& w, const poses_t*) {
  w.Skip(3 * 8);
  const int32_t poses = w.Count("n_poses", msg::kMaxObjects);
  for (int32_t i = 0; i < poses && w.ok(); ++i) Walk(w, static_cast<const object_pose_t*>(nullptr));
  Walk(w, static_cast<const seal_t*>(nullptr));
}

static Status Check(const msg::Poses& poses) {
  Rules rules("poses");
  rules.Time(poses.utime)
      .Require(poses.seq >= 1 && poses.scene_seq >= 1, "seq is below 1")
      .Count(poses.poses.size(), "poses", msg::kMaxObjects)
      .Require(Check(poses.seal));
  for (const auto& pose : poses.poses) rules.Require(Check(pose));
  return rules;
}

static poses_t ToWire(const msg::Poses& poses) {
  poses_t wire{};
  wire.utime = poses.utime;
  wire.seq = poses.seq;
  wire.scene_seq = poses.scene_seq;
  wire.n_poses = static_cast<int32_t>(poses.poses.size());
  for (const auto& pose : poses.poses) wire.poses.push_back(ToWire(pose));
  wire.seal = ToWire(poses.seal);
  return wire;
}

static Result<msg::Poses> FromWire(const poses_t& wire) {
  msg::Poses poses;
  poses.utime = wire.utime;
  poses.seq = wire.seq;
  poses.scene_seq = wire.scene_seq;
  for (const auto& pose : wire.poses) {
    auto converted = FromWire(pose);
    if (!converted) return converted.error();
    poses.poses.push_back(*std::move(converted));
  }
  poses.seal = FromWire(wire.seal);
  return poses;
}

}  // namespace codec

BECKON_DEFINE_CODEC(Poses, poses_t)

}  // namespace beckon
