#include "services/ui_bridge/service.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <deque>
#include <optional>
#include <utility>

#include "services/ui_bridge/uuid.h"

namespace beckon::ui_bridge {
namespace {

constexpr Utime kTick_us = 50'000;
constexpr Utime kProfileRepeat_us = 500'000;
constexpr size_t kShownTasksKept = 32;
constexpr Utime kFarewell_us = kSecond;  // for a last cancel to be heard

bool IsNameCharacter(char c) {
  const auto u = static_cast<unsigned char>(c);
  return u < 0x80 && (std::isalnum(u) != 0 || c == '_' || c == '.' || c == '-');
}

}  // namespace

std::string DefaultUser() {
  const char* user = std::getenv("USER");
  std::string name = user != nullptr && *user != '\0' ? user : "user";
  std::ranges::replace_if(
      name, [](char c) { return !IsNameCharacter(c); }, '_');
  return name.substr(0, 64);
}

std::string DefaultDevice(const std::string& front_end) {
  std::array<char, 64> host{};
  gethostname(host.data(), host.size() - 1);
  return front_end + "@" + host.data();
}

Status ValidateUser(const std::string& user) {
  if (!user.empty() && user.size() <= 64 && std::ranges::all_of(user, IsNameCharacter)) return {};
  return Error{"user '" + user + "': expected 1 to 64 letters, digits, '_', '.' or '-'"};
}

class Service::Line final : public DialogueOutput, public FrontEndSink {
 public:
  Line(Service& service, std::string device)
      : service_(service),
        device_(std::move(device)),
        dialogue_({.user = service.config_.user,
                   .device = device_,
                   .listen_us = service.config_.listen_us},
                  service.clock_, service.steady_, NewUuid, *this) {}

  Status Create(FrontEndFactory& factory) {
    auto made = factory.Create({.device = device_,
                                .user = service_.config_.user,
                                .exit_after_sessions = service_.config_.exit_after_sessions,
                                .loop = service_.loop_,
                                .sink = *this,
                                .bus = service_.bus_});
    if (!made) return Error{"--front-end " + factory.name() + ": " + made.error().message};
    front_end_ = *std::move(made);
    return {};
  }

  FrontEnd& front_end() { return *front_end_; }
  Dialogue& dialogue() { return dialogue_; }
  const std::string& device() const { return device_; }

  void Announce() {
    msg::Interface interface = front_end_->Announce();
    interface.utime = service_.clock_.Now();
    interface.device = device_;
    Publish(interface);
  }

  /// Repeats what has no answer yet.
  void Tick() {
    dialogue_.Tick();
    const Utime now = service_.steady_.Now();
    if (profile_due_ && now >= *profile_due_) {
      profile_due_ = now + kProfileRepeat_us;
      msg::Session request;
      request.utime = service_.clock_.Now();
      request.user = dialogue_.user();
      request.device = device_;
      request.kind = msg::SessionKind::kRequestProfile;
      PublishSealed(request);
    }
  }

  void OnTask(const msg::Task& task) {
    if (task.user != dialogue_.user() || std::ranges::count(shown_tasks_, task.task_id) > 0) return;
    shown_tasks_.push_back(task.task_id);
    if (shown_tasks_.size() > kShownTasksKept) shown_tasks_.pop_front();
    front_end_->ShowTask(task);
  }

  void OnProfile(const msg::Profile& profile) {
    if (profile.user != dialogue_.user()) return;
    profile_due_.reset();
    front_end_->ShowProfile(profile);
  }

  void OnTaskStatus(const msg::TaskStatus& status) {
    if (status.task_id != task_id_) {
      early_ = status;  // a robot may be faster than intention's word that it was told
      return;
    }
    if (status.state == task_state_) return;
    task_state_ = status.state;
    front_end_->ShowTaskStatus(status);
  }

  /// Through, and nothing left to be said.
  bool Done() {
    if (!finished_at_) return false;
    const auto phase = dialogue_.phase();
    return phase == Dialogue::Phase::kIdle || phase == Dialogue::Phase::kStopped ||
           service_.steady_.Now() - *finished_at_ > kFarewell_us;
  }

  // DialogueOutput
  void Send(const msg::Answer& answer) override { PublishSealed(answer); }
  void Send(const msg::Session& request) override { PublishSealed(request); }
  void Present(const msg::Query& query) override { front_end_->Present(query); }
  void Withdraw() override { front_end_->Withdraw(); }
  void ShowSession(const msg::Session& event) override {
    if (event.kind == msg::SessionKind::kConfirmed) {
      task_id_ = event.session_id;
      task_state_.reset();
    }
    front_end_->ShowSession(event);
    if (early_ && early_->task_id == task_id_) OnTaskStatus(*std::exchange(early_, std::nullopt));
  }
  void ShowNotice(const std::string& text) override { front_end_->ShowNotice(text); }
  void ShowUser(const std::string& user) override { front_end_->ShowUser(user); }

