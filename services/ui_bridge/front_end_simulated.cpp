// Front end "simulated": a user who wants one action on one kind of object and answers by itself.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <map>
#include <optional>
#include <random>
#include <utility>

#include "services/base/app.h"
#include "services/base/run_loop.h"
#include "services/base/scene_truth.h"
#include "services/ui_bridge/front_end.h"
#include "services/ui_bridge/simulated_user.h"

namespace beckon::ui_bridge {
namespace {

constexpr Utime kLookAgain_us = 100'000;
constexpr int kMaxLooks = 100;       // for scene and truth, before it gives up
constexpr Utime kRest_us = kSecond;  // from a stop to going on
constexpr double kVectorSure = 0.9;  // share of the likelihood that a vector gives the option meant

/// What it announces, besides its rate of errors.
struct SimulatedInterface {
  msg::InterfaceKind kind = msg::InterfaceKind::kYesNo;
  int max_options = 12;
  float seconds_per_question = 1;
  float seconds_per_option = 0;
};

struct SimulatedConfig {
  SimulatedUserConfig user;
  SimulatedInterface interface;
  std::string truth_file;
  int sessions = 1;
  double think_s = 0;
  double stop = 0;  // 0..1, chance that it presses stop instead of answering
};

class SimulatedFrontEnd final : public FrontEnd {
 public:
  SimulatedFrontEnd(SimulatedConfig config, const FrontEndSetup& setup)
      : config_(std::move(config)), setup_(setup), user_(config_.user), stops_(config_.user.seed) {}
  ~SimulatedFrontEnd() override { CancelTimer(); }

  msg::Interface Announce() const override {
    msg::Interface interface;
    interface.kind = config_.interface.kind;
    interface.max_options = config_.interface.max_options;
    interface.seconds_per_question = config_.interface.seconds_per_question;
    interface.seconds_per_option = config_.interface.seconds_per_option;
    interface.false_yes = interface.false_no = static_cast<float>(std::min(config_.user.flip, 0.5));
    return interface;
  }

  void Begin() override { setup_.sink.Request(msg::SessionKind::kRequestStart); }

  void Present(const msg::Query& query) override {
    query_ = query;
    looks_ = 0;
    Think(std::max<Utime>(1, static_cast<Utime>(config_.think_s * kSecond)));
  }

  void Withdraw() override {
    query_.reset();
    CancelTimer();
  }

  void ShowSession(const msg::Session& event) override {
    if (event.kind == msg::SessionKind::kBegun) in_session_ = true;
    if (event.kind == msg::SessionKind::kStopped && std::exchange(stopped_it_, false)) {
      CancelTimer();
      timer_ = setup_.loop.After(kRest_us, [this] {
        timer_.reset();
        setup_.sink.Request(msg::SessionKind::kRequestResume);
      });
    }
    const bool over = event.kind == msg::SessionKind::kConfirmed ||
                      event.kind == msg::SessionKind::kAbandoned ||
                      event.kind == msg::SessionKind::kIdle;
    if (!over || !std::exchange(in_session_, false)) return;
    const bool gave_up = std::exchange(gave_up_, false);
    if (event.kind == msg::SessionKind::kAbandoned && !gave_up) {
      spdlog::warn("simulated user: no task: {}", event.text);
    }
    user_.ForgetSession();
    if (++sessions_ >= config_.sessions) return setup_.sink.Finish();
    setup_.sink.Request(msg::SessionKind::kRequestStart);
  }

  void ShowNotice(const std::string& text) override { spdlog::info("simulated user: {}", text); }
  void ShowScene(const msg::Scene& scene) override { user_.SeeScene(scene); }

  std::string State() const override {
    return "simulated: " + std::to_string(sessions_) + " of " + std::to_string(config_.sessions) +
           " sessions";
  }

 private:
  /// A press is one-hot; a decoder of vectors is never quite sure.
  std::vector<double> Likelihoods(size_t option, size_t n) const {
    if (config_.interface.kind != msg::InterfaceKind::kVector) return OneHot(option, n);
    std::vector<double> likelihoods(n, (1 - kVectorSure) / static_cast<double>(n - 1));
    likelihoods[option] = kVectorSure;
    return likelihoods;
  }

  void Think(Utime delay_us) {
    CancelTimer();
    timer_ = setup_.loop.After(delay_us, [this] {
      timer_.reset();
      Respond();
    });
  }

  void CancelTimer() {
    if (timer_) setup_.loop.Cancel(*std::exchange(timer_, std::nullopt));
  }

  void Respond() {
    if (!query_) return;
    in_session_ = true;
    if (!LookAtTruth()) return;
    if (std::bernoulli_distribution(config_.stop)(stops_)) {
      stopped_it_ = true;
      return setup_.sink.Request(msg::SessionKind::kRequestStop);
    }
    const Response response = user_.Respond(*query_);
    if (const auto* choice = std::get_if<Choose>(&response)) {
      setup_.sink.Answer(query_->id, Likelihoods(choice->option, query_->options.size()));
    } else if (std::holds_alternative<RefuseAll>(response)) {
      setup_.sink.Request(msg::SessionKind::kRequestNoneOfThese);
    } else if (const auto* give_up = std::get_if<GiveUp>(&response)) {
      GiveUpSession(give_up->reason);
    } else {
      LookAgain("no scene with a table was seen");
    }
  }

