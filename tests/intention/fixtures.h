// What the intention tests share: a vocabulary, scenes, a memory without a disk.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string>
#include <vector>

#include "services/intention/core/memory.h"
#include "services/intention/core/policies.h"

namespace beckon::intention {

/// The dissertation's 11 categories, 7 actions, 36 pairs.
inline Affordances TestAffordances(std::vector<std::string> unknown = {}) {
  auto made = Affordances::Make({{"Drink", "drink from"},
                                 {"Grasp", "grasp"},
                                 {"Move", "move"},
                                 {"Open", "open"},
                                 {"Pour", "pour from"},
                                 {"Push", "push"},
                                 {"Squeeze", "squeeze"}},
                                {{"Bottle", {"Drink", "Grasp", "Move", "Open", "Pour"}},
                                 {"Bowl", {"Grasp", "Move", "Push"}},
                                 {"Box", {"Grasp", "Move", "Open", "Push"}},
                                 {"Can", {"Drink", "Grasp", "Move", "Pour"}},
                                 {"Carton", {"Grasp", "Move", "Open", "Pour"}},
                                 {"Cup", {"Drink", "Grasp", "Move"}},
                                 {"Mug", {"Drink", "Grasp", "Move"}},
                                 {"SprayCan", {"Grasp"}},
                                 {"Tin", {"Grasp", "Move", "Open", "Pour"}},
                                 {"Tube", {"Grasp", "Squeeze"}},
                                 {"Tub", {"Grasp", "Open", "Push"}}},
                                std::move(unknown));
  EXPECT_TRUE(made.ok());
  return *made;
}

inline std::vector<Thing> Things(const Affordances& affordances,
                                 const std::vector<std::pair<std::string, double>>& seen) {
  std::vector<Thing> things;
  for (const auto& [category, distance_m] : seen) {
    things.push_back({affordances.FindCategory(category), distance_m, 0});
  }
  return things;
}

/// 1 to `most` objects of any category.
inline std::vector<Thing> RandomThings(const Affordances& affordances, std::mt19937_64& random,
                                       int most, bool lateral) {
  std::vector<Thing> things(1 + random() % static_cast<uint64_t>(most));
  for (Thing& thing : things) {
    thing.category = static_cast<int>(random() % affordances.categories().size());
    thing.distance_m = 0.2 + static_cast<double>(random() % 800) / 1000;
    if (lateral) thing.lateral_m = static_cast<double>(random() % 1000) / 1000 - 0.5;
  }
  return things;
}

/// Remembers in memory; can be made to fail.
class FakeMemory : public Memory {
 public:
  std::vector<SessionRecord> sessions;
  std::vector<LabelRecord> labels;
  std::map<std::string, msg::Task> tasks;
  std::map<std::string, msg::TaskState> states;
  bool stopped = false;
  bool fails = false;

  Result<std::vector<SessionRecord>> SessionsOf(const std::string& user) override {
    std::vector<SessionRecord> found;
    for (const auto& session : sessions) {
      if (session.user == user) found.push_back(session);
    }
    return found;
  }
  Result<std::vector<std::string>> Users() override {
    std::vector<std::string> users;
    for (auto session = sessions.rbegin(); session != sessions.rend(); ++session) {
      if (std::find(users.begin(), users.end(), session->user) == users.end())
        users.push_back(session->user);
    }
    return users;
  }
  Result<std::vector<LabelRecord>> LabelsOf(const std::string&) override { return labels; }
  Result<std::optional<SessionRecord>> FindSession(const std::string& id) override {
    for (const auto& session : sessions) {
      if (session.session_id == id) return std::optional(session);
    }
    return std::optional<SessionRecord>();
  }
  Result<bool> Commit(const SessionRecord& session, const std::vector<LabelRecord>& given,
                      const msg::Task& task) override {
    if (fails) return Error{"the disk is full"};
    if (FindSession(session.session_id)->has_value()) return false;
    sessions.push_back(session);
    labels.insert(labels.end(), given.begin(), given.end());
    tasks[task.task_id] = task;
    return true;
  }
  Status CommitLabels(const std::vector<LabelRecord>& given) override {
    labels.insert(labels.end(), given.begin(), given.end());
    return {};
  }
  Result<std::vector<msg::Task>> OpenTasks() override {
    std::vector<msg::Task> open;
    for (const auto& [id, task] : tasks) {
      if (!states.contains(id)) open.push_back(task);
    }
    return open;
  }
  Status NoteTask(const std::string& id, msg::TaskState state, Utime) override {
    states[id] = state;
    return {};
  }
  Result<bool> Stopped() override { return stopped; }
  Status SetStopped(bool now_stopped, Utime) override {
    stopped = now_stopped;
    return {};
  }
};

/// An object of a scene message at (x, y) on the table.
inline msg::SceneObject SceneObject(int id, const std::string& category, double x, double y,
                                    float confidence = 0.9f) {
  msg::SceneObject object;
  object.id = id;
  object.category = category;
  object.confidence = confidence;
  object.centroid_W = {x, y, 0.05};
  object.extent_W = {0.06, 0.06, 0.1};
  object.n_points = 500;
  if (category != msg::kUnknownCategory) object.probabilities = {{category, 0.9f}, {"Tube", 0.1f}};
  return object;
}

inline msg::Scene SceneOf(const std::vector<msg::SceneObject>& objects) {
  msg::Scene scene;
  scene.utime = 1;
  scene.seq = 7;
  scene.source = "test";
  scene.width = 640;
  scene.height = 480;
  scene.has_table = true;
  scene.objects = objects;
  return scene;
}

}  // namespace beckon::intention