  // FrontEndSink
  void Answer(int64_t query_id, const std::vector<double>& likelihoods) override {
    dialogue_.Answer(query_id, likelihoods);
  }
  void Request(msg::SessionKind request) override {
    switch (request) {
      case msg::SessionKind::kRequestStart:
        return dialogue_.Start();
      case msg::SessionKind::kRequestCancel:
        return dialogue_.Cancel();
      case msg::SessionKind::kRequestUndo:
        return dialogue_.Undo();
      case msg::SessionKind::kRequestStop:
        return dialogue_.Stop();
      case msg::SessionKind::kRequestResume:
        return dialogue_.Resume();
      case msg::SessionKind::kRequestNoneOfThese:
        return dialogue_.NoneOfThese();
      case msg::SessionKind::kRequestProfile:
        profile_due_ = service_.steady_.Now();
        return Tick();
      default:
        spdlog::error("{}: a front end asked for what only intention may announce", device_);
    }
  }
  Status ChooseUser(const std::string& user) override { return service_.ChooseUser(user); }
  void Finish() override { finished_at_ = service_.steady_.Now(); }

 private:
  template <typename T>
  void PublishSealed(T message) {
    message.seal.sender = device_;
    Publish(message);
  }

  template <typename T>
  void Publish(const T& message) {
    if (auto sent = service_.bus_.Publish(message); !sent)
      spdlog::error("{}: {}", device_, sent.error().message);
  }

  Service& service_;
  const std::string device_;
  Dialogue dialogue_;
  std::unique_ptr<FrontEnd> front_end_;
  std::optional<Utime> finished_at_;
  std::optional<Utime> profile_due_;     // while one is asked for
  std::deque<std::string> shown_tasks_;  // several may be repeated, where no robot takes them
  std::string task_id_;
  std::optional<msg::TaskState> task_state_;
  std::optional<msg::TaskStatus> early_;
};

Service::Service(ServiceConfig config, Bus& bus, RunLoop& loop, const Clock& clock,
                 const Clock& steady)
    : config_(std::move(config)), bus_(bus), loop_(loop), clock_(clock), steady_(steady) {}

Service::~Service() = default;

Status Service::Add(FrontEndFactory& factory) {
  const std::string device =
      config_.device.empty() ? DefaultDevice(factory.name()) : config_.device;
  const bool taken =
      std::ranges::any_of(lines_, [&](const auto& line) { return line->device() == device; });
  lines_.push_back(std::make_unique<Line>(*this, taken ? device + "." + factory.name() : device));
  return lines_.back()->Create(factory);
}

void Service::Begin() {
  bus_.Subscribe<msg::Query>([this](const msg::Query& query) {
    for (auto& line : lines_) line->dialogue().OnQuery(query);
  });
  bus_.Subscribe<msg::Session>([this](const msg::Session& event) {
    for (auto& line : lines_) line->dialogue().OnSession(event);
  });
  bus_.Subscribe<msg::Scene>(
      [this](const msg::Scene& scene) {
        for (auto& line : lines_) line->front_end().ShowScene(scene);
      },
      1);
  bus_.Subscribe<msg::Task>([this](const msg::Task& task) {
    for (auto& line : lines_) line->OnTask(task);
  });
  bus_.Subscribe<msg::Profile>([this](const msg::Profile& profile) {
    for (auto& line : lines_) line->OnProfile(profile);
  });
  bus_.Subscribe<msg::TaskStatus>([this](const msg::TaskStatus& status) {
    for (auto& line : lines_) line->OnTaskStatus(status);
  });
  const auto announce = [this] {
    for (auto& line : lines_) line->Announce();
  };
  announce();
  loop_.Every(kSecond, announce);
  loop_.Every(kTick_us, [this] {
    for (auto& line : lines_) line->Tick();
    StopWhenAllFinished();
  });
  for (auto& line : lines_) line->front_end().Begin();
}

Status Service::ChooseUser(const std::string& user) {
  if (auto right = ValidateUser(user); !right) return right;
  for (auto& line : lines_) line->dialogue().ChangeUser(user);
  return {};
}

std::string Service::State() const {
  std::string state;
  for (const auto& line : lines_) state += (state.empty() ? "" : "; ") + line->front_end().State();
  return state;
}

void Service::StopWhenAllFinished() {
  const auto done = [](const auto& line) { return line->Done(); };
  const auto over = [&](const auto& line) { return done(line) || line->front_end().Endless(); };
  if (std::ranges::all_of(lines_, over) && std::ranges::any_of(lines_, done)) loop_.Stop();
}

}  // namespace beckon::ui_bridge
