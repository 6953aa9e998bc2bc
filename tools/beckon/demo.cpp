#include "tools/beckon/demo.h"

#include <spdlog/spdlog.h>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "services/base/app.h"
#include "services/base/run_loop.h"
#include "services/base/status_reporter.h"
#include "tools/beckon/bus_watch.h"
#include "tools/beckon/catalogue.h"
#include "tools/beckon/demo_options.h"
#include "tools/beckon/demo_picture.h"
#include "tools/beckon/fleet.h"
#include "tools/beckon/page_socket.h"
#include "tools/beckon/private_bus.h"
#include "tools/beckon/run_folder.h"
#include "tools/beckon/scene_check.h"
#include "tools/beckon/session_report.h"
#include "tools/beckon/supervisor.h"

namespace beckon::tool {
namespace {

constexpr Utime kLook_us = 50'000;
constexpr Utime kLastTask_us = 2 * kSecond;
constexpr Utime kHearsay_us = 1'200'000;  // services say once a second how they are
constexpr int kTruthPatience_ms = 60'000;
constexpr int kHopeless = 6;      // deaths in a row
constexpr int kBadInputExit = 2;  // of every Beckon program

/// One run; ends the loop when it knows the outcome.
class Demo {
 public:
  Demo(DemoOptions options, FleetConfig fleet, Catalogue catalogue, RunLoop& loop, Bus& bus)
      : options_(std::move(options)),
        fleet_(std::move(fleet)),
        catalogue_(std::move(catalogue)),
        loop_(loop),
        bus_(bus),
        supervisor_(loop, steady_, [this](const Death& death) { OnDeath(death); }),
        watch_(bus, clock_, steady_, options_.user,
               [this](const SessionRecord& record) { OnEnd(record); }),
        check_(CountImages(options_.input)) {
    Listen();
  }

  /// An Error where input was bad, else the exit code.
  Result<int> Run() {
    if (!simulated()) Greet();
    if (auto started = StartServices(); !started) return started.error();
    news_ = steady_.Now();
    loop_.Every(kLook_us, [this] { Look(); });
    loop_.Run();
    supervisor_.Stop("logger", SIGINT, 2000);  // it writes what it holds
    supervisor_.Stop();
    if (!simulated()) std::puts("");  // away from a prompt that was not answered
    if (bad_input_) return *bad_input_;
    if (!options_.picture.empty() && !loop_.interrupted()) {
      if (auto drawn = WriteDemoPicture(options_.picture, story_); !drawn && failure_.empty())
        return drawn.error();
    }
    if (!failure_.empty()) {
      std::fprintf(stderr, "beckon demo: %s (logs: %s)\n", failure_.c_str(),
                   fleet_.run_dir.c_str());
    }
    return failure_.empty() ? 0 : 1;
  }

  /// For STATUS.
  std::string State() const {
    return "plays the robot, " + std::string(watch_.robot().stopped() ? "stopped, " : "") +
           std::to_string(watch_.robot().tasks_done()) + " tasks done";
  }

 private:
  bool simulated() const { return HasFrontEnd(options_, "simulated"); }

  void Greet() const {
    const std::string what =
        options_.input.empty() ? "a made-up table (--input FILE for your own)" : options_.input;
    std::printf("Five services start and look at %s ...\n", what.c_str());
    std::fflush(stdout);
  }

  void Listen() {
    bus_.Subscribe<msg::Scene>([this](msg::Scene scene) {
      check_.OnScene(scene);
      story_.OnScene(std::move(scene));
    });
    if (options_.picture.empty()) return;
    bus_.Subscribe<msg::Frame>([this](msg::Frame frame) { story_.OnFrame(std::move(frame)); }, 1);
    bus_.Subscribe<msg::Poses>([this](msg::Poses poses) { story_.OnPoses(std::move(poses)); });
    bus_.Subscribe<msg::Query>([this](const msg::Query& query) { story_.OnQuery(query); });
  }

