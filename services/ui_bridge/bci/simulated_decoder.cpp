#include "services/ui_bridge/bci/simulated_decoder.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <variant>

#include "services/base/scene_truth.h"

namespace beckon::ui_bridge::bci {
namespace {

constexpr size_t kMostQueries = 16;
/// Labels that the user attends to where no question of intention stands.
constexpr std::array<const char*, 3> kOnwards = {"Go on", "Yes, go on", "Another task"};
constexpr char kStopLabel[] = "STOP";

std::optional<size_t> ClassCalled(const msg::Stimulus& stimulus, const std::string& label) {
  const auto found = std::find(stimulus.labels.begin(), stimulus.labels.end(), label);
  if (found == stimulus.labels.end()) return std::nullopt;
  return static_cast<size_t>(found - stimulus.labels.begin());
}

}  // namespace

SimulatedDecoder::SimulatedDecoder(const SimulatedDecoderConfig& config, Bus& bus, RunLoop& loop,
                                   const Clock& clock)
    : config_(config),
      bus_(bus),
      loop_(loop),
      clock_(clock),
      user_(config.user),
      random_(config.seed) {}

void SimulatedDecoder::Begin() {
  bus_.Subscribe<msg::Query>([this](const msg::Query& query) {
    queries_[query.id] = query;
    while (queries_.size() > kMostQueries) queries_.erase(queries_.begin());
  });
  bus_.Subscribe<msg::Scene>([this](const msg::Scene& scene) { user_.SeeScene(scene); }, 1);
  bus_.Subscribe<msg::Session>([this](const msg::Session& event) {
    using Kind = msg::SessionKind;
    if (event.kind == Kind::kStopped) stopping_ = false;
    if (event.kind == Kind::kConfirmed || event.kind == Kind::kAbandoned ||
        event.kind == Kind::kIdle || event.kind == Kind::kStopped)
      user_.ForgetSession();
  });
  bus_.Subscribe<msg::Stimulus>([this](const msg::Stimulus& stimulus) { Hear(stimulus); });
}

void SimulatedDecoder::Hear(const msg::Stimulus& stimulus) {
  if (!config_.device.empty() && stimulus.device != config_.device) return;
  int64_t& latest = heard_[stimulus.device];
  if (stimulus.trial <= latest) return;  // repeated
  latest = stimulus.trial;
  if (Uniform(random_) < config_.dropout) return;
  const auto delay_us = std::max<Utime>(1, static_cast<Utime>(1e6 / config_.rate));
  loop_.After(delay_us, [this, stimulus] { Decode(stimulus); });
}

void SimulatedDecoder::Decode(const msg::Stimulus& stimulus) {
  const size_t classes = stimulus.labels.size();
  if (!decodings_.contains(classes)) {
    const double accuracy = std::max(config_.accuracy, 1.02 / static_cast<double>(classes));
    decodings_.emplace(classes, SimulatedDecoding(classes, accuracy, config_.sharpness));
  }
  if (++decoded_ == config_.stop_after) stopping_ = true;
  msg::Decoding decoding;
  decoding.utime = clock_.Now();
  decoding.decoder = config_.name;
  decoding.device = stimulus.device;
  decoding.trial = stimulus.trial;
  decoding.probabilities = decodings_.at(classes).Draw(Attended(stimulus), random_);
  decoding.seal.sender = config_.name;
  const int copies = Uniform(random_) < config_.duplicate ? 2 : 1;
  for (int i = 0; i < copies; ++i) {
    if (auto sent = bus_.Publish(decoding); !sent) spdlog::error("{}", sent.error().message);
  }
}

std::optional<size_t> SimulatedDecoder::Attended(const msg::Stimulus& stimulus) {
  if (const auto stop = ClassCalled(stimulus, kStopLabel); stop && stopping_) return stop;
  if (stimulus.query_id == 0) {
    for (const char* label : kOnwards)
      if (const auto onwards = ClassCalled(stimulus, label)) return onwards;
    return std::nullopt;
  }
  const auto query = queries_.find(stimulus.query_id);
  if (query == queries_.end()) return std::nullopt;
  const auto wanted = Wanted(query->second);
  // Options are the first classes, in their order.
  if (!wanted || *wanted >= stimulus.labels.size()) return std::nullopt;
  return wanted;
}

std::optional<size_t> SimulatedDecoder::Wanted(const msg::Query& query) {
  if (!LookAtTruth()) return std::nullopt;
  const Response response = user_.Respond(query);
  if (const auto* choice = std::get_if<Choose>(&response)) return choice->option;
  if (const auto* give_up = std::get_if<GiveUp>(&response))
    spdlog::warn("simulated decoder: {}; it attends to nothing", give_up->reason);
  return std::nullopt;
}

bool SimulatedDecoder::LookAtTruth() {
  if (config_.truth_file.empty() || truth_read_) return true;
  auto truth = ReadSceneTruth(config_.truth_file);
  if (!truth) {
    spdlog::warn("simulated decoder: {}", truth.error().message);
    return false;
  }
  truth_read_ = true;
  user_.SetTruth(*std::move(truth));
  return true;
}

}  // namespace beckon::ui_bridge::bci
