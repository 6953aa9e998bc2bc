// The bench on which a front end is put: a real service, a bus, a scripted intention.
#include <CLI/CLI.hpp>
#include <algorithm>

#include "services/ui_bridge/service.h"
#include "tests/ui_bridge/conformance/conformance.h"

namespace beckon::ui_bridge::conformance {
namespace {

constexpr char kUser[] = "ann";
constexpr Utime kRepeat_us = 500'000;
constexpr Utime kListen_us = 50'000;
constexpr Utime kLook_us = 2'000;

msg::ObjectRef Carton() { return {.object_id = 1, .category = "Carton", .instance = 1}; }
msg::ObjectRef Mug() { return {.object_id = 2, .category = "Mug", .instance = 1}; }

msg::SceneObject SceneObject(const msg::ObjectRef& ref, double x) {
  msg::SceneObject object;
  object.id = ref.object_id;
  object.category = ref.category;
  object.confidence = 0.9f;
  object.probabilities = {{ref.category, 0.9f}, {"Box", 0.1f}};
  object.centroid_W = {x, 0.5, 0.05};
  object.extent_W = {0.06, 0.06, 0.1};
  object.n_points = 100;
  return object;
}

msg::Scene Table(Utime utime) {
  msg::Scene scene;
  scene.utime = utime;
  scene.seq = scene.frame_seq = 1;
  scene.source = "conformance";
  scene.width = 640;
  scene.height = 480;
  scene.intrinsics = {525, 525, 319.5, 239.5};
  scene.has_table = true;
  scene.X_WC.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  scene.X_WC.translation() = Eigen::Vector3d(0, 0, 0.5);
  scene.objects = {SceneObject(Carton(), -0.1), SceneObject(Mug(), 0.1)};
  return scene;
}

}  // namespace

struct FrontEndConformance::Program {
  std::unique_ptr<FrontEndFactory> factory;
  std::unique_ptr<Service> service;
};

FrontEndConformance::FrontEndConformance()
    : bus_(std::move(*Bus::Open("memq://"))), hand_(GetParam().make()) {}

FrontEndConformance::~FrontEndConformance() = default;

void FrontEndConformance::SetUp() {
  loop_.AddFd(bus_->fd(), [this] { bus_->HandleReadable(); });
  program_ = std::make_unique<Program>();
  for (auto& factory : MakeFrontEndFactories()) {
    if (factory->name() == hand_->front_end()) program_->factory = std::move(factory);
  }
  ASSERT_NE(program_->factory, nullptr) << "no front end is called " << hand_->front_end();
  CLI::App app;
  program_->factory->AddOptions(app);
  auto flags = hand_->flags();
  std::ranges::reverse(flags);  // as CLI11 takes them
  app.parse(flags);
  auto config = ConfigTable::Parse(hand_->config(), "the hand's configuration");
  ASSERT_TRUE(config) << config.error().message;
  program_->factory->Configure(config->Section(hand_->front_end()));
  const Status right = config->Finish();
  ASSERT_TRUE(right) << right.error().message;

  device_ = DefaultDevice(hand_->front_end());
  bus_->Subscribe<msg::Interface>([this](const msg::Interface& announced) {
    if (announced.device == device_) interface_ = announced;
  });
  bus_->Subscribe<msg::Session>([this](const msg::Session& session) {
    if (session.kind < msg::SessionKind::kIdle) requests_.push_back(session);
    if (session.kind == msg::SessionKind::kRequestStart) session_id_ = session.session_id;
  });
  bus_->Subscribe<msg::Answer>([this](const msg::Answer& answer) { answers_.push_back(answer); });
  loop_.Every(kRepeat_us, [this] {
    if (silent_) return;
    if (announced_) (void)bus_->Publish(*announced_);
    if (query_) (void)bus_->Publish(*query_);
  });
  program_->service = std::make_unique<Service>(
      ServiceConfig{.user = kUser, .device = device_, .listen_us = kListen_us}, *bus_, loop_,
      clock_, steady_);
  const Status added = program_->service->Add(*program_->factory);
  ASSERT_TRUE(added) << added.error().message;
  program_->service->Begin();
  // After the service, which is therefore told first.
  bus_->Subscribe<msg::Query>([this](const msg::Query& query) { heard_query_ = query.id; });
  const Status shown = bus_->Publish(Table(clock_.Now()));
  ASSERT_TRUE(shown) << shown.error().message;
  hand_->Begin({.bus = *bus_, .loop = loop_, .device = device_});
}

bool FrontEndConformance::Await(const std::function<bool()>& condition) {
  if (condition()) return true;
  bool met = false;
  const auto look = loop_.Every(kLook_us, [&] {
    met = condition();
    if (met) loop_.Stop();
  });
  const auto deadline =
      loop_.After(static_cast<Utime>(hand_->patience_s() * kSecond), [this] { loop_.Stop(); });
  loop_.Run();
  loop_.Cancel(look);
  loop_.Cancel(deadline);
  return met;
}

void FrontEndConformance::Let(double seconds) {
  loop_.After(static_cast<Utime>(seconds * kSecond), [this] { loop_.Stop(); });
  loop_.Run();
}

void FrontEndConformance::BeginSession() {
  hand_->Start();
  ASSERT_TRUE(Await([this] { return Count(msg::SessionKind::kRequestStart) > 0; }))
      << "no session was asked for";
  Announce(msg::SessionKind::kBegun);
}

msg::Query FrontEndConformance::Question(msg::QueryKind kind) const {
  msg::Query query;
  query.utime = clock_.Now();
  query.session_id = session_id_;
  query.user = kUser;
  query.kind = kind;
  query.scene_seq = 1;
  query.text = "Open the carton?";
  query.options = {{.text = "Yes"}, {.text = "No"}};
  const bool action = kind == msg::QueryKind::kAction || kind == msg::QueryKind::kFull;
  query.any_action = !action;
  if (action) query.actions = {"Open"};
  const bool object = kind != msg::QueryKind::kAction && kind != msg::QueryKind::kChoice;
  query.any_object = !object;
  if (object) query.objects = {Carton()};
  if (kind == msg::QueryKind::kSet) query.objects.push_back(Mug());
  if (kind == msg::QueryKind::kChoice) {
    query.text = "What shall be done?";
    query.objects = {Carton(), Mug()};
    query.options = {{.text = "Open the carton", .actions = {"Open"}, .objects = {1}},
                     {.text = "Grasp the mug", .actions = {"Grasp"}, .objects = {2}},
                     {.text = "None of these"}};
  }
  if (kind == msg::QueryKind::kWhatIsIt) {
    query.text = "What is this object?";
    query.options = {{.text = "A carton", .category = "Carton"},
                     {.text = "A box", .category = "Box"},
                     {.text = "None of these", .category = "Unknown"}};
  }
  const auto n = static_cast<float>(query.options.size());
  query.prospects.assign(query.options.size(), {1 / n, 1, 1});
  return query;
}

msg::Query FrontEndConformance::Ask(msg::QueryKind kind) {
  msg::Query query = Question(kind);
  query.id = last_query_ = std::max(last_query_ + 1, clock_.Now());
  query.questions_asked = static_cast<int>(DistinctAnswers().size());
  query_ = query;
  const Status sent = bus_->Publish(query);
  EXPECT_TRUE(sent) << sent.error().message;
  EXPECT_TRUE(Await([&] { return heard_query_ == query.id; }));
  return query;
}

const msg::Answer* FrontEndConformance::AnswerTo(const msg::Query& query) {
  const auto find = [&] { return std::ranges::find(answers_, query.id, &msg::Answer::query_id); };
  return Await([&] { return find() != answers_.end(); }) ? &*find() : nullptr;
}

void FrontEndConformance::Announce(msg::SessionKind kind, int questions) {
  msg::Session event;
  event.utime = clock_.Now();
  event.kind = kind;
  event.questions = questions;
  if (kind != msg::SessionKind::kIdle) {
    event.user = kUser;
    event.session_id = session_id_;
  }
  if (kind != msg::SessionKind::kBegun) query_.reset();
  announced_ = event;
  const Status sent = bus_->Publish(event);
  EXPECT_TRUE(sent) << sent.error().message;
}

int FrontEndConformance::Count(msg::SessionKind request) const {
  return static_cast<int>(std::ranges::count(requests_, request, &msg::Session::kind));
}

std::vector<msg::Answer> FrontEndConformance::DistinctAnswers() const {
  std::vector<msg::Answer> distinct;
  for (const auto& answer : answers_) {
    const bool again = std::ranges::any_of(distinct, [&](const auto& known) {
      return known.query_id == answer.query_id && known.utime == answer.utime;
    });
    if (!again) distinct.push_back(answer);
  }
  return distinct;
}

}  // namespace beckon::ui_bridge::conformance
