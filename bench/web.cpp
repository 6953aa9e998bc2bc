// How soon a page is obeyed, with the real programs: stop pressed on the page until REQUEST_STOP is
// on the bus, while frames flow; the same from the loop itself; an answer until the next question
// is in the page's event stream. Run it in a network of its own: unshare -rn, lo up, multicast
// route.
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "services/base/app.h"
#include "services/base/bus.h"
#include "services/base/run_loop.h"
#include "services/ui_bridge/service.h"
#include "tests/ui_bridge/web/http_client.h"

namespace {

using namespace beckon;
namespace web = ui_bridge::web;

struct Options {
  AppOptions app;
  std::string bin;  // folder of the programs; empty = this program's
  std::string json;
  int stops = 2000;
  int answers = 300;
  int frame_bytes = 1'000'000;
  double frames_per_s = 30;
};

double Milliseconds(Utime us) { return static_cast<double>(us) / 1000; }

/// A program that ends with this object.
class Child {
 public:
  Child(std::vector<std::string> args, const std::string& out) {
    pid_ = fork();
    if (pid_ != 0) return;
    const int fd = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(fd, STDOUT_FILENO);
    dup2(fd, STDERR_FILENO);
    std::vector<char*> argv;
    for (auto& arg : args) argv.push_back(arg.data());
    argv.push_back(nullptr);
    execv(argv[0], argv.data());
    _exit(127);
  }
  ~Child() {
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
  }
  Child(const Child&) = delete;

 private:
  pid_t pid_;
};

/// A bus in a thread of its own.
class BusThread {
 public:
  using SetUp = std::function<void(Bus&, RunLoop&)>;
  BusThread(const std::string& url, const SetUp& set_up) {
    auto bus = Bus::Open(url);
    if (!bus) throw std::runtime_error(bus.error().message);
    bus_ = *std::move(bus);
    loop_.AddFd(bus_->fd(), [this] { bus_->HandleReadable(); });
    set_up(*bus_, loop_);
    thread_ = std::thread([this] { loop_.Run(); });
  }
  ~BusThread() {
    loop_.Stop();
    thread_.join();
  }

 private:
  RunLoop loop_;
  std::unique_ptr<Bus> bus_;
  std::thread thread_;
};

/// When each REQUEST_STOP was heard first, by the time at which it was made.
class StopWatch {
 public:
  explicit StopWatch(const std::string& url)
      : thread_(url, [this](Bus& bus, RunLoop&) {
          bus.Subscribe<msg::Session>([this](const msg::Session& s) { Hear(s); });
        }) {}

  /// Until a stop made at or after `pressed` is heard, us; none within 2 s: -1.
  Utime Wait(Utime pressed) {
    std::unique_lock lock(mutex_);
    const bool heard = changed_.wait_for(
        lock, std::chrono::seconds(2), [&] { return heard_.lower_bound(pressed) != heard_.end(); });
    return heard ? heard_.lower_bound(pressed)->second - pressed : -1;
  }

