// Intention's memory as lists, for measurements that need no disk.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "services/intention/core/memory.h"

namespace beckon::bench {

class ListMemory final : public intention::Memory {
 public:
  Result<std::vector<intention::SessionRecord>> SessionsOf(const std::string&) override {
    return sessions_;  // all of one user
  }
  Result<std::vector<std::string>> Users() override { return std::vector<std::string>(); }
  Result<std::vector<intention::LabelRecord>> LabelsOf(const std::string&) override {
    return std::vector<intention::LabelRecord>();
  }
  Result<std::optional<intention::SessionRecord>> FindSession(const std::string& id) override {
    const auto found = std::find_if(sessions_.begin(), sessions_.end(),
                                    [&](const auto& session) { return session.session_id == id; });
    if (found == sessions_.end()) return std::optional<intention::SessionRecord>();
    return std::optional(*found);
  }
  Result<bool> Commit(const intention::SessionRecord& session,
                      const std::vector<intention::LabelRecord>&, const msg::Task&) override {
    sessions_.push_back(session);
    return true;
  }
  Status CommitLabels(const std::vector<intention::LabelRecord>&) override { return {}; }
  Result<std::vector<msg::Task>> OpenTasks() override { return std::vector<msg::Task>(); }
  Status NoteTask(const std::string&, msg::TaskState, Utime) override { return {}; }
  Result<bool> Stopped() override { return false; }
  Status SetStopped(bool, Utime) override { return {}; }

 private:
  std::vector<intention::SessionRecord> sessions_;
};

}  // namespace beckon::bench
