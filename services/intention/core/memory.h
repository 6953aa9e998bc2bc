// What the conversation wants to be remembered, and the port through which it is. The SQLite store
// is behind it in the service, a plain list in tests.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/messages.h"
#include "services/base/result.h"
#include "services/intention/core/policy.h"

namespace beckon::intention {

/// What became of an answer in its session.
enum class AnswerFate {
  kStands,
  kWithdrawn,  // the user took it back
  kDropped     // the session started over: what was wanted until then is not known
};

/// An answer of a confirmed session, as evidence about the device's errors.
struct AnswerRecord {
  QuestionKind kind = QuestionKind::kFull;
  std::vector<double> likelihoods;  // as received, by answer; yes and no where there are two
  int meant = 0;                    // index of the answer that the confirmed task makes right
  std::string device;               // that it came from
  AnswerFate fate = AnswerFate::kStands;
};

/// A confirmed session.
struct SessionRecord {
  std::string session_id;
  std::string user;
  std::string device;  // that requested it
  Utime utime = 0;     // when it was confirmed
  std::string category;
  std::string action;
  int instance = 1;
  int questions = 0;
  double posterior = 0;
  std::map<std::string, int> present;  // instances on the table, by category; empty: not recorded
  std::vector<AnswerRecord> answers;
};

/// For a policy to learn from; sessions of categories and actions that are no longer known are left
/// out.
UserHistory ToHistory(const std::vector<SessionRecord>& sessions, const Affordances& affordances);

/// What the user said an object is, with what it takes to recognise the object.
struct LabelRecord {
  std::string id;          // unique
  std::string session_id;  // in which it was said
  std::string user;
  Utime utime = 0;
  std::string category;  // "Unknown": none of the known ones
  std::string source;    // scene_t.source
  Eigen::Vector3d centroid_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d extent_W = Eigen::Vector3d::Zero();
  std::vector<msg::CategoryProbability> probabilities;  // perception's, of the object
};

/// Durable: what returned successfully survives a power cut.
class Memory {
 public:
  virtual ~Memory() = default;

  /// Oldest first, without what was forgotten.
  virtual Result<std::vector<SessionRecord>> SessionsOf(const std::string& user) = 0;
  /// All that have a session which is not forgotten, the latest first.
  virtual Result<std::vector<std::string>> Users() = 0;
  /// Oldest first.
  virtual Result<std::vector<LabelRecord>> LabelsOf(const std::string& source) = 0;
  /// Also sessions that were forgotten: their ids are taken.
  virtual Result<std::optional<SessionRecord>> FindSession(const std::string& session_id) = 0;

  /// All of it or nothing. False: a session of this id is there already, nothing was written.
  virtual Result<bool> Commit(const SessionRecord& session, const std::vector<LabelRecord>& labels,
                              const msg::Task& task) = 0;
  virtual Status CommitLabels(const std::vector<LabelRecord>& labels) = 0;

  /// Tasks committed here that no TASK_STATUS has named.
  virtual Result<std::vector<msg::Task>> OpenTasks() = 0;
  virtual Status NoteTask(const std::string& task_id, msg::TaskState state, Utime now) = 0;

  /// Whether everything is stopped: outlives the process, only "resume" leads out of it.
  virtual Result<bool> Stopped() = 0;
  virtual Status SetStopped(bool stopped, Utime now) = 0;
};

}  // namespace beckon::intention
