// Plain structs of every message: what services work with. The .lcm files document each field
// (units, frames, ranges); codec.h converts and validates.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "services/base/geometry.h"
#include "services/base/rgbd.h"
#include "services/base/rim.h"
#include "services/base/utime.h"

namespace beckon::msg {

/// Most objects a scene may hold.
inline constexpr int kMaxObjects = 64;
/// Most grasps, other shapes and parts that are told of an object.
inline constexpr int kMaxGrasps = 16;
inline constexpr int kMaxAlternatives = 4;
inline constexpr int kMaxParts = 8;
/// A control message fits one datagram.
inline constexpr size_t kMaxDatagram = 60'000;
/// Category of an object that fits none.
inline constexpr char kUnknownCategory[] = "Unknown";

enum class DepthCodec : int8_t { kPng = 1 };
enum class ColourCodec : int8_t { kNone = 0, kJpeg = 1, kPng = 2 };

/// An image as it travels; frame_image.h turns it into an RgbdImage and back.
struct Frame {
  Utime utime = 0;
  int64_t seq = 0;
  std::string source;
  int width = 0;
  int height = 0;
  Intrinsics intrinsics;
  DepthCodec depth_codec = DepthCodec::kPng;
  double depth_unit_m = 0.0001;
  std::vector<uint8_t> depth;
  ColourCodec colour_codec = ColourCodec::kNone;
  std::vector<uint8_t> colour;
};

struct Seal {
  std::string sender;
  int64_t counter = 0;
  Utime expires_utime = 0;
  std::array<uint8_t, 8> key_id{};
  std::array<uint8_t, 64> signature{};
};

struct CategoryProbability {
  std::string category;
  float probability = 0;
};

struct SceneObject {
  int id = 0;
  std::string category = kUnknownCategory;
  float confidence = 0;
  bool ask_user = false;
  std::vector<CategoryProbability> probabilities;  // most probable first
  Eigen::Vector3d centroid_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d extent_W = Eigen::Vector3d::Zero();
  int n_points = 0;
  std::vector<Eigen::Vector3f> points_C;  // quantised to 0.1 mm on the wire, at most 4096
  std::vector<RimPoint> rim_C;            // quantised likewise, at most kMaxRim
  std::vector<std::array<int16_t, 2>> outline_px;
};

struct Scene {
  Utime utime = 0;
  int64_t seq = 0;
  int64_t frame_seq = 0;
  std::string source;
  int width = 0;
  int height = 0;
  Intrinsics intrinsics;
  bool has_table = false;
  Pose X_WC = Pose::Identity();
  std::vector<Eigen::Vector2d> table_W;
  std::vector<SceneObject> objects;
  float segmentation_ms = 0;
  float categorisation_ms = 0;
  Seal seal;
};

struct Grasp {
  Pose X_WG = Pose::Identity();
  double opening_m = 0;
  float score = 0;
};

struct SuperquadricShape {
  Pose X_WO = Pose::Identity();
  std::array<double, 3> semi_axes{};  // m
  std::array<double, 2> epsilon{1, 1};
  std::array<double, 2> taper{};
};

struct ObjectPose {
  int object_id = 0;
  Pose X_WO = Pose::Identity();
  std::array<double, 3> semi_axes{};  // m
  std::array<double, 2> epsilon{1, 1};
  std::array<double, 2> taper{};
  float mean_radial_distance_m = 0;
  bool converged = false;
  bool ambiguous = false;
  std::string reason;
  Eigen::Matrix<float, 6, 6> covariance = Eigen::Matrix<float, 6, 6>::Zero();
  std::vector<SuperquadricShape> alternatives;  // likeliest first
  std::vector<SuperquadricShape> parts;         // none, or at least two
  std::vector<Grasp> grasps;
  float fit_ms = 0;
};

struct Poses {
  Utime utime = 0;
  int64_t seq = 0;
  int64_t scene_seq = 0;
  std::vector<ObjectPose> poses;
  Seal seal;
};

/// Sender, validity and signature of a control message. Unsigned where the key is all zeros.
enum class InterfaceKind : int8_t { kYesNo = 1, kChoice = 2, kScan = 3, kVector = 4 };

struct Interface {
  Utime utime = 0;
  std::string device;
  InterfaceKind kind = InterfaceKind::kYesNo;
  int max_options = 2;
  float seconds_per_question = 8;
  float seconds_per_option = 0;
  float false_yes = 0;
  float false_no = 0;
  std::vector<std::vector<float>> confusion;  // square, or empty
  Seal seal;
};

struct ObjectRef {
  int object_id = 0;
  std::string category;
  int instance = 1;  // 1 = the nearest of its category
};

/// An answer to choose. The wanted action is one of `actions` and the wanted object one of
/// `objects` (ids), where empty means any; the last option of a choice has neither.
struct Option {
  std::string text;
  std::string category;  // of a "what is it?" question
  std::vector<std::string> actions;
  std::vector<int> objects;
};

/// What an option leads to.
struct Prospect {
  float probability = 0;
  float questions_left = 0;
  float seconds_left = 0;
};

/// A task that may be meant.
struct Candidate {
  std::string action;
  ObjectRef object;
  double prior = 0;
  double posterior = 0;
  int times = 0;
  int sessions_ago = 0;  // 0 = never
};

/// Most candidates that a query names.
inline constexpr int kMaxCandidates = 8;

enum class QueryKind : int8_t {
  kAction = 1,
  kObject = 2,
  kFull = 3,
  kCategory = 4,
  kSet = 5,
  kChoice = 6,
  kWhatIsIt = 7
};

/// "action", "object", "full", "category", "set", "choice", "what_is_it".
const char* Name(QueryKind kind);

struct Query {
  Utime utime = 0;
  int64_t id = 0;
  std::string session_id;
  std::string user;
  QueryKind kind = QueryKind::kFull;
  std::string text;
  bool any_action = true;
  std::vector<std::string> actions;
  bool any_object = true;
  std::vector<ObjectRef> objects;
  std::vector<Option> options;  // yes/no: exactly Yes, No
  int64_t scene_seq = 0;
  int questions_asked = 0;
  int n_candidates = 0;
  double expected_questions = 0;
  double expected_seconds = 0;
  double best_posterior = 0;
  std::string why;
  double information_bits = 0;
  std::vector<Prospect> prospects;   // one an option, or none
  std::vector<Candidate> likeliest;  // likeliest first
  Seal seal;
};

struct Answer {
  Utime utime = 0;
  int64_t query_id = 0;
  std::string session_id;
  std::string device;
  std::vector<double> likelihoods;  // one an option
  Seal seal;
};

enum class SessionKind : int8_t {
  kRequestStart = 1,
  kRequestCancel = 2,
  kRequestUndo = 3,
  kRequestStop = 4,
  kRequestResume = 5,
  kRequestNoneOfThese = 6,
  kRequestProfile = 7,
  kIdle = 16,
  kBegun = 17,
  kConfirmed = 18,
  kAbandoned = 19,
  kStopped = 20
};

struct Session {
  Utime utime = 0;
  std::string session_id;
  std::string user;
  std::string device;
  SessionKind kind = SessionKind::kIdle;
  int questions = 0;
  std::string text;
  Seal seal;
};

struct Task {
  Utime utime = 0;
  std::string task_id;
  std::string user;
  std::string action;
  ObjectRef object;
  Eigen::Vector3d centroid_W = Eigen::Vector3d::Zero();
  bool has_pose = false;
  ObjectPose pose;  // semi-axes may be 0 where has_pose is false
  Pose X_WC = Pose::Identity();
  double posterior = 0;
  int questions = 0;
  Utime expires_utime = 0;
  Seal seal;
};

enum class TaskState : int8_t {
  kAccepted = 1,
  kRunning = 2,
  kDone = 3,
  kFailed = 4,
  kExpired = 5,
  kRevoked = 6
};

/// "accepted", "running", "done", "failed", "expired", "revoked".
const char* Name(TaskState state);

struct TaskStatus {
  Utime utime = 0;
  std::string task_id;
  TaskState state = TaskState::kAccepted;
  std::string text;
  Seal seal;
};

enum class LabelState : int8_t { kGiven = 1, kRetracted = 2 };

/// What the user said an object is.
struct Label {
  Utime utime = 0;
  std::string label_id;
  std::string session_id;
  std::string user;
  LabelState state = LabelState::kGiven;
  std::string category = kUnknownCategory;
  std::string source;
  int64_t scene_seq = 0;
  Utime scene_utime = 0;
  int object_id = 0;
  Seal seal;
};

/// A session of a user's past, for people to look at.
struct PastSession {
  Utime utime = 0;
  std::string action;
  std::string category;
  int instance = 1;
  int questions = 0;
  std::string device;
};

/// Most users and past sessions that a profile names.
inline constexpr int kMaxUsers = 64;
inline constexpr int kMaxPastSessions = 200;

/// Whom intention knows, and one user's past.
struct Profile {
  Utime utime = 0;
  std::string user;
  std::vector<std::string> users;
  int n_sessions = 0;
  std::vector<PastSession> recent;  // oldest first
  Seal seal;
};

/// What a scanning front end points at.
struct Highlight {
  Utime utime = 0;
  std::string device;
  std::string user;
  int64_t query_id = 0;
  std::vector<int> options;
  std::vector<std::string> controls;
  bool pressed = false;
  bool paused = false;
  int dwell_ms = 0;
  Seal seal;
};

enum class StimulusMode : int8_t { kMatrix = 1, kBinary = 2 };

/// What a decoder of brain signals is to decode.
struct Stimulus {
  Utime utime = 0;
  std::string device;
  int64_t trial = 0;
  int64_t query_id = 0;
  int repetition = 1;
  StimulusMode mode = StimulusMode::kMatrix;
  int rows = 1;
  int columns = 2;
  std::vector<std::string> labels;  // one a class, row by row
  Seal seal;
};

/// What it made of that.
struct Decoding {
  Utime utime = 0;
  std::string decoder;
  std::string device;
  int64_t trial = 0;
  std::vector<double> probabilities;  // one a class, sum 1
  Seal seal;
};

struct HistoryDigest {
  std::string origin;
  int64_t highest_seq = 0;
  int64_t checksum = 0;
};

struct HistoryRow {
  std::string origin;
  int64_t seq = 0;
  Utime hybrid_utime = 0;
  std::string kind;
  std::string body;  // JSON
};

struct History {
  Utime utime = 0;
  std::string machine;
  std::string run;
  bool complete = true;
  std::vector<HistoryDigest> digests;
  std::vector<HistoryRow> rows;
  int refused_rows = 0;  // as received: rows left out because they are damaged; not sent
  Seal seal;
};

struct Lease {
  Utime utime = 0;
  std::string user;
  std::string session_id;
  std::string holder;
  std::string run;
  int64_t term = 0;
  int remaining_ms = 0;
  Seal seal;
};

/// Most counters of a STATUS.
inline constexpr int kMaxCounters = 128;

struct Counter {
  std::string name;
  int64_t value = 0;
};

struct Status {
  Utime utime = 0;
  std::string service;
  std::string host;
  int pid = 0;
  Utime started_utime = 0;
  std::string build;
  std::string state;
  std::vector<Counter> counters;
};

}  // namespace beckon::msg