 private:
  void Hear(const msg::Session& request) {
    if (request.kind != msg::SessionKind::kRequestStop) return;
    const Utime now = SystemClock().Now();
    {
      std::lock_guard lock(mutex_);
      heard_.emplace(request.utime, now);
    }
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<Utime, Utime> heard_;
  BusThread thread_;
};

/// Images of a camera that shows noise.
BusThread Frames(const Options& options) {
  return BusThread(options.app.lcm_url, [&options](Bus& bus, RunLoop& loop) {
    auto frame = std::make_shared<msg::Frame>();
    frame->source = "bench";
    frame->width = 640;
    frame->height = 480;
    frame->intrinsics = {525, 525, 319.5, 239.5};
    frame->colour_codec = msg::ColourCodec::kJpeg;
    frame->depth.resize(static_cast<size_t>(options.frame_bytes) * 4 / 5);
    frame->colour.resize(static_cast<size_t>(options.frame_bytes) / 5);
    std::mt19937 random(1);
    for (auto* bytes : {&frame->depth, &frame->colour})
      std::ranges::generate(*bytes, [&] { return static_cast<uint8_t>(random()); });
    loop.Every(static_cast<Utime>(kSecond / options.frames_per_s), [&bus, frame] {
      frame->utime = SystemClock().Now();
      ++frame->seq;
      ++frame->colour[0];
      (void)bus.Publish(*frame);
    });
  });
}

/// A table with eight things, seen and fitted ten times a second.
BusThread Table(const std::string& url) {
  return BusThread(url, [](Bus& bus, RunLoop& loop) {
    auto scene = std::make_shared<msg::Scene>();
    scene->source = "bench";
    scene->width = 640;
    scene->height = 480;
    scene->intrinsics = {525, 525, 319.5, 239.5};
    scene->has_table = true;
    scene->X_WC.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    scene->X_WC.translation() = Eigen::Vector3d(0, 0, 0.5);
    for (const char* category : {"Carton", "Mug", "Bowl", "Bottle", "Box", "Tube", "Can", "Tin"}) {
      msg::SceneObject object;
      object.id = static_cast<int>(scene->objects.size()) + 1;
      object.category = category;
      object.confidence = 0.95f;
      object.probabilities = {{category, 1.f}};
      object.centroid_W = {-0.35 + 0.1 * object.id, 0.5, 0.05};
      object.extent_W = {0.06, 0.06, 0.1};
      object.n_points = 100;
      for (int16_t k = 0; k < 40; ++k)
        object.outline_px.push_back({k, static_cast<int16_t>(2 * k)});
      scene->objects.push_back(object);
    }
    loop.Every(kSecond / 10, [&bus, scene] {
      scene->utime = SystemClock().Now();
      scene->frame_seq = ++scene->seq;
      (void)bus.Publish(*scene);
      msg::Poses poses{.utime = scene->utime, .seq = scene->seq, .scene_seq = scene->seq};
      (void)bus.Publish(poses);
    });
  });
}

nlohmann::ordered_json Report(const char* what, std::vector<Utime> times_us, int lost) {
  std::ranges::sort(times_us);
  const auto at = [&](double share) {
    if (times_us.empty()) return 0.0;
    const auto n = static_cast<double>(times_us.size());
    return Milliseconds(times_us[std::min(times_us.size() - 1, static_cast<size_t>(share * n))]);
  };
  std::printf("%-44s %6zu %5d %8.2f %8.2f %8.2f %8.2f %8.2f\n", what, times_us.size(), lost,
              at(0.5), at(0.95), at(0.99), at(0.999), at(1));
  return {{"what", what},       {"n", times_us.size()}, {"lost", lost},         {"p50_ms", at(0.5)},
          {"p95_ms", at(0.95)}, {"p99_ms", at(0.99)},   {"p999_ms", at(0.999)}, {"max_ms", at(1)}};
}

/// The port that beckon-ui-bridge says in its log; 0 where it says none.
int WaitForPort(const std::string& log) {
  for (int i = 0; i < 200; ++i) {
    std::ifstream file(log);
    for (std::string line; std::getline(file, line);) {
      if (const size_t at = line.find("http://127.0.0.1:"); at != std::string::npos)
        return std::atoi(line.c_str() + at + 17);
    }
    usleep(50'000);
  }
  return 0;
}

struct Timed {
  std::vector<Utime> times_us;
  int lost = 0;
  void Add(Utime time_us) { time_us < 0 ? ++lost : (times_us.push_back(time_us), 0); }
};

/// Presses at moments that have nothing to do with the frames'.
Timed Press(const Options& options, const std::function<void()>& stop) {
  StopWatch watch(options.app.lcm_url);
  std::mt19937 random(2);
  Timed timed;
  for (int i = 0; i < options.stops; ++i) {
    usleep(10'000 + random() % 20'000);
    const Utime pressed = SystemClock().Now();
    stop();
    timed.Add(watch.Wait(pressed));
  }
  return timed;
}

Timed StopsByPage(const Options& options, int port) {
  std::atomic<bool> open = true;
  std::thread page([&] {  // as a browser reads it
    web::Stream stream(port, "?view=partner");
    while (open) stream.Next(0.1);
  });
  auto timed = Press(options, [port] {
    web::Send(port, "POST", "/api/request", {{"request", "stop"}});
  });
  open = false;
  page.join();
  return timed;
}

/// Hands its sink out.
class Bare final : public ui_bridge::FrontEnd {
 public:
  explicit Bare(ui_bridge::FrontEndSink& sink) { made = &sink; }
  msg::Interface Announce() const override { return {}; }
  void Begin() override {}
  void Present(const msg::Query&) override {}
  void Withdraw() override {}
  void ShowSession(const msg::Session&) override {}
  void ShowNotice(const std::string&) override {}
  std::string State() const override { return "bare"; }
  static inline ui_bridge::FrontEndSink* made = nullptr;
};

class BareFactory final : public ui_bridge::FrontEndFactory {
 public:
  std::string name() const override { return "bare"; }
  std::string summary() const override { return "for measuring"; }
  Result<std::unique_ptr<ui_bridge::FrontEnd>> Create(
      const ui_bridge::FrontEndSetup& setup) override {
    return std::unique_ptr<ui_bridge::FrontEnd>(std::make_unique<Bare>(setup.sink));
  }
};

Timed StopsBySink(const Options& options) {
  const SystemClock clock;
  const SteadyClock steady;
  std::unique_ptr<ui_bridge::Service> service;
  RunLoop* bridge = nullptr;
  BareFactory factory;
  BusThread thread(options.app.lcm_url, [&](Bus& bus, RunLoop& loop) {
    bridge = &loop;
    bus.Subscribe<msg::Frame>([](const msg::Frame&) {}, 1);
    service = std::make_unique<ui_bridge::Service>(
        ui_bridge::ServiceConfig{.user = "bench", .device = "bare"}, bus, loop, clock, steady);
    if (auto added = service->Add(factory); !added) throw std::runtime_error(added.error().message);
    service->Begin();
  });
  return Press(options,
               [&] { bridge->Post([] { Bare::made->Request(msg::SessionKind::kRequestStop); }); });
}

bool IsOpen(const web::Json& state) {
  return state["query"].is_object() && !state["query"]["answered"];
}

/// Answers at random, session after session.
Timed Answers(const Options& options, int port) {
  web::Stream page(port, "?view=user");
  std::mt19937 random(3);
  Timed timed;
  while (static_cast<int>(timed.times_us.size()) < options.answers && timed.lost < 20) {
    if (!page.Until([](const web::Json& s) { return IsOpen(s) || s["phase"] == "idle"; }, 10)) {
      ++timed.lost;
      continue;
    }
    if (page.state()["phase"] == "idle") {
      web::Send(port, "POST", "/api/request", {{"request", "start"}});
      page.Next(0.2);
      continue;
    }
    const web::Json query = page.state()["query"];
    const Utime pressed = SystemClock().Now();
    web::Send(port, "POST", "/api/answer",
              {{"query_id", query["id"]}, {"option", random() % query["options"].size()}});
    const bool came = page.Until([&](const web::Json& s) {
      return s["phase"] == "idle" || (IsOpen(s) && s["query"]["id"] != query["id"]);
    });
    if (page.state()["phase"] != "idle") timed.Add(came ? SystemClock().Now() - pressed : -1);
  }
  return timed;
}

Status Run(Options& options) {
  char name[] = "/tmp/beckon-bench-web-XXXXXX";
  const std::string folder = mkdtemp(name);
  if (options.bin.empty())
    options.bin = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const std::string config = folder + "/web.toml", log = folder + "/web.log";
  std::ofstream(folder + "/index.html") << "<!doctype html>";
  std::ofstream(config) << "[web]\nport = 0\npage = \"" << folder << "\"\ndata = \"" << folder
                        << "\"\n";
  const auto bridge = [&] {
    return Child({options.bin + "/beckon-ui-bridge", "--front-end", "web", "--user", "bench",
                  "--config", config, "--lcm-url", options.app.lcm_url},
                 log);
  };
  std::printf("%-44s %6s %5s %8s %8s %8s %8s %8s\n", "ms", "n", "lost", "p50", "p95", "p99",
              "p99.9", "max");
  nlohmann::ordered_json rows;
  {
    const Child program = bridge();
    const int port = WaitForPort(log);
    if (port == 0) return Error{log + ": beckon-ui-bridge serves no page"};
    const BusThread frames = Frames(options);
    auto timed = StopsByPage(options, port);
    rows.push_back(Report("stop on the page -> on the bus", timed.times_us, timed.lost));
    timed = StopsBySink(options);
    rows.push_back(Report("stop in the loop -> on the bus", timed.times_us, timed.lost));
  }
  if (std::filesystem::exists(options.bin + "/beckon-intention")) {
    std::filesystem::remove(log);
    const Child intention({options.bin + "/beckon-intention", "--db", folder + "/history.db",
                           "--lcm-url", options.app.lcm_url},
                          folder + "/intention.log");
    const Child program = bridge();
    const int port = WaitForPort(log);
    const BusThread frames = Frames(options);
    const BusThread table = Table(options.app.lcm_url);
    const auto timed = Answers(options, port);
    rows.push_back(Report("answer on the page -> next question on it", timed.times_us, timed.lost));
  }
  std::filesystem::remove_all(folder);
  if (!options.json.empty())
    std::ofstream(options.json)
        << nlohmann::ordered_json{{"version", VersionString()}, {"rows", rows}}.dump(1) << '\n';
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Times stops and answers through the page, on the bus of --lcm-url",
               "beckon-bench-web");
  Options options;
  AddAppOptions(app, options.app);
  app.add_option("--bin", options.bin, "Folder of the programs (default: this one's)");
  app.add_option("--stops", options.stops, "Of each kind")->check(CLI::Range(1, 1'000'000));
  app.add_option("--answers", options.answers, "Answers to time")->check(CLI::Range(1, 1'000'000));
  app.add_option("--frame-bytes", options.frame_bytes, "Size of a frame")
      ->check(CLI::Range(1000, 10'000'000));
  app.add_option("--frames-per-s", options.frames_per_s, "How often")->check(Within(0.1, 1000.0));
  app.add_option("--json", options.json, "Write the figures here as well");
  return RunApp(app, argc, argv, options.app, [&] { return Run(options); });
}
