// Many users' short dialogues at once over a network that loses, doubles and reorders, while a
// camera fills it.
#include <SQLiteCpp/SQLiteCpp.h>

#include <algorithm>
#include <csignal>
#include <map>
#include <memory>
#include <random>
#include <set>

#include "tests/faults/lab_system.h"
#include "tests/faults/person.h"
#include "tools/beckon/simulated_robot.h"

namespace beckon::faults {
namespace {

constexpr int kPeople = 12;
constexpr size_t kFrameBytes = 150'000;
constexpr int kFramesPerSecond = 30;
constexpr FaultRates kBadNetwork = {.loss = 0.01, .duplicate = 0.02, .reorder = 0.05};
constexpr double kTaskLife_s = 35;  // of a TASK, and a bit: what has not come by then never will

/// The robot, and what it was told.
class Robot {
 public:
  Robot(Lab& lab, size_t host, RunLoop& loop, const Clock& clock) {
    bus_ = lab.OpenBus(host, "robot", clock, [this, &clock](Bus& bus) {
      bus.Subscribe<msg::Task>([this, &bus, &clock](const msg::Task& task) {
        const auto [known, is_new] = told.emplace(task.task_id, task);
        contradictions += !is_new && (known->second.action != task.action ||
                                      known->second.object.object_id != task.object.object_id)
                              ? 1
                              : 0;
        for (const auto& status : robot_.OnTask(task, clock.Now())) (void)bus.Publish(status);
      });
    });
    loop.AddFd(bus_->fd(), [this] { bus_->HandleReadable(); });
  }

  std::map<std::string, msg::Task> told;
  int contradictions = 0;  // one id, two tasks

 private:
  std::unique_ptr<Bus> bus_;
  tool::SimulatedRobot robot_;
};

/// Noise in the shape of images, 30 times a second.
class Camera {
 public:
  Camera(Lab& lab, size_t host, RunLoop& loop, const Clock& clock, uint64_t seed) {
    frame_.source = "noise";
    frame_.width = 640;
    frame_.height = 480;
    frame_.intrinsics = {525, 525, 319.5, 239.5};
    frame_.depth.resize(kFrameBytes);
    std::mt19937 random(static_cast<unsigned>(seed));
    std::ranges::generate(frame_.depth, [&] { return static_cast<uint8_t>(random()); });
    bus_ = lab.OpenBus(host, "camera", clock, [](Bus&) {});
    table_ = std::make_unique<Table>(*bus_, loop, clock);
    loop.Every(kSecond / kFramesPerSecond, [this, &clock] {
      frame_.utime = clock.Now();
      ++frame_.seq;
      ++frame_.depth[0];
      (void)bus_->Publish(frame_);
    });
  }
  int64_t frames() const { return frame_.seq; }