  /// The truth may be written while we start: it is read when the first question needs it.
  bool LookAtTruth() {
    if (config_.truth_file.empty() || truth_read_) return true;
    auto truth = ReadSceneTruth(config_.truth_file);
    if (!truth) {
      LookAgain(truth.error().message);
      return false;
    }
    truth_read_ = true;
    user_.SetTruth(*std::move(truth));
    return true;
  }

  void LookAgain(const std::string& missing) {
    if (++looks_ > kMaxLooks) return GiveUpSession(missing);
    Think(kLookAgain_us);
  }

  void GiveUpSession(const std::string& reason) {
    spdlog::error("simulated user: wants {} {}: {}; the session is cancelled", config_.user.action,
                  config_.user.category, reason);
    gave_up_ = true;
    setup_.sink.Request(msg::SessionKind::kRequestCancel);
  }

  const SimulatedConfig config_;
  const FrontEndSetup setup_;
  SimulatedUser user_;
  std::mt19937_64 stops_;
  bool stopped_it_ = false;  // by this user: nobody else's stop is taken back
  bool truth_read_ = false;
  std::optional<msg::Query> query_;
  std::optional<RunLoop::TimerId> timer_;
  int looks_ = 0;
  bool in_session_ = false;
  bool gave_up_ = false;  // of this session
  int sessions_ = 0;
};

class SimulatedFactory final : public FrontEndFactory {
 public:
  std::string name() const override { return "simulated"; }
  std::string summary() const override { return "a user who wants --want and answers by itself"; }

  void AddOptions(CLI::App& app) override {
    auto* group = app.add_option_group("simulated", "Options of the simulated front end");
    group->add_option("--want", want_, "What it wants, e.g. Open:Carton (the nearest carton)")
        ->type_name("ACTION:CATEGORY");
    group
        ->add_option("--truth", config_.truth_file,
                     "What stands where, as beckon-capture --truth writes it")
        ->type_name("FILE");
    group->add_option("--sessions", config_.sessions, "Conversations before it leaves")
        ->check(CLI::Range(1, 1'000'000));
    group->add_option("--flip", config_.user.flip, "Chance that an answer comes out wrong")
        ->check(Within(0.0, 1.0));
    group->add_option("--seed", config_.user.seed, "Of those chances");
    static const std::map<std::string, msg::InterfaceKind> kinds = {
        {"yesno", msg::InterfaceKind::kYesNo},
        {"choice", msg::InterfaceKind::kChoice},
        {"scan", msg::InterfaceKind::kScan},
        {"vector", msg::InterfaceKind::kVector}};
    SimulatedInterface& interface = config_.interface;
    group->add_option("--announce", interface.kind, "How it says that it is asked")
        ->transform(CLI::CheckedTransformer(kinds).description("yesno|choice|scan|vector"));
    group->add_option("--max-options", interface.max_options, "Options that it takes at once")
        ->check(CLI::Range(2, 64))
        ->capture_default_str();
    group->add_option("--seconds-per-question", interface.seconds_per_question, "As it announces")
        ->check(Within(0.001, 3600.0))
        ->capture_default_str();
    group->add_option("--seconds-per-option", interface.seconds_per_option, "As it announces")
        ->check(Within(0.0, 3600.0))
        ->capture_default_str();
    group
        ->add_option("--stop", config_.stop,
                     "Chance that it stops everything instead of answering, and goes on after 1 s")
        ->check(Within(0.0, 1.0));
    group->add_option("--think", config_.think_s, "Seconds before each answer")
        ->check(Within(0.0, 3600.0));
  }

  Result<std::unique_ptr<FrontEnd>> Create(const FrontEndSetup& setup) override {
    const size_t colon = want_.find(':');
    if (colon == std::string::npos || colon == 0 || colon + 1 == want_.size()) {
      return Error{"--want '" + want_ + "': expected ACTION:CATEGORY, e.g. --want Open:Carton"};
    }
    SimulatedConfig config = config_;
    config.user.action = want_.substr(0, colon);
    config.user.category = want_.substr(colon + 1);
    if (setup.exit_after_sessions > 0) config.sessions = setup.exit_after_sessions;
    return std::unique_ptr<FrontEnd>(std::make_unique<SimulatedFrontEnd>(std::move(config), setup));
  }

 private:
  std::string want_;
  SimulatedConfig config_;
};

const FrontEndRegistration kRegistration([]() -> std::unique_ptr<FrontEndFactory> {
  return std::make_unique<SimulatedFactory>();
});

}  // namespace
}  // namespace beckon::ui_bridge
