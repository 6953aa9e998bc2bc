#include "bench/bci/person.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace beckon::bench {
namespace {

using namespace ui_bridge::bci;

constexpr Utime kStep_us = 50'000;
constexpr Utime kLongest_us = 3600 * kSecond;

/// The place of a thing of the scenario on the table.
Eigen::Vector3d PlaceOf(const intention::Thing& thing) {
  const double x = std::clamp(thing.lateral_m, -thing.distance_m, thing.distance_m);
  return {x, std::sqrt(std::max(0.0, thing.distance_m * thing.distance_m - x * x)), 0.05};
}

TrialsConfig Uninviting(TrialsConfig config) {
  config.invite = false;
  return config;
}

}  // namespace

Person::Person(const intention::Affordances& affordances, const intention::Policy& policy,
               const PersonConfig& config)
    : affordances_(affordances),
      config_(config),
      random_(config.seed),
      conversation_(affordances, policy, memory_),
      dialogue_(
          {.user = "person", .device = "bci"}, clock_, clock_,
          [this] { return "session-" + std::to_string(++ids_); }, *this),
      trials_(Uninviting(config.trials), "bci", 1, *this),
      calibration_(Classes(config.trials.layout)),
      decoder_(Classes(config.trials.layout), config.accuracy, config.sharpness) {
  Do(conversation_.Recover(clock_.Now()));
  interface_ = ui_bridge::bci::Announce(config_.trials, calibration_, config_.trial_s);
  interface_.device = "bci";
}

Lived Person::Live(const intention::ScenarioSession& session) {
  session_ = &session;
  lived_ = {};
  over_ = false;
  wanted_ = {};
  wanted_.action = affordances_.actions()[session.want_action].name;
  wanted_.object.category = affordances_.categories()[session.want_category].name;
  std::vector<std::pair<double, int>> same;
  for (size_t i = 0; i < session.scene.size(); ++i)
    if (session.scene[i].category == session.want_category)
      same.emplace_back(session.scene[i].distance_m, static_cast<int>(i) + 1);
  std::sort(same.begin(), same.end());
  wanted_.object.object_id = same[static_cast<size_t>(session.want_rank) - 1].second;
  clock_.Advance(20 * kSecond);  // the table is another one
  next_second_ = 0;
  const Utime begun = clock_.Now();
  dialogue_.Start();
  while (!over_ && clock_.Now() - begun < kLongest_us) Step();
  lived_.seconds = static_cast<double>(clock_.Now() - begun) / kSecond;
  if (!over_) dialogue_.Cancel();
  for (int i = 0; i < 60; ++i) Step();
  return lived_;
}

void Person::Step() {
  clock_.Advance(kStep_us);
  if (clock_.Now() >= next_second_) {
    next_second_ = clock_.Now() + kSecond;
    interface_.utime = clock_.Now();
    Do(conversation_.OnInterface(interface_, clock_.Now()));
    ShowTable();
  }
  dialogue_.Tick();
  trials_.Tick(clock_.Now());
  Decode();
  Do(conversation_.Tick(clock_.Now()));
  while (!later_.empty()) {
    const auto next = std::move(later_.front());
    later_.pop_front();
    next();
  }
}

void Person::ShowTable() {
  msg::Scene scene;
  scene.utime = clock_.Now();
  scene.seq = scene.frame_seq = ++scenes_;
  scene.source = "bench";
  scene.has_table = true;
  for (size_t i = 0; i < session_->scene.size(); ++i) {
    const intention::Thing& thing = session_->scene[i];
    msg::SceneObject object;
    object.id = static_cast<int>(i) + 1;
    object.category = affordances_.categories()[thing.category].name;
    object.confidence = 0.95f;
    object.probabilities = {{object.category, 1.0f}};
    object.centroid_W = PlaceOf(thing);
    object.extent_W = {0.06, 0.06, 0.1};
    object.n_points = 100;
    scene.objects.push_back(std::move(object));
  }
  msg::Poses poses;
  poses.utime = scene.utime;
  poses.seq = poses.scene_seq = scene.seq;
  Do(conversation_.OnScene(scene, clock_.Now()));
  Do(conversation_.OnPoses(poses, clock_.Now()));
}

