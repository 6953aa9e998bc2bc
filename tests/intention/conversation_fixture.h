// A conversation with a user who knows what they want, on a clock that stands still.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "services/intention/core/conversation.h"
#include "tests/intention/fixtures.h"

namespace beckon::intention {

struct Wish {
  std::string action;
  int object_id = 0;
  std::string category;  // what the object really is
};

class Desk {
 public:
  /// `unknown`: what can be done with objects of no category.
  explicit Desk(FakeMemory& the_memory, std::vector<std::string> unknown = {})
      : affordances(TestAffordances(std::move(unknown))), memory(the_memory) {
    Restart();
  }

  /// As after kill -9: a new process over the same memory.
  void Restart() {
    conversation = std::make_unique<Conversation>(affordances, *policy, memory);
    Take(conversation->Recover(now));
  }

  void Take(const Actions& actions) {
    for (const Outgoing& action : actions) {
      if (const auto* q = std::get_if<msg::Query>(&action)) queries.push_back(*q);
      if (const auto* s = std::get_if<msg::Session>(&action)) events.push_back(*s);
      if (const auto* t = std::get_if<msg::Task>(&action)) tasks.push_back(*t);
      if (const auto* t = std::get_if<msg::TaskStatus>(&action)) statuses.push_back(*t);
      if (const auto* l = std::get_if<msg::Label>(&action)) labels.push_back(*l);
      if (const auto* p = std::get_if<msg::Profile>(&action)) profiles.push_back(*p);
      if (const auto* r = std::get_if<Refused>(&action)) refusals.push_back(*r);
    }
  }
  void Clear() {
    queries.clear();
    events.clear();
    tasks.clear();
    statuses.clear();
    labels.clear();
    profiles.clear();
    refusals.clear();
  }

  void ShowSceneOnly(const msg::Scene& scene) { Take(conversation->OnScene(scene, now)); }
  /// Poses of a scene, as pose publishes them where no fit converged.
  void ShowPoses(const msg::Scene& scene, std::vector<msg::ObjectPose> fits = {}) {
    msg::Poses poses;
    poses.utime = scene.utime;
    poses.scene_seq = scene.seq;
    poses.poses = std::move(fits);
    Take(conversation->OnPoses(poses, now));
  }
  void Show(const msg::Scene& scene) {
    ShowSceneOnly(scene);
    ShowPoses(scene);
  }
  /// Objects at 10 Hz for a while, as perception shows them.
  void Watch(const std::vector<msg::SceneObject>& objects, Utime duration = kSecond) {
    for (const Utime end = now + duration; now < end;) {
      now += kSecond / 10;
      msg::Scene scene = SceneOf(objects);
      scene.utime = now;
      scene.seq = ++seq;
      Show(scene);
      Take(conversation->Tick(now));
    }
  }
  void Announce(const std::string& device, float error = 0, int max_options = 8) {
    msg::Interface interface;
    interface.device = device;
    interface.max_options = max_options;
    interface.false_yes = interface.false_no = error;
    Take(conversation->OnInterface(interface, now));
  }
  void Request(msg::SessionKind kind, const std::string& id = "s1", const std::string& user = "ann",
               Utime utime = 0) {
    msg::Session request;
    request.utime = utime == 0 ? ++now : utime;
    request.kind = kind;
    request.session_id = id;
    request.user = user;
    request.device = "switch";
    Take(conversation->OnSession(request, now));
  }
  void Start(const std::string& id = "s1", const std::string& user = "ann") {
    Request(msg::SessionKind::kRequestStart, id, user);
  }
  msg::Answer AnswerTo(const msg::Query& query, size_t option) const {
    msg::Answer answer;
    answer.query_id = query.id;
    answer.session_id = query.session_id;
    answer.device = "switch";
    answer.likelihoods.assign(query.options.size(), 0.0);
    answer.likelihoods[option] = 1;
    return answer;
  }
  void Answer(const msg::Query& query, size_t option) {
    ++now;
    Take(conversation->OnAnswer(AnswerTo(query, option), now));
  }
  void Wait(Utime duration) {
    for (Utime end = now + duration; now < end;) {
      now += kSecond / 10;
      Take(conversation->Tick(now));
    }
  }

  static size_t Honest(const msg::Query& query, const Wish& wish,
                       const std::map<int, std::string>& really) {
    if (query.kind == msg::QueryKind::kWhatIsIt) {
      const auto truth = really.find(query.objects[0].object_id);
      for (size_t i = 0; truth != really.end() && i < query.options.size(); ++i) {
        if (query.options[i].category == truth->second) return i;
      }
      return query.options.size() - 1;
    }
    const bool action =
        query.any_action || std::count(query.actions.begin(), query.actions.end(), wish.action) > 0;
    const bool object = query.any_object ||
                        std::any_of(query.objects.begin(), query.objects.end(), [&](const auto& o) {
                          return o.object_id == wish.object_id && o.category == wish.category;
                        });
    return action && object ? 0 : 1;
  }
  /// Answers until the session ends; returns its last event.
  msg::Session Converse(const Wish& wish, const std::map<int, std::string>& really = {}) {
    for (int i = 0; i < 200; ++i) {
      const msg::Session& last = events.back();
      if (last.kind == msg::SessionKind::kConfirmed || last.kind == msg::SessionKind::kAbandoned)
        return last;
      const msg::Query query = queries.back();
      Answer(query, Honest(query, wish, really));
    }
    ADD_FAILURE() << "the session does not end";
    return {};
  }

  const Affordances affordances;
  const std::unique_ptr<Policy> policy = MakeAdaptivePolicy({});
  FakeMemory& memory;
  std::unique_ptr<Conversation> conversation;
  Utime now = 1'000'000'000;
  int64_t seq = 7;  // of the scenes that Watch shows
  std::vector<msg::Query> queries;
  std::vector<msg::Session> events;
  std::vector<msg::Task> tasks;
  std::vector<msg::TaskStatus> statuses;
  std::vector<msg::Label> labels;
  std::vector<msg::Profile> profiles;
  std::vector<Refused> refusals;
};

}  // namespace beckon::intention
