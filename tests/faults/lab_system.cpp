#include "tests/faults/lab_system.h"

#include <SQLiteCpp/SQLiteCpp.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace beckon::faults {
namespace {

namespace fs = std::filesystem;
using trust::Role;

trust::Roles Of(Role role) {
  trust::Roles roles;
  roles.Add(role);
  return roles;
}

}  // namespace

std::vector<HostSpec> SeparateHosts() {
  return {{"camera", Of(Role::kPerception)},
          {"hub", Of(Role::kIntention)},
          {"bedside", Of(Role::kFrontEnd)},
          {"robot", Of(Role::kRobot)},
          {"stranger", trust::Roles::All(), /*trusted=*/false}};
}

LabSystem::LabSystem(Lab& lab, const TrialOptions& options, const Placement& placement)
    : lab_(lab),
      placement_(placement),
      supervisor_(loop_, steady_, [this](const tool::Death& death) { deaths_.push_back(death); }) {
  config_.bin_dir = options.bin_dir;
  config_.run_dir = lab.folder(placement.hub);
  config_.lcm_url = Lab::LcmUrl();
  config_.seed = kSceneSeed;
  config_.db = config_.run_dir + "/history.db";
  config_.user = "tester";
  config_.sessions = 1'000'000;
  bus_ = lab.OpenBus(placement.robot, "robot", clock_, [this](Bus& bus) {
    watch_ = std::make_unique<tool::BusWatch>(
        bus, clock_, steady_, config_.user,
        [this](const tool::SessionRecord& record) { sessions_.push_back(record); });
    bus.Subscribe<msg::Session>([this](const msg::Session& session) {
      if (session.kind == msg::SessionKind::kRequestStart) requested_.insert(session.session_id);
      if (session.kind == msg::SessionKind::kConfirmed) acknowledged_.insert(session.session_id);
    });
    bus.Subscribe<msg::Task>([this](const msg::Task& task) {
      acknowledged_.insert(task.task_id);
      const auto [known, is_new] = tasks_.emplace(task.task_id, task);
      if (!is_new && (known->second.action != task.action ||
                      known->second.object.category != task.object.category))
        ++contradictions_;
    });
  });
  loop_.AddFd(bus_->fd(), [this] { bus_->HandleReadable(); });
}

Status LabSystem::Start(size_t host, const tool::ProcessSpec& spec) {
  return supervisor_.Start(lab_.At(host, spec), tool::Supervisor::Restart::kAlways);
}

Status LabSystem::StartServices() {
  for (const auto& spec :
       {tool::PerceptionSpec(config_), tool::PoseSpec(config_), tool::CaptureSpec(config_)}) {
    if (auto started = Start(placement_.camera, spec); !started) return started;
  }
  return Start(placement_.hub, tool::IntentionSpec(config_));
}

Status LabSystem::StartUser() {
  if (!fs::exists(config_.TruthFile())) {
    auto truth = tool::ChildProcess::Start(tool::TruthSpec(config_));
    if (!truth) return truth.error();
    const auto exit = truth->Wait(60'000);
    if (!exit || exit->code != 0 || exit->signal != 0) return Error{"no truth of the scene"};
  }
  return Start(
      placement_.bedside,
      tool::UiBridgeSpec(config_, {"simulated"}, std::string(kAction) + ":" + kCategory, false));
}

Status LabSystem::StartPage() {
  const std::string file = config_.run_dir + "/page.toml";
  std::ofstream(file) << "[web]\nport = 0\n";
  auto spec = tool::UiBridgeSpec(config_, {"web"}, "", false);
  spec.args.insert(spec.args.end(), {"--config", file});
  return Start(placement_.bedside, spec);
}

bool LabSystem::AllAnswer(double timeout_s) {
  const Utime now = clock_.Now();
  return RunUntil(
      [&] {
        return std::ranges::all_of(kServices, [&](const char* service) {
          if (!supervisor_.Pid(service)) return std::string(service) == "ui_bridge";
          const auto* status = watch_->StatusOf(service);
          return status != nullptr && status->utime > now;
        });
      },
      timeout_s);
}

bool LabSystem::ASessionEnds(double timeout_s) {
  const int ended = watch_->observer().ended();
  return RunUntil([&] { return watch_->observer().ended() > ended; }, timeout_s);
}

int64_t LabSystem::Counter(const std::string& service, const std::string& name) const {
  const auto* status = watch_->StatusOf(service);
  if (status == nullptr) return 0;
  const auto found = std::ranges::find(status->counters, name, &msg::Counter::name);
  return found == status->counters.end() ? 0 : found->value;
}

int LabSystem::WrongTasks() const {
  return contradictions_ +
         static_cast<int>(std::ranges::count_if(tasks_, [this](const auto& entry) {
           const auto& [id, task] = entry;
           return task.action != kAction || task.object.category != kCategory ||
                  (hears_all_requests_ && !requested_.contains(id));
         }));
}

void LabSystem::CheckDatabase(Verdict& verdict) {
  supervisor_.Stop("intention", SIGTERM, 5000);
  SQLite::Database db(config_.db, SQLite::OPEN_READONLY);
  const std::string integrity = db.execAndGet("PRAGMA integrity_check").getString();
  if (integrity != "ok") verdict.Breach("integrity_check says " + integrity);
  std::map<std::string, int> on_disk;
  SQLite::Statement rows(db, "SELECT uid FROM rows WHERE kind = 'session'");
  while (rows.executeStep()) {
    const std::string uid = rows.getColumn(0).getString();
    ++on_disk[uid.substr(uid.find('/') + 1)];
  }
  for (const auto& [id, count] : on_disk)
    if (count != 1)
      verdict.Breach("session " + id + " is on disk " + std::to_string(count) + " times");
  for (const auto& id : acknowledged_)
    if (!on_disk.contains(id))
      verdict.Breach("session " + id + " was acknowledged and is not on disk");
  verdict.details["sessions_acknowledged"] = acknowledged_.size();
  verdict.details["sessions_on_disk"] = on_disk.size();
}

std::string LabSystem::Logs() const {
  std::string text;
  for (const auto& entry : fs::directory_iterator(config_.run_dir)) {
    if (entry.path().extension() != ".log") continue;
    std::ifstream file(entry.path());
    std::stringstream log;
    log << file.rdbuf();
    const std::string all = log.str();
    text += "== " + entry.path().filename().string() + "\n" +
            all.substr(all.size() > 1500 ? all.size() - 1500 : 0);
  }
  return text;
}

}  // namespace beckon::faults
