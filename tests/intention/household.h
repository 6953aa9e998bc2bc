// Intention services of several machines, front ends of one user and a robot on an unreliable
// network. Each service has a table, a disk, a clock and object ids of its own.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "services/intention/core/led_conversation.h"
#include "tests/intention/fixtures.h"
#include "tests/intention/unreliable_network.h"

namespace beckon::intention {

/// Its commits may take time.
class SlowMemory : public FakeMemory {
 public:
  std::function<void()> on_commit;
  Result<bool> Commit(const SessionRecord& session, const std::vector<LabelRecord>& given,
                      const msg::Task& task) override {
    auto committed = FakeMemory::Commit(session, given, task);
    if (on_commit) std::exchange(on_commit, {})();
    return committed;
  }
};

class Household {
 public:
  /// What the user wants each time.
  static constexpr char kAction[] = "Drink", kCategory[] = "Mug";
  static constexpr int kInstance = 2;

  struct Machine : Clock {
    const UnreliableNetwork* net = nullptr;
    SlowMemory memory;
    std::unique_ptr<LedConversation> service;
    Utime offset = 0;       // of its steady clock
    Utime wall_offset = 0;  // of its other one
    Utime tick_at = 0, scene_at = 0, status_at = 0;
    Utime stalled = 0;  // more time than the network knows of
    int64_t scenes = 0;
    Utime Now() const override { return net->now() + offset + stalled; }
    Utime Wall() const { return net->now() + wall_offset + stalled; }
  };
  struct FrontEnd {
    std::string device;
    bool asks = true;     // for sessions
    bool answers = true;  // questions
    std::string session_id;
    msg::Query query;
    int64_t answered = 0;  // query
    Utime answer_at = 0, start_at = 0;
  };
  /// What a service published.
  struct Said {
    size_t machine;
    Utime at;
    Outgoing what;
    bool held;  // the lease of the user, by its own clock
  };

  Household(size_t machines, size_t front_ends, uint64_t seed = 1, double loss = 0)
      : net(machines + front_ends, seed, loss) {
    for (size_t i = 0; i < machines; ++i) {
      auto& machine = machines_.emplace_back(std::make_unique<Machine>());
      machine->net = &net;
      machine->offset = static_cast<Utime>(1 + i) * 1000 * kSecond;
      machine->wall_offset = (i % 2 == 0 ? 10'003'600 : 9'996'400) * kSecond;  // hours apart
      Begin(i);
    }
    for (size_t i = 0; i < front_ends; ++i)
      front_ends_.push_back({.device = "switch" + std::to_string(i)});
  }

  Machine& machine(size_t i) { return *machines_[i]; }
  FrontEnd& front_end(size_t i) { return front_ends_[i]; }
  size_t EndpointOf(size_t front_end) const { return machines_.size() + front_end; }

  /// As after kill -9, over the same disk.
  void Begin(size_t i) {
    Machine& m = machine(i);
    m.service = std::make_unique<LedConversation>(
        LeaseHolder{"machine" + std::to_string(i), std::to_string(++runs_)}, m, affordances_,
        *policy_, m.memory);
    m.tick_at = m.scene_at = m.status_at = 0;
    const auto open = m.memory.OpenTasks();
    for (const msg::Task& task : *open) recovered.insert({i, task.task_id});
    Take(i, m.service->Recover(m.Wall()), false);
  }
  void Kill(size_t i) { net.Kill(i); }
  void Revive(size_t i) {
    net.Revive(i);
    Begin(i);
  }

  bool Holds(size_t i) {
    return net.Awake(i) && machine(i).service->leases().Holds("ann", machine(i).Now());
  }
  /// -1: none.
  int Leader() {
    for (size_t i = 0; i < machines_.size(); ++i) {
      if (Holds(i)) return static_cast<int>(i);
    }
    return -1;
  }

  bool RunUntil(const std::function<bool()>& condition, Utime timeout = 60 * kSecond) {
    for (const Utime end = net.now() + timeout; net.now() < end; Step()) {
      if (condition()) return true;
    }
    return condition();
  }
  void Run(Utime duration) {
    RunUntil([] { return false; }, duration);
  }

