// Conversations whose messages are lost, doubled, late and out of order, whose table changes, whose
// process is killed and whose disk fails: what must never happen, does not.
#include <functional>
#include <set>

#include "tests/intention/conversation_fixture.h"

namespace beckon::intention {
namespace {

using Kind = msg::SessionKind;

constexpr int kSequences = 2000;
constexpr int kSteps = 450;
/// Most between where a task says that its object is and where the newest scene shows it.
constexpr double kPlace_m = 0.05;

class CountingMemory : public FakeMemory {
 public:
  std::map<std::string, int> commits;  // by session id

  Result<bool> Commit(const SessionRecord& session, const std::vector<LabelRecord>& given,
                      const msg::Task& task) override {
    auto committed = FakeMemory::Commit(session, given, task);
    if (committed && *committed) ++commits[session.session_id];
    return committed;
  }
};

msg::SceneObject Doubtful(int id, double x, double y) {
  msg::SceneObject object = SceneObject(id, "Box", x, y, 0.2f);
  object.ask_user = true;
  object.probabilities = {{"Box", 0.5f}, {"Carton", 0.5f}};
  return object;
}

std::vector<msg::Scene> Scenes() {
  std::vector<msg::Scene> scenes = {
      SceneOf({SceneObject(1, "Carton", 0.1, 0.5), SceneObject(2, "Mug", -0.1, 0.4),
               Doubtful(3, 0.3, 0.6)}),
      SceneOf({SceneObject(1, "Tube", 0, 0.5)}),
      SceneOf({SceneObject(1, "Teapot", 0, 0.5), SceneObject(2, "Box", 0.1, 0.5)}), SceneOf({}),
      SceneOf({SceneObject(1, "Mug", 0, 0.5)})};
  scenes.back().has_table = false;
  return scenes;
}

/// One random sequence. Whatever was sent once may come again at any time.
class Sequence {
 public:
  explicit Sequence(uint64_t seed) : random_(seed) {}

  void Run() {
    for (int i = 0; i < kSteps && !testing::Test::HasFailure(); ++i) {
      Step();
      Check();
    }
  }
  int64_t tasks() const { return static_cast<int64_t>(first_.size()); }

 private:
  uint64_t Below(uint64_t n) { return random_() % n; }
  template <typename T>
  const T& Any(const std::vector<T>& all) {
    return all[Below(all.size())];
  }

  /// A message on its way: lost, delivered, or delivered twice.
  void Send(std::function<void()> deliver) {
    sent_.push_back(deliver);
    if (Below(10) == 0) return;
    deliver();
    if (Below(10) == 0) deliver();
  }

  void Step() {
    const auto choice = Below(100);
    if (choice < 50) return SendAnswer();
    if (choice < 60 && !sent_.empty()) return Any(sent_)();  // late, again
    if (choice < 68) return ShowScene();
    if (choice < 74) return SendPoses();
    if (choice < 84) return SendRequest(Kind::kRequestStart);
    if (choice < 92) {
      static const std::vector<Kind> kRequests = {Kind::kRequestUndo,        Kind::kRequestUndo,
                                                  Kind::kRequestNoneOfThese, Kind::kRequestCancel,
                                                  Kind::kRequestStop,        Kind::kRequestResume,
                                                  Kind::kRequestResume,      Kind::kRequestResume};
      return SendRequest(Any(kRequests));
    }
    if (choice < 94) return Restart();
    if (choice < 95) return desk_.Announce("switch", Below(2) == 0 ? 0 : 0.1f, 2 + Below(12));
    if (choice < 96) {
      memory_.fails = Below(4) == 0;
      return;
    }
    if (choice < 97) return SendTaskStatus();
    desk_.Wait(static_cast<Utime>(1 + Below(choice == 99 ? 400 : 12)) * kSecond / 10);
  }