  Status StartServices() {
    if (!options_.record.empty()) {
      if (auto s =
              supervisor_.Start(LoggerSpec(fleet_, options_.record), Supervisor::Restart::kNever);
          !s)
        return s;
    }
    for (const auto& spec : {PerceptionSpec(fleet_), PoseSpec(fleet_), IntentionSpec(fleet_)}) {
      if (auto started = supervisor_.Start(spec); !started) return started;
    }
    if (simulated()) {
      if (auto known = FindOutWhatToWant(); !known) return known;
    }
    if (auto started = supervisor_.Start(CaptureSpec(fleet_)); !started) return started;
    return supervisor_.Start(UiBridgeSpec(fleet_, options_.front_ends, want_ ? want_->Text() : "",
                                          /*terminal=*/!simulated()),
                             Supervisor::Restart::kOnFailure);
  }

  /// Capture tells what really stands on the table, where anybody knows.
  Status FindOutWhatToWant() {
    // Of a folder of images nobody knows it.
    if (!std::filesystem::is_directory(options_.input)) {
      if (auto known = AskCapture(); !known) return known;
    }
    if (options_.want.empty() && !truth_.known) {
      return Error{"--input " + options_.input +
                   ": comes without ground truth; say what is wanted by --want ACTION:CATEGORY"};
    }
    auto want =
        options_.want.empty() ? catalogue_.Suggest(truth_) : catalogue_.ParseWant(options_.want);
    if (!want) return want.error();
    want_ = *std::move(want);
    return {};
  }

  Status AskCapture() {
    const auto spec = TruthSpec(fleet_);
    auto capture = ChildProcess::Start(spec);
    if (!capture) return capture.error();
    const auto exit = capture->Wait(kTruthPatience_ms);
    if (!exit || exit->code != 0 || exit->signal != 0) return Error{LastLine(spec.log_file)};
    auto truth = ReadSceneTruth(fleet_.TruthFile());
    if (!truth) return truth.error();
    truth_ = *std::move(truth);
    return {};
  }

  void Look() {
    const Utime now = steady_.Now();
    news_ = std::max(news_, watch_.observer().last_news());
    if (check_.usable() && !std::exchange(was_usable_, true)) news_ = now;
    if (!check_.usable() && check_.complete()) {
      if (!hopeless_since_) hopeless_since_ = now;
      if (now - *hopeless_since_ > kHearsay_us) return RefuseInput();
    }
    const double silent_s = static_cast<double>(now - news_) / kSecond;
    if (!simulated() || silent_s <= options_.timeout_s) return;
    if (check_.saw_scene() && !check_.usable()) return RefuseInput();
    Fail(Missing());
  }

  /// Nobody can talk about what is not seen. The embedded scene is ours: no fault of the user's.
  void RefuseInput() {
    const auto* status = watch_.StatusOf("perception");
    const std::string perception = status != nullptr ? status->state : "";
    if (!options_.input.empty())
      return BadInput(check_.Complaint("--input " + options_.input, perception));
    Fail(check_.Complaint("the embedded scene " + std::to_string(options_.seed), perception));
  }

  std::string Missing() const {
    const std::string after =
        " after " + std::to_string(static_cast<int>(options_.timeout_s)) + " s: ";
    if (!check_.saw_scene())
      return "no scene came" + after + watch_.Says("perception") + "; " + watch_.Says("capture");
    const std::string both = watch_.Says("intention") + "; " + watch_.Says("ui_bridge");
    if (watch_.observer().questions() == 0) return "no question came" + after + both;
    return "the conversation stands still" + after + both;
  }

  void OnEnd(const SessionRecord& record) {
    story_.OnEnd(record);
    if (simulated() || !OnTerminal()) {
      std::printf("%s\n", ReportLine(record, want_ ? &*want_ : nullptr, truth_).c_str());
      std::fflush(stdout);
    }
    if (want_ && !IsCorrect(record, *want_, truth_) && failure_.empty()) {
      failure_ = Complaint(record, *want_);
      // The simulated user's last word is why it gave up.
      if (!record.task) failure_ += " " + LastLine(fleet_.run_dir + "/ui_bridge.log");
    }
    // The front end leaves by itself after its last session; a moment for it, then we end.
    if (fleet_.sessions > 0 && watch_.observer().ended() >= fleet_.sessions) {
      loop_.After(kSecond, [this] { loop_.Stop(); });
    }
  }