 private:
  msg::Frame frame_;
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<Table> table_;
};

/// Of sessions that were confirmed: on disk, and how often.
std::map<std::string, int> OnDisk(const std::string& file) {
  SQLite::Database db(file, SQLite::OPEN_READONLY, 2000);
  SQLite::Statement select(db, "SELECT uid FROM rows WHERE kind = 'session'");
  std::map<std::string, int> sessions;
  while (select.executeStep()) {
    const std::string uid = select.getColumn(0).getString();
    ++sessions[uid.substr(uid.find('/') + 1)];
  }
  return sessions;
}

using People = std::vector<std::unique_ptr<Person>>;

size_t Confirmed(const People& people) {
  size_t n = 0;
  for (const auto& person : people) n += person->confirmed().size();
  return n;
}

/// Lost: said to be confirmed, and the robot never heard of it.
void Judge(const People& people, const Robot& robot, const std::string& db, Verdict& verdict) {
  std::set<std::string> known;
  int lost = 0, wrong = 0, doubled = robot.contradictions;
  for (const auto& person : people) {
    for (const auto& id : person->confirmed()) {
      const auto told = robot.told.find(id);
      lost += told == robot.told.end() ? 1 : 0;
    }
    for (const auto& [id, task] : robot.told) {
      if (task.user != person->wish().user) continue;
      known.insert(id);
      wrong +=
          task.action != person->wish().action || task.object.category != person->wish().category
              ? 1
              : 0;
    }
  }
  wrong += static_cast<int>(robot.told.size() - known.size());  // nobody's
  for (const auto& [id, rows] : OnDisk(db)) doubled += rows > 1 ? 1 : 0;
  verdict.details["tasks"] = robot.told.size();
  verdict.details["lost"] = lost;
  verdict.details["doubled"] = doubled;
  verdict.details["wrong"] = wrong;
  if (lost > 0) verdict.Breach(std::to_string(lost) + " tasks were lost");
  if (doubled > 0) verdict.Breach(std::to_string(doubled) + " tasks were doubled");
  if (wrong > 0) verdict.Breach(std::to_string(wrong) + " tasks were wrong");
}

}  // namespace

Result<Verdict> RunLoss(const TrialOptions& options) {
  auto lab = Lab::Make(SeparateHosts(), options.seed);
  if (!lab) return lab.error();
  const SystemClock clock;
  const SteadyClock steady;
  RunLoop loop;
  const Placement at;
  tool::FleetConfig config{.bin_dir = options.bin_dir,
                           .run_dir = (*lab)->folder(at.hub),
                           .lcm_url = Lab::LcmUrl(),
                           .db = (*lab)->folder(at.hub) + "/history.db"};
  auto intention = tool::ChildProcess::Start((*lab)->At(at.hub, tool::IntentionSpec(config)));
  if (!intention) return intention.error();
  (*lab)->relay().Change([](LinkFaults& faults) { faults.SetRates(kBadNetwork); });
  Camera camera(**lab, at.camera, loop, clock, options.seed);
  Robot robot(**lab, at.robot, loop, clock);
  People people;
  const auto wishes = WishesAtTable();
  const auto bedside = (*lab)->OpenBus(at.bedside, "people", clock, [&](Bus& bus) {
    for (int i = 0; i < kPeople; ++i) {
      const auto& [action, category] = wishes[static_cast<size_t>(i) % wishes.size()];
      const std::string user = "user" + std::to_string(i);
      people.push_back(std::make_unique<Person>(
          Person::Wish{user, user + "@bedside", action, category}, bus, loop, clock, steady));
      people.back()->GoOn(true);
    }
  });
  loop.AddFd(bedside->fd(), [&] { bedside->HandleReadable(); });

  Verdict verdict;
  const Stopwatch watch;
  const auto n = static_cast<size_t>(options.n);
  const bool done = RunUntil(
      loop, [&] { return Confirmed(people) >= n; }, 60 + options.n * 1.0);
  const double seconds = watch.Milliseconds() * 1e-3;
  for (const auto& person : people) person->GoOn(false);
  const auto all_told = [&] {
    return std::ranges::all_of(people, [&](const auto& person) {
      return std::ranges::all_of(person->confirmed(),
                                 [&](const auto& id) { return robot.told.contains(id); });
    });
  };
  RunUntil(loop, all_told, kTaskLife_s, 50'000);
  intention->Signal(SIGTERM);
  intention->Wait(5000);
  const size_t confirmed = Confirmed(people);
  Judge(people, robot, config.db, verdict);
  const auto counts = (*lab)->relay().counts();
  verdict.details["dialogues"] = confirmed;
  verdict.details["dialogues_per_hour"] = static_cast<double>(confirmed) / seconds * 3600;
  verdict.details["frames"] = camera.frames();
  verdict.details["relay"] = {{"taken", counts.frames},
                              {"delivered", counts.delivered},
                              {"lost", counts.dropped},
                              {"doubled", counts.doubled},
                              {"overrun", counts.overrun}};
  if (!done) verdict.Breach("only " + std::to_string(confirmed) + " dialogues ended in time");
  if (verdict.holds) {
    char text[240];
    std::snprintf(
        text, sizeof text,
        "0 of %zu tasks lost, doubled or wrong (so fewer than %.2g of all, 95 %%); %lld of "
        "%lld packets lost, %.0f dialogues an hour",
        confirmed, 3.0 / static_cast<double>(confirmed), static_cast<long long>(counts.dropped),
        static_cast<long long>(counts.dropped + counts.delivered),
        static_cast<double>(confirmed) / seconds * 3600);
    verdict.found = text;
  }
  return verdict;
}

}  // namespace beckon::faults
