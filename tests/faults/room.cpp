#include "tests/faults/room.h"

#include <SQLiteCpp/SQLiteCpp.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>

namespace beckon::faults {
namespace {

constexpr char kFakeTime[] = "/usr/lib/x86_64-linux-gnu/faketime/libfaketime.so.1";
constexpr int kPatience_ms = 2000;

}  // namespace

Status FakeTimeIsThere() {
  if (std::filesystem::exists(kFakeTime)) return {};
  return Error{std::string(kFakeTime) + " is missing: deploy/install-deps libfaketime"};
}

Room::Room(Lab& lab, size_t host, const std::vector<Person::Wish>& wishes, RunLoop& loop)
    : lab_(lab), host_(host), loop_(loop) {
  bus_ = lab.OpenBus(host, "room", clock_, [&](Bus& bus) {
    table_ = std::make_unique<Table>(bus, loop, clock_);
    for (const auto& wish : wishes)
      people_.push_back(std::make_unique<Person>(wish, bus, loop, clock_, steady_));
    bus.Subscribe<msg::Task>([this](const msg::Task& task) { Hear(task); });
    bus.Subscribe<msg::Status>([this](const msg::Status& status) {
      if (service_ && service_->pid() == status.pid) status_ = status;
    });
  });
  loop_.AddFd(bus_->fd(), [this] { bus_->HandleReadable(); });
}

Room::~Room() { loop_.RemoveFd(bus_->fd()); }

Status Room::StartService(const TrialOptions& options, const std::string& db, Utime skew) {
  status_.reset();
  const std::string time = lab_.folder(host_) + "/time";
  Jump(skew);
  std::vector<std::string> environment;
  if (FakeTimeIsThere())
    environment = {std::string("LD_PRELOAD=") + kFakeTime, "FAKETIME_DONT_FAKE_MONOTONIC=1",
                   "FAKETIME_CACHE_DURATION=1", "FAKETIME_TIMESTAMP_FILE=" + time};
  const std::string name = lab_.keys(host_).Own()->value().node.name;
  auto started = tool::ChildProcess::Start(
      lab_.At(host_,
              {.name = "intention",
               .program = options.bin_dir + "/beckon-intention",
               .args = {"--db", db, "--machine", name, "--lcm-url", Lab::LcmUrl()},
               .log_file = lab_.folder(host_) + "/intention.log",
               .stdin_file = {}},
              environment));
  if (!started) return started.error();
  service_ = *std::move(started);
  return {};
}

void Room::Jump(Utime skew) {
  clock_.skew = skew;
  const std::string time = lab_.folder(host_) + "/time";
  std::ofstream(time + ".new") << (skew < 0 ? "" : "+") << skew / kSecond << '\n';
  std::filesystem::rename(time + ".new", time);
}

void Room::KillService() {
  service_->Signal(SIGKILL);
  service_->Wait(kPatience_ms);
}

void Room::Hear(const msg::Task& task) {
  tasks_.emplace(task.task_id, task);
  (void)bus_->Publish(msg::TaskStatus{clock_.Now(), task.task_id, msg::TaskState::kDone, "", {}});
}

int64_t Room::Counter(const std::string& name) const {
  if (!status_) return 0;
  const auto found = std::ranges::find(status_->counters, name, &msg::Counter::name);
  return found == status_->counters.end() ? 0 : found->value;
}

void Room::GoOn(bool goes_on) {
  for (const auto& person : people_) person->GoOn(goes_on);
}

std::set<std::string> Room::Acknowledged() const {
  std::set<std::string> sessions;
  for (const auto& [id, task] : tasks_) sessions.insert(id);
  for (const auto& person : people_)
    sessions.insert(person->confirmed().begin(), person->confirmed().end());
  return sessions;
}

std::set<std::string> RowsOf(const std::string& db) {
  std::set<std::string> rows;
  SQLite::Database database(db, SQLite::OPEN_READONLY, kPatience_ms);
  SQLite::Statement select(database, "SELECT * FROM rows");
  while (select.executeStep()) {
    std::string row;
    for (int i = 0; i < select.getColumnCount(); ++i) row += select.getColumn(i).getString() + "|";
    rows.insert(row);
  }
  return rows;
}

std::vector<std::string> MissingIn(const std::string& db, const std::set<std::string>& sessions) {
  SQLite::Database database(db, SQLite::OPEN_READONLY, kPatience_ms);
  SQLite::Statement find(database, "SELECT COUNT(*) FROM rows WHERE uid = ?");
  std::vector<std::string> missing;
  for (const auto& id : sessions) {
    find.reset();
    find.bind(1, "session/" + id);
    if (!find.executeStep() || find.getColumn(0).getInt() == 0) missing.push_back(id);
  }
  return missing;
}

}  // namespace beckon::faults