void Person::Do(intention::Actions actions) {
  for (auto& said : actions) later_.emplace_back([this, said = std::move(said)] { Hear(said); });
}

void Person::Hear(const intention::Outgoing& said) {
  if (const auto* query = std::get_if<msg::Query>(&said)) dialogue_.OnQuery(*query);
  if (const auto* event = std::get_if<msg::Session>(&said)) dialogue_.OnSession(*event);
  const auto* task = std::get_if<msg::Task>(&said);
  if (task == nullptr || over_) return;
  msg::TaskStatus done;
  done.utime = clock_.Now();
  done.task_id = task->task_id;
  done.state = msg::TaskState::kDone;
  Do(conversation_.OnTaskStatus(done, clock_.Now()));
  const bool right =
      task->action == wanted_.action && task->object.object_id == wanted_.object.object_id;
  lived_.end = right ? Lived::End::kRight : Lived::End::kWrong;
  lived_.questions = task->questions;
  lived_.posterior = task->posterior;
  over_ = true;
  for (auto& trial : session_trials_.Confirm(*task)) calibration_.Add(std::move(trial));
  if (!config_.learns) return;
  trials_.SetModel(calibration_.Fit());
  interface_ = ui_bridge::bci::Announce(config_.trials, calibration_, config_.trial_s);
  interface_.device = "bci";
}

/// What the decoder makes of the trial that is over.
void Person::Decode() {
  if (!stimulus_ || stimulus_->trial == decoded_) return;
  if (clock_.Now() - stimulus_->utime < static_cast<Utime>(config_.trial_s * 1e6)) return;
  decoded_ = stimulus_->trial;
  std::optional<size_t> meant;
  if (query_ && query_->id == stimulus_->query_id) meant = meant_;
  msg::Decoding decoding;
  decoding.decoder = "simulated";
  decoding.device = "bci";
  decoding.trial = decoded_;
  decoding.probabilities = decoder_.Draw(meant, random_);
  auto& p = decoding.probabilities;
  if (config_.names_only) {
    const auto best = std::max_element(p.begin(), p.end()) - p.begin();
    std::fill(p.begin(), p.end(), 0.0);
    p[static_cast<size_t>(best)] = 1;
  }
  if (stimulus_->query_id != 0) ++lived_.trials;
  trials_.OnDecoding(decoding, clock_.Now());
}

void Person::Send(const msg::Answer& answer) {
  later_.emplace_back([this, answer] { Do(conversation_.OnAnswer(answer, clock_.Now())); });
}
void Person::Send(const msg::Session& request) {
  later_.emplace_back([this, request] { Do(conversation_.OnSession(request, clock_.Now())); });
}
void Person::Present(const msg::Query& query) {
  query_ = query;
  meant_ = RightOption(query, wanted_);
  const size_t n = query.options.size();
  if (meant_ && Uniform(random_) < config_.slip) meant_ = (*meant_ + 1 + random_() % (n - 1)) % n;
  trials_.Present(query, clock_.Now());
}
void Person::Withdraw() { trials_.Withdraw(clock_.Now()); }

void Person::ShowSession(const msg::Session& event) {
  trials_.OnSession(event.kind, clock_.Now());
  if (over_) return;
  if (event.kind == msg::SessionKind::kAbandoned) lived_.end = Lived::End::kAbandoned;
  if (event.kind == msg::SessionKind::kStopped) {
    lived_.end = Lived::End::kStopped;
    dialogue_.Resume();
  }
  over_ = event.kind == msg::SessionKind::kAbandoned || event.kind == msg::SessionKind::kStopped;
  if (over_) session_trials_.Forget();
}

void Person::Stimulate(const msg::Stimulus& stimulus) { stimulus_ = stimulus; }

void Person::Answer(const msg::Query& query, const std::vector<double>& likelihoods,
                    const std::vector<std::vector<double>>& trials) {
  session_trials_.Add(query, trials);
  dialogue_.Answer(query.id, likelihoods);
}

void Person::Request(msg::SessionKind request) {
  if (request == msg::SessionKind::kRequestStop) dialogue_.Stop();
  if (request == msg::SessionKind::kRequestUndo) dialogue_.Undo();
}

DecoderModel Person::ModelOf(const std::string&) { return calibration_.Fit(); }

}  // namespace beckon::bench
