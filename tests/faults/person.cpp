#include "tests/faults/person.h"

#include <variant>

#include "services/ui_bridge/uuid.h"

namespace beckon::faults {
namespace {

constexpr Utime kTick = kSecond / 20;
constexpr Utime kThink = kSecond / 100;

msg::SceneObject Object(int id, const std::string& category, double x, double y) {
  msg::SceneObject object;
  object.id = id;
  object.category = category;
  object.confidence = 0.95f;
  object.probabilities = {{category, 1.0f}};
  object.centroid_W = {x, y, 0.05};
  object.extent_W = {0.06, 0.06, 0.1};
  object.n_points = 100;
  return object;
}

}  // namespace

Person::Person(const Wish& wish, Bus& bus, RunLoop& loop, const Clock& clock, const Clock& steady)
    : wish_(wish),
      bus_(bus),
      loop_(loop),
      wants_({.action = wish.action, .category = wish.category}),
      dialogue_({.user = wish.user, .device = wish.device, .listen_us = kSecond / 5}, clock, steady,
                ui_bridge::NewUuid, *this) {
  bus_.Subscribe<msg::Scene>([this](const msg::Scene& scene) { wants_.SeeScene(scene); });
  bus_.Subscribe<msg::Query>([this](const msg::Query& query) { dialogue_.OnQuery(query); });
  bus_.Subscribe<msg::Session>([this](const msg::Session& event) { dialogue_.OnSession(event); });
  timer_ = loop_.Every(kTick, [this] { Tick(); });
}

Person::~Person() { loop_.Cancel(timer_); }

void Person::GoOn(bool goes_on) {
  goes_on_ = goes_on;
  if (!goes_on) dialogue_.Cancel();
}

void Person::Tick() {
  if (goes_on_ && dialogue_.phase() == ui_bridge::Dialogue::Phase::kIdle) dialogue_.Start();
  dialogue_.Tick();
}

void Person::Present(const msg::Query& query) {
  loop_.After(kThink, [this, query] {
    const auto response = wants_.Respond(query);
    if (const auto* choice = std::get_if<ui_bridge::Choose>(&response)) {
      std::vector<double> likelihoods(query.options.size(), 0);
      likelihoods[choice->option] = 1;
      dialogue_.Answer(query.id, likelihoods);
    } else if (std::holds_alternative<ui_bridge::RefuseAll>(response)) {
      dialogue_.NoneOfThese();
    }
  });
}

void Person::ShowSession(const msg::Session& event) {
  if (event.kind == msg::SessionKind::kConfirmed) confirmed_.insert(event.session_id);
  if (event.kind == msg::SessionKind::kConfirmed || event.kind == msg::SessionKind::kAbandoned)
    wants_.ForgetSession();
}

Table::Table(Bus& bus, RunLoop& loop, const Clock& clock)
    : bus_(bus), loop_(loop), clock_(clock), timer_(loop.Every(kSecond / 5, [this] { Show(); })) {}

void Table::Show() {
  msg::Scene scene;
  scene.utime = clock_.Now();
  scene.seq = scene.frame_seq = ++scenes_;
  scene.source = "table";
  scene.width = 640;
  scene.height = 480;
  scene.has_table = true;
  scene.objects = {Object(1, "Carton", 0, 0.5), Object(2, "Mug", 0.2, 0.4),
                   Object(3, "Mug", -0.2, 0.6), Object(4, "Box", 0.3, 0.7),
                   Object(5, "Tin", -0.3, 0.5)};
  msg::Poses poses;
  poses.utime = scene.utime;
  poses.seq = poses.scene_seq = scene.seq;
  (void)bus_.Publish(scene);
  (void)bus_.Publish(poses);
}

std::vector<std::pair<std::string, std::string>> WishesAtTable() {
  return {{"Open", "Carton"}, {"Pour", "Carton"}, {"Drink", "Mug"}, {"Grasp", "Mug"},
          {"Move", "Box"},    {"Open", "Box"},    {"Pour", "Tin"},  {"Grasp", "Tin"}};
}

}  // namespace beckon::faults