  /// What stands on the table changes now and then; what is shown of it flickers.
  void ShowScene() {
    if (Below(6) == 0) world_ = Any(scenes_);
    if (Below(5) == 0) ChangeWorld();
    if (Below(20) == 0) seq_ = 0;  // perception starts anew
    const uint64_t scenes = Below(4) == 0 ? 10 : 1 + Below(3);
    for (uint64_t i = 0; i < scenes; ++i) {
      msg::Scene scene = world_;
      std::erase_if(scene.objects, [this](const auto&) { return Below(20) == 0; });
      ShowNow(std::move(scene));
      desk_.now += kSecond / 10;
    }
  }

  void ChangeWorld() {
    if (world_.objects.empty()) return;
    const size_t i = Below(world_.objects.size());
    if (Below(2) == 0) {
      world_.objects.erase(world_.objects.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      world_.objects[i].centroid_W.x() += Below(2) == 0 ? 0.03 : 0.3;
    }
  }

  void ShowNow(msg::Scene scene) {
    scene.utime = ++desk_.now;
    scene.seq = ++seq_;
    shown_ = scene;
    Send([this, scene] {
      const int64_t late = desk_.conversation->counters().late_scenes;
      const Actions actions = desk_.conversation->OnScene(scene, desk_.now);
      if (desk_.conversation->counters().late_scenes == late && scene.has_table) {
        view_ = scene;
        viewed_ = desk_.now;
      }
      desk_.Take(actions);
      CheckTasksAreInView();
    });
  }

  /// The object of the question goes, or moves, as the user says yes to it.
  void Snatch(const msg::Query& query) {
    if (query.objects.size() != 1) return;
    msg::Scene scene = world_;
    const bool goes = Below(2) == 0;
    for (auto& object : scene.objects) {
      if (object.id == query.objects[0].object_id) object.centroid_W.y() += 0.4;
    }
    if (goes) {
      std::erase_if(scene.objects,
                    [&](const auto& o) { return o.id == query.objects[0].object_id; });
    }
    if (Below(2) == 0) world_ = scene;  // else it was a flicker
    ShowNow(scene);
  }

  /// Whatever is published now stands where the newest fresh scene shows it.
  void CheckTasksAreInView() {
    for (; seen_tasks_ < desk_.tasks.size(); ++seen_tasks_) {
      if (viewed_ == 0 || desk_.now - viewed_ > 5 * kSecond) continue;
      const msg::Task& task = desk_.tasks[seen_tasks_];
      EXPECT_TRUE(std::any_of(view_.objects.begin(), view_.objects.end(),
                              [&](const auto& object) {
                                return (object.centroid_W - task.centroid_W).norm() <= kPlace_m;
                              }))
          << task.action << " " << task.object.category << " is not there";
    }
  }

  void SendPoses() {
    Send([this, scene = shown_] { desk_.ShowPoses(scene); });
  }

  void SendRequest(Kind kind) {
    const std::string user = Any<std::string>({"ann", "bob"});
    const std::string id = Any<std::string>({"s1", "s2", "s3"});
    const Utime utime = ++desk_.now;
    Send([this, kind, user, id, utime] {
      desk_.Request(kind, id, user, utime);
      CheckTasksAreInView();
    });
  }

  void SendTaskStatus() {
    if (desk_.tasks.empty()) return;
    const msg::TaskStatus status{
        desk_.now, Any(desk_.tasks).task_id, msg::TaskState::kAccepted, "", {}};
    Send([this, status] { desk_.Take(desk_.conversation->OnTaskStatus(status, desk_.now)); });
  }

  void SendAnswer() {
    if (desk_.queries.empty()) return;
    const msg::Query query = Below(5) == 0 ? Any(desk_.queries) : desk_.queries.back();
    if (Below(8) == 0) Snatch(query);
    msg::Answer answer = desk_.AnswerTo(query, Below(2) * Below(query.options.size()));
    if (Below(20) == 0) answer.likelihoods.push_back(1);
    if (Below(20) == 0) answer.likelihoods.assign(answer.likelihoods.size(), 0.5);
    Send([this, query, answer] { Deliver(query, answer); });
  }

  void Deliver(const msg::Query& query, const msg::Answer& answer) {
    const bool yes = query.kind == msg::QueryKind::kFull && answer.likelihoods[0] > 0.9 &&
                     answer.likelihoods.size() == 2;
    const int64_t taken = desk_.conversation->counters().answers;
    ++desk_.now;
    const Actions actions = desk_.conversation->OnAnswer(answer, desk_.now);
    if (yes && desk_.conversation->counters().answers > taken) {
      accepted_.insert(
          {query.session_id, query.user, query.actions[0], query.objects[0].object_id});
    }
    desk_.Take(actions);
    CheckTasksAreInView();
  }

  void Restart() {
    viewed_ = 0;  // the new process has seen nothing
    desk_.Restart();
    for (auto it = accepted_.begin(); it != accepted_.end();) {
      const bool committed = memory_.commits.contains(std::get<0>(*it));
      it = committed ? std::next(it) : accepted_.erase(it);
    }
  }

  void Check() {
    CheckTasksAreInView();
    for (const auto& [id, n] : memory_.commits) EXPECT_EQ(n, 1) << id;
    for (; checked_tasks_ < desk_.tasks.size(); ++checked_tasks_) {
      const msg::Task& task = desk_.tasks[checked_tasks_];
      EXPECT_TRUE(memory_.commits.contains(task.task_id)) << "promised, not remembered";
      EXPECT_TRUE(accepted_.contains({task.task_id, task.user, task.action, task.object.object_id}))
          << "nobody said yes to " << task.action << " " << task.object.category;
      const auto& first = first_.try_emplace(task.task_id, task).first->second;
      EXPECT_EQ(task.action, first.action);
      EXPECT_EQ(task.object.object_id, first.object.object_id);
      EXPECT_EQ(task.expires_utime, first.expires_utime);
    }
    for (; checked_events_ < desk_.events.size(); ++checked_events_) {
      const msg::Session& event = desk_.events[checked_events_];
      if (event.kind != Kind::kConfirmed) continue;
      EXPECT_TRUE(memory_.commits.contains(event.session_id)) << "confirmed, not remembered";
    }
    const bool still_stopped = was_stopped_ && desk_.conversation->stopped();
    if (still_stopped) {
      EXPECT_EQ(desk_.queries.size(), queries_) << "asked while stopped";
      EXPECT_EQ(desk_.tasks.size(), tasks_) << "published while stopped";
    }
    was_stopped_ = desk_.conversation->stopped();
    queries_ = desk_.queries.size();
    tasks_ = desk_.tasks.size();
  }

  std::mt19937_64 random_;
  CountingMemory memory_;
  Desk desk_{memory_};
  const std::vector<msg::Scene> scenes_ = Scenes();
  msg::Scene world_ = scenes_[0];
  msg::Scene shown_ = scenes_[0];
  msg::Scene view_;   // the newest that was taken
  Utime viewed_ = 0;  // when; 0: never
  int64_t seq_ = 0;
  size_t seen_tasks_ = 0;
  std::vector<std::function<void()>> sent_;
  /// Full questions that were answered by yes: session, user, action, object.
  std::set<std::tuple<std::string, std::string, std::string, int>> accepted_;
  std::map<std::string, msg::Task> first_;  // by task id
  size_t checked_tasks_ = 0;
  size_t checked_events_ = 0;
  size_t queries_ = 0;
  size_t tasks_ = 0;
  bool was_stopped_ = false;
};

TEST(ConversationFaults, NeverCommitTwiceNorPublishWhatNobodyConfirmed) {
  int64_t tasks = 0;
  for (uint64_t seed = 1; seed <= kSequences && !testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Sequence sequence(seed);
    sequence.Run();
    tasks += sequence.tasks();
  }
  EXPECT_GT(tasks, kSequences / 2) << "the sequences say little";
}

}  // namespace
}  // namespace beckon::intention