  void OnDeath(const Death& death) {
    if (death.name == "ui_bridge" && death.exit.code == 0 && death.exit.signal == 0) {
      if (!simulated() || watch_.observer().ended() >= fleet_.sessions) return loop_.Stop();
      // A last TASK may be on its way.
      loop_.After(kLastTask_us, [this, why = death.last_line] {
        Fail("the simulated user left after " + std::to_string(watch_.observer().ended()) + " of " +
             std::to_string(fleet_.sessions) + " sessions: " + why);
      });
      return;
    }
    // A program that refuses its input at the start will refuse it for ever.
    if (death.exit.code == kBadInputExit) return BadInput(death.last_line);
    if (death.name == "logger") return Fail("lcm-logger ended: " + death.last_line);
    if (death.in_a_row >= kHopeless) {
      return Fail(death.name + " keeps dying (" + death.exit.Text() + "): " + death.last_line);
    }
    spdlog::warn("{} died ({}): {}", death.name, death.exit.Text(), death.last_line);
  }

  void Fail(const std::string& why) {
    if (failure_.empty()) failure_ = why;
    loop_.Stop();
  }

  void BadInput(const std::string& why) {
    if (!bad_input_) bad_input_ = Error{why};
    loop_.Stop();
  }

  const DemoOptions options_;
  const FleetConfig fleet_;
  const Catalogue catalogue_;
  RunLoop& loop_;
  Bus& bus_;
  const SystemClock clock_;
  const SteadyClock steady_;
  Supervisor supervisor_;
  BusWatch watch_;
  SceneCheck check_;
  DemoStory story_;
  bool was_usable_ = false;
  std::optional<Utime> hopeless_since_;
  Utime news_ = 0;
  SceneTruth truth_;
  std::optional<Want> want_;
  std::string failure_;
  std::optional<Error> bad_input_;
};

void ShowAddress(const PageSocket& page, const DemoOptions& options) {
  std::fprintf(OnTerminal() ? stdout : stderr, "The page: %s\n", page.Address().c_str());
  if (OnTerminal() && !options.no_browser) OpenInBrowser(page.Address());
}

}  // namespace

Result<int> RunDemo(const DemoOptions& given) {
  auto catalogue = Catalogue::Load(SharedFile("affordances.toml"));
  if (!catalogue) return catalogue.error();
  DemoOptions options = given;
  if (auto complete = CompleteOptions(options, *catalogue); !complete) return complete.error();
  PageSocket page;
  if (HasFrontEnd(options, "web")) {
    auto listening = PageSocket::Listen(options.port);
    if (!listening) return listening.error();
    page = *std::move(listening);
    ShowAddress(page, options);
  }
  auto folder = RunFolder::Make(options.logs, "beckon-demo");
  if (!folder) return folder.error();
  setenv("BECKON_KEYS", "", 1);  // its bus is its own; nothing on it is signed
  const PrivateBus network = EnterPrivateBus();
  if (!network.note.empty()) spdlog::warn("{}", network.note);

  RunLoop loop(/*handle_signals=*/true);
  auto bus = Bus::Open(network.lcm_url);
  if (!bus) return bus.error();
  loop.AddFd((*bus)->fd(), [&bus] { (*bus)->HandleReadable(); });
  FleetConfig fleet;
  fleet.bin_dir = OwnBinDir();
  fleet.run_dir = folder->path();
  fleet.lcm_url = network.lcm_url;
  fleet.input = options.input;
  fleet.seed = options.seed;
  fleet.db = options.db.empty() ? folder->path() + "/history.db" : options.db;
  fleet.policy = options.policy;
  fleet.user = options.user;
  fleet.sessions = options.sessions;
  fleet.think_s = options.think_s;
  fleet.flip = options.flip;
  fleet.page_socket = page.fd();

  Demo demo(options, fleet, *std::move(catalogue), loop, **bus);
  StatusReporter reporter("demo", **bus, loop,
                          [&demo](msg::Status& status) { status.state = demo.State(); });
  auto code = demo.Run();
  if (code && *code != 0) folder->Keep();
  return code;
}

}  // namespace beckon::tool