  void Step() {
    net.Step();
    for (size_t i = 0; i < machines_.size(); ++i) {
      if (net.Awake(i)) Live(i);
    }
    for (size_t i = 0; i < front_ends_.size(); ++i) Live(front_ends_[i], EndpointOf(i));
  }

  void Request(size_t front_end, msg::SessionKind kind, const std::string& session_id) {
    msg::Session request;
    request.kind = kind;
    request.utime = net.now();
    request.user = "ann";
    request.session_id = session_id;
    request.device = front_ends_[front_end].device;
    net.Send(EndpointOf(front_end), [this, request](size_t to) {
      if (to < machines_.size()) Feed(to, &LedConversation::OnSession, request);
    });
  }

  template <typename Message>
  std::vector<Said> All() const {
    std::vector<Said> all;
    std::ranges::copy_if(said, std::back_inserter(all),
                         [](const Said& one) { return std::holds_alternative<Message>(one.what); });
    return all;
  }
  /// Of a machine since a moment.
  int64_t Count(size_t machine, Utime since, const std::function<bool(const Outgoing&)>& is) const {
    return std::ranges::count_if(said, [&](const Said& one) {
      return one.machine == machine && one.at >= since && is(one.what);
    });
  }

  UnreliableNetwork net;
  std::vector<Said> said;
  std::map<std::string, msg::Task> done;               // by the robot, each once
  std::set<std::pair<size_t, std::string>> recovered;  // tasks found on disk by a machine
  int confirmed = 0;  // sessions, as the first front end knows them

 private:
  void Live(size_t i) {
    Machine& m = machine(i);
    if (net.now() >= m.scene_at) {
      m.scene_at = net.now() + kSecond / 5;
      ShowScene(i);
    }
    if (net.now() >= m.status_at) {
      m.status_at = net.now() + kSecond;
      net.Send(i, [this, i](size_t to) {
        if (to != i && to < machines_.size()) machine(to).service->HearPeer();
      });
    }
    if (net.now() < m.tick_at) return;
    m.tick_at = net.now() + kSecond / 20;
    const bool held = HeldBy(m);
    const Actions actions = m.service->Tick(m.Wall());
    Take(i, actions, held || HeldBy(m));
  }

  void ShowScene(size_t i) {
    Machine& m = machine(i);
    const int id = 10 * static_cast<int>(i);
    msg::Scene scene =
        SceneOf({SceneObject(id + 1, "Carton", 0.1, 0.5), SceneObject(id + 2, "Mug", 0.2, 0.4),
                 SceneObject(id + 3, "Mug", -0.2, 0.6)});
    scene.utime = m.Wall();
    scene.seq = ++m.scenes;
    Feed(i, &LedConversation::OnScene, scene);
    msg::Poses poses;
    poses.utime = scene.utime;
    poses.scene_seq = scene.seq;
    Feed(i, &LedConversation::OnPoses, poses);
  }

  void Live(FrontEnd& front_end, size_t endpoint) {
    if (front_end.asks && net.now() >= front_end.start_at) {
      front_end.start_at = net.now() + kSecond / 2;
      if (front_end.session_id.empty())
        front_end.session_id = front_end.device + "-" + std::to_string(++sessions_);
      Request(endpoint - machines_.size(), msg::SessionKind::kRequestStart, front_end.session_id);
    }
    if (front_end.answers && front_end.query.id != 0 && net.now() >= front_end.answer_at) {
      front_end.answer_at = net.now() + kSecond / 2;
      SendAnswer(front_end, endpoint);
    }
  }

  void SendAnswer(FrontEnd& front_end, size_t endpoint) {
    const msg::Query& query = front_end.query;
    msg::Answer answer;
    answer.utime = net.now();
    answer.query_id = query.id;
    answer.session_id = query.session_id;
    answer.device = front_end.device;
    const bool yes = IsWanted(query);
    answer.likelihoods = {yes ? 1.0 : 0.0, yes ? 0.0 : 1.0};
    front_end.answered = query.id;
    net.Send(endpoint, [this, answer](size_t to) {
      if (to < machines_.size()) Feed(to, &LedConversation::OnAnswer, answer);
    });
  }

