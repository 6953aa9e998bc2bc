// What several messages contain: names, numbers, poses, seals, object references, object poses.
#pragma once

#include <beckon/object_pose_t.hpp>
#include <beckon/object_ref_t.hpp>
#include <beckon/seal_t.hpp>
#include <cmath>
#include <string>

#include "lcmtypes/codec/walker.h"
#include "lcmtypes/messages.h"
#include "services/base/result.h"

namespace beckon::codec {

inline constexpr int kMaxName = 64;    // categories, actions, users, counters
inline constexpr int kMaxText = 1024;  // sentences, file names
inline constexpr int kMaxOptions = 64;

/// Checks in the order written; the first that fails is reported as "<type>: <what>".
class Rules {
 public:
  explicit Rules(const char* type) : type_(type) {}

  Rules& Require(bool holds, const std::string& what) {
    if (!holds && status_) status_ = Error{std::string(type_) + ": " + what};
    return *this;
  }
  Rules& Require(const Status& part) {
    if (!part) Require(false, part.error().message);
    return *this;
  }
  /// At most `max` bytes without control characters (a message must not steer anybody's terminal).
  Rules& Text(const std::string& text, const char* field, size_t max = kMaxText);
  /// The same, and not empty.
  Rules& Name(const std::string& name, const char* field, size_t max = kMaxName);
  Rules& Count(size_t n, const char* field, size_t max, size_t min = 0);
  Rules& Range(double value, const char* field, double min, double max);
  Rules& Time(Utime utime);

  operator Status() const { return status_; }  // NOLINT: implicit

 private:
  const char* type_;
  Status status_;
};

template <typename Derived>
bool Finite(const Eigen::MatrixBase<Derived>& m) {
  return m.allFinite();
}

/// A rotation and a finite position within 1 km.
bool Sane(const Pose& pose);

template <typename T>
void ToArray(const Eigen::Vector3d& v, T (&out)[3]) {
  for (int i = 0; i < 3; ++i) out[i] = v[i];
}
inline Eigen::Vector3d FromArray(const double (&v)[3]) { return {v[0], v[1], v[2]}; }

void PoseToArrays(const Pose& pose, double (&position)[3], double (&rotation)[4]);
Result<Pose> PoseFromArrays(const double (&position)[3], const double (&rotation)[4]);

/// Users name rows and files: letters, digits, _ . - only.
bool IsUserName(const std::string& name);

/// LCM booleans are int8; anything but 0 and 1 is damage.
inline bool IsBool(int8_t value) { return value == 0 || value == 1; }

void Walk(Walker& w, const seal_t*);
Status Check(const msg::Seal& seal);
seal_t ToWire(const msg::Seal& seal);
msg::Seal FromWire(const seal_t& wire);

void Walk(Walker& w, const object_ref_t*);
Status Check(const msg::ObjectRef& object);
object_ref_t ToWire(const msg::ObjectRef& object);
msg::ObjectRef FromWire(const object_ref_t& wire);

void Walk(Walker& w, const object_pose_t*);
Status Check(const msg::ObjectPose& pose);
object_pose_t ToWire(const msg::ObjectPose& pose);
Result<msg::ObjectPose> FromWire(const object_pose_t& wire);

}  // namespace beckon::codec
