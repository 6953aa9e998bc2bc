// How quickly a long history reaches a machine that has none of it: two histories in one process,
// over the bus. Prints a table and writes JSON.
#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "services/base/app.h"
#include "services/base/utime.h"
#include "services/intention/history_service.h"
#include "services/intention/store_rows.h"

namespace beckon::intention {
namespace {

struct Options {
  std::string json;
  int rows = 100'000;
  int answers = 4;  // of each session
};

std::vector<HistoryRow> MadeUpRows(const Options& options, Utime now) {
  std::vector<HistoryRow> rows;
  for (int i = 0; i < options.rows; ++i) {
    SessionRecord session;
    session.session_id = "00000000-0000-4000-8000-" + std::to_string(100'000'000'000 + i);
    session.user = "user" + std::to_string(i % 3);
    session.device = "switch";
    session.utime = now + i;
    session.category = "Carton";
    session.action = "Open";
    session.questions = options.answers;
    session.posterior = 0.99875;
    session.present = {{"Carton", 1}, {"Mug", 2}};
    session.answers.assign(static_cast<size_t>(options.answers),
                           {QuestionKind::kObject, {0.25, 0.75}, 1, "switch"});
    rows.push_back({"sender", i + 1, "session", ToBody(session), now + i});
  }
  return rows;
}

/// A machine with a loop and a bus of its own, in a thread of its own.
class Machine {
 public:
  static Result<std::unique_ptr<Machine>> Make(std::unique_ptr<Store> store,
                                               const std::string& url) {
    auto bus = Bus::Open(url);
    if (!bus) return bus.error();
    return std::unique_ptr<Machine>(new Machine(std::move(store), *std::move(bus)));
  }
  ~Machine() {
    loop_.Stop();
    thread_.join();
  }
  int64_t rows() const { return rows_; }

 private:
  Machine(std::unique_ptr<Store> store, std::unique_ptr<Bus> bus)
      : store_(std::move(store)),
        bus_(std::move(bus)),
        history_(*store_, *bus_, loop_, clock_, [this](const msg::History& message) {
          if (Status sent = bus_->Publish(message); !sent)
            std::fprintf(stderr, "%s\n", sent.error().message.c_str());
        }) {
    loop_.AddFd(bus_->fd(), [this] { bus_->HandleReadable(); });
    loop_.Every(kSecond / 100, [this] {
      int64_t rows = 0;
      for (const auto& [origin, head] : store_->Heads()) rows += head.seq;
      rows_ = rows;
    });
    thread_ = std::thread([this] { loop_.Run(); });
  }

  const SystemClock clock_;
  const std::unique_ptr<Store> store_;
  const std::unique_ptr<Bus> bus_;
  RunLoop loop_;
  HistoryService history_;
  std::atomic<int64_t> rows_ = 0;
  std::thread thread_;
};

Result<std::unique_ptr<Store>> Fill(const std::string& path, const Options& options,
                                    nlohmann::ordered_json& figures) {
  const SystemClock clock;
  {
    auto store = Store::Open(path, "sender");
    if (!store) return store.error();
    const auto rows = MadeUpRows(options, clock.Now());
    const Stopwatch stopwatch;
    const auto added = (*store)->AddRows(rows, clock.Now());
    if (!added) return added.error();
    figures["import_s"] = stopwatch.Milliseconds() / 1000;
  }
  const Stopwatch opening;
  auto store = Store::Open(path, "sender");
  figures["open_ms"] = opening.Milliseconds();
  if (!store) return store;
  const Stopwatch heads;
  (*store)->Heads();
  figures["heads_ms"] = heads.Milliseconds();
  const Stopwatch reading;
  if (const auto sessions = (*store)->SessionsOf("user1"); !sessions) return sessions.error();
  figures["last_1000_sessions_ms"] = reading.Milliseconds();
  return store;
}

Status Measure(const Options& options, const std::string& folder, const std::string& url) {
  nlohmann::ordered_json figures = {{"rows", options.rows}, {"build", VersionString()}};
  auto full = Fill(folder + "/sender.db", options, figures);
  if (!full) return full.error();
  auto empty = Store::Open(folder + "/receiver.db", "receiver");
  if (!empty) return empty.error();
  auto sender = Machine::Make(*std::move(full), url);
  if (!sender) return sender.error();
  const Stopwatch stopwatch;
  auto receiver = Machine::Make(*std::move(empty), url);
  if (!receiver) return receiver.error();
  while ((*receiver)->rows() < options.rows && stopwatch.Milliseconds() < 60'000)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const double seconds = stopwatch.Milliseconds() / 1000;
  if ((*receiver)->rows() < options.rows)
    return Error{"only " + std::to_string((*receiver)->rows()) + " rows arrived in 60 s"};
  figures["share_s"] = seconds;
  figures["rows_per_s"] = options.rows / seconds;
  for (const auto& [name, value] : figures.items())
    std::printf("%-24s %s\n", name.c_str(), value.dump().c_str());
  if (!options.json.empty() && !(std::ofstream(options.json) << figures.dump(2) << '\n'))
    return Error{options.json + ": cannot write"};
  return {};
}

}  // namespace
}  // namespace beckon::intention

int main(int argc, char** argv) {
  CLI::App app("Measures how quickly a history is shared over the bus.", "beckon-bench-history");
  beckon::AppOptions common;
  beckon::intention::Options options;
  beckon::AddAppOptions(app, common);
  app.add_option("--rows", options.rows, "Sessions in the history")->check(CLI::PositiveNumber);
  app.add_option("--answers", options.answers, "Answers in each")->check(CLI::Range(0, 100));
  app.add_option("--json", options.json, "Where the figures go")->type_name("FILE");
  return beckon::RunApp(app, argc, argv, common, [&]() -> beckon::Status {
    std::string folder = (std::filesystem::temp_directory_path() / "beckon-bench-XXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) return beckon::Error{"cannot make a temporary folder"};
    const auto measured = beckon::intention::Measure(options, folder, common.lcm_url);
    std::filesystem::remove_all(folder);
    return measured;
  });
}