  static bool IsWanted(const msg::Query& query) {
    const bool action = query.any_action || std::ranges::count(query.actions, kAction) > 0;
    return action && (query.any_object || std::ranges::any_of(query.objects, [](const auto& o) {
                        return o.category == kCategory && o.instance == kInstance;
                      }));
  }

  bool HeldBy(Machine& m) const { return m.service->leases().Holds("ann", m.Now()); }

  /// Lets a service hear something, and publishes what it says to it. It held the lease if it did
  /// before: the last word of a conversation gives it back.
  template <typename Message>
  void Feed(size_t i, Actions (LedConversation::*handler)(const Message&, Utime),
            const Message& message) {
    Machine& m = machine(i);
    const bool held = HeldBy(m);
    const Actions actions = (m.service.get()->*handler)(message, m.Wall());
    Take(i, actions, held || HeldBy(m));
  }

  void Take(size_t i, const Actions& actions, bool held) {
    // Won, used and given back at one go.
    held = held || std::ranges::any_of(actions, [](const Outgoing& action) {
             const auto* lease = std::get_if<msg::Lease>(&action);
             return lease != nullptr && lease->remaining_ms == 0;
           });
    for (const Outgoing& action : actions) {
      said.push_back({i, net.now(), action, held});
      std::visit([&](const auto& message) { Publish(i, message); }, action);
    }
  }

  template <typename Message>
  void Publish(size_t from, Message message) {
    if constexpr (!std::is_same_v<Message, Refused>) {
      message.seal.sender = machine(from).service->sender();
      net.Send(from, [this, message](size_t to) {
        if (to >= machines_.size()) return Hear(front_ends_[to - machines_.size()], to, message);
        Hear(to, message);
      });
    }
  }

  template <typename Message>
  void Hear(size_t i, const Message& message) {
    if constexpr (std::is_same_v<Message, msg::Session>)
      Feed(i, &LedConversation::OnSession, message);
    if constexpr (std::is_same_v<Message, msg::Lease>) Feed(i, &LedConversation::OnLease, message);
    if constexpr (std::is_same_v<Message, msg::Task>) Feed(i, &LedConversation::OnTask, message);
    if constexpr (std::is_same_v<Message, msg::TaskStatus>)
      Feed(i, &LedConversation::OnTaskStatus, message);
  }

  void Hear(FrontEnd& front_end, size_t, const msg::Query& query) {
    if (query.id == front_end.query.id || query.id == front_end.answered) return;
    front_end.query = query;
    front_end.session_id = query.session_id;
    front_end.answer_at = net.now() + kSecond / 10;
  }
  void Hear(FrontEnd& front_end, size_t endpoint, const msg::Session& event) {
    if (event.kind < msg::SessionKind::kConfirmed || event.session_id != front_end.session_id)
      return;
    front_end.query = {};
    front_end.session_id.clear();
    front_end.start_at = net.now() + kSecond;
    const bool first = endpoint == EndpointOf(0);
    if (first && event.kind == msg::SessionKind::kConfirmed) ++confirmed;
  }
  /// The robot is where the first front end is.
  void Hear(FrontEnd&, size_t endpoint, const msg::Task& task) {
    if (endpoint != EndpointOf(0)) return;
    done.try_emplace(task.task_id, task);
    net.Send(endpoint, [this, id = task.task_id](size_t to) {
      if (to >= machines_.size()) return;
      Feed(to, &LedConversation::OnTaskStatus,
           msg::TaskStatus{net.now(), id, msg::TaskState::kAccepted, "", {}});
    });
  }
  template <typename Message>
  void Hear(FrontEnd&, size_t, const Message&) {}

  const Affordances affordances_ = TestAffordances();
  const std::unique_ptr<Policy> policy_ = MakeAdaptivePolicy({});
  std::vector<std::unique_ptr<Machine>> machines_;
  std::vector<FrontEnd> front_ends_;
  int runs_ = 0;
  int sessions_ = 0;
};

}  // namespace beckon::intention
