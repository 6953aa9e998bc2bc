// Front end "console": questions as text, answers as typed lines, on a terminal or through pipes.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <deque>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "services/base/run_loop.h"
#include "services/ui_bridge/console_text.h"
#include "services/ui_bridge/front_end.h"

namespace beckon::ui_bridge {
namespace {

constexpr size_t kMaxLine = 4096;
constexpr Utime kFilePoll_us = 20'000;
constexpr Utime kRobotsWord_us = 1'500'000;
constexpr double kSamePlace_m = 0.03;

struct ConsoleConfig {
  double seconds_per_question = 4;  // s, to read, decide and type
  double seconds_per_option = 0.7;  // s, more for each option
  double false_yes = 0;             // 0..0.5, chance of "yes" typed where "no" is meant
  double false_no = 0;              // 0..0.5
  std::string kind = "choice";      // or "yesno": no choices among tasks
  int max_options = 12;             // shown at once
};

class ConsoleFrontEnd final : public FrontEnd {
 public:
  ConsoleFrontEnd(const ConsoleConfig& config, const FrontEndSetup& setup)
      : config_(config),
        setup_(setup),
        terminal_in_(isatty(STDIN_FILENO) == 1),
        terminal_out_(isatty(STDOUT_FILENO) == 1) {}
  ~ConsoleFrontEnd() override {
    StopReading();
    if (offer_) setup_.loop.Cancel(*offer_);
  }

  msg::Interface Announce() const override {
    msg::Interface interface;
    interface.kind =
        config_.kind == "yesno" ? msg::InterfaceKind::kYesNo : msg::InterfaceKind::kChoice;
    interface.max_options = config_.max_options;
    interface.seconds_per_question = static_cast<float>(config_.seconds_per_question);
    interface.seconds_per_option = static_cast<float>(config_.seconds_per_option);
    interface.false_yes = static_cast<float>(config_.false_yes);
    interface.false_no = static_cast<float>(config_.false_no);
    return interface;
  }

  void Begin() override {
    if (terminal_in_) Print(RenderWelcome());
    try {
      setup_.loop.AddFd(STDIN_FILENO, [this] { Read(); });
      watching_ = true;
    } catch (const std::system_error&) {  // a plain file cannot be waited for, but always be read
      poll_ = setup_.loop.Every(kFilePoll_us, [this] { Read(); });
    }
    setup_.sink.Request(msg::SessionKind::kRequestStart);
  }

  void Present(const msg::Query& query) override {
    query_ = query;
    answered_ = false;
    between_ = false;
    if (scene_ && std::exchange(describe_, false)) Print(RenderScene(*scene_, Told()));
    const QuestionStyle style{.terminal = terminal_out_, .brief = knows_commands_};
    Print(RenderQuestion(query, scene_ ? &*scene_ : nullptr, style));
    knows_commands_ = true;
    UseLines();
  }

  void Withdraw() override { query_.reset(); }

  void ShowSession(const msg::Session& event) override {
    if (const std::string text = RenderSession(event); !text.empty()) Print(text + "\n");
    stopped_ = event.kind == msg::SessionKind::kStopped;
    if (stopped_) lines_.clear();
    if (event.kind == msg::SessionKind::kBegun) in_session_ = describe_ = true;
    if (event.kind == msg::SessionKind::kConfirmed) robot_at_work_ = true;
    if (event.kind == msg::SessionKind::kBegun) robot_at_work_ = false;
    const bool over = event.kind == msg::SessionKind::kConfirmed ||
                      event.kind == msg::SessionKind::kAbandoned ||
                      event.kind == msg::SessionKind::kIdle;
    if (over && std::exchange(in_session_, false)) AfterSession();
  }

  void ShowScene(const msg::Scene& scene) override { scene_ = scene; }

  void ShowNotice(const std::string& text) override { Print(text + "\n"); }

  void ShowTaskStatus(const msg::TaskStatus& status) override {
    Print(RenderTaskStatus(status) + "\n");
    const bool at_work =
        status.state == msg::TaskState::kAccepted || status.state == msg::TaskState::kRunning;
    if (std::exchange(robot_at_work_, at_work) && !at_work && offer_) Offer();
  }

  std::string State() const override {
    if (query_) return answered_ ? "answered question " + Number() : "asks question " + Number();
    return in_session_ ? "waits for a question" : "waits for a conversation";
  }

 private:
  std::string Number() const { return std::to_string(query_->questions_asked + 1); }

  void AfterSession() {
    if (++sessions_ == setup_.exit_after_sessions) return End();
    between_ = true;
    if (terminal_in_) return OfferSoon();
    UseLines();
    // A pipe has nobody to press Enter: whatever comes next belongs to the next conversation.
    if (!ended_ && between_) NewSession();
  }

  /// After what the robot says of its task, which comes at once or not for long.
  void OfferSoon() {
    offer_ = setup_.loop.After(robot_at_work_ ? kRobotsWord_us : 0, [this] { Offer(); });
  }

  void Offer() {
    setup_.loop.Cancel(*std::exchange(offer_, std::nullopt));
    const int n = setup_.exit_after_sessions;
    const std::string which =
        n > 0 ? " (" + std::to_string(sessions_ + 1) + " of " + std::to_string(n) + ")" : "";
    Print("\nEnter = another task" + which + ", q = quit\n> ");
  }

  void NewSession() {
    between_ = false;
    if (offer_) setup_.loop.Cancel(*std::exchange(offer_, std::nullopt));
    setup_.sink.Request(msg::SessionKind::kRequestStart);
  }

  void Read() {
    char bytes[1024];
    const ssize_t n = read(STDIN_FILENO, bytes, sizeof bytes);
    if (n < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (n <= 0) {
      eof_ = true;
      StopReading();
      if (!buffer_.empty()) TakeLine(std::exchange(buffer_, {}));
      UseLines();
      return;
    }
    for (ssize_t i = 0; i < n && !ended_; ++i) {
      if (bytes[i] == '\n') {
        TakeLine(std::exchange(buffer_, {}));
      } else if (buffer_.size() < kMaxLine) {
        buffer_ += bytes[i];
      }
    }
    UseLines();
  }

  /// Stop never waits behind other lines.
  void TakeLine(std::string line) {
    if (ParseLine(line, nullptr).kind == ConsoleInput::Kind::kStop) {
      lines_.clear();
      setup_.sink.Request(msg::SessionKind::kRequestStop);
      return;
    }
    lines_.push_back(std::move(line));
  }

  /// From a terminal a line means the question in view. From a pipe lines are answers to the
  /// questions as they come.
  void UseLines() {
    while (!ended_ && !lines_.empty() &&
           (terminal_in_ || stopped_ || between_ || (query_ && !answered_))) {
      const std::string line = std::move(lines_.front());
      lines_.pop_front();
      Use(ParseLine(line, query_ ? &*query_ : nullptr));
    }
    if (!eof_ || ended_ || !lines_.empty()) return;
    // End of input: what was answered may still be confirmed; a question that nobody will answer
    // ends it.
    if (terminal_in_ || (query_ && !answered_) || between_ || !in_session_) Quit();
  }

  void Use(const ConsoleInput& input) {
    using Kind = ConsoleInput::Kind;
    using Request = msg::SessionKind;
    switch (input.kind) {
      case Kind::kOption:
        if (answered_) return Print("That is answered already; u takes it back.\n> ");
        answered_ = true;
        Remember(*query_, input.option);
        return setup_.sink.Answer(query_->id, OneHot(input.option, query_->options.size()));
      case Kind::kUndo:
        return setup_.sink.Request(Request::kRequestUndo);
      case Kind::kNoneOfThese:
        answered_ = query_.has_value();
        return setup_.sink.Request(Request::kRequestNoneOfThese);
      case Kind::kStop:
        return setup_.sink.Request(Request::kRequestStop);
      case Kind::kResume:
        return setup_.sink.Request(Request::kRequestResume);
      case Kind::kQuit:
        return Quit();
      case Kind::kNew:
      case Kind::kNothing:
        if (between_) NewSession();
        return;
      case Kind::kHelp:
        return Print(RenderHelp(query_ ? &*query_ : nullptr) + "> ");
      case Kind::kUnknown:
        return Print(input.complaint + "\n> ");
    }
  }

  /// What the user said an object is goes for that object where it stands, not for its number.
  void Remember(const msg::Query& query, size_t option) {
    if (query.kind != msg::QueryKind::kWhatIsIt || query.objects.empty() || !scene_) return;
    const int id = query.objects.front().object_id;
    const auto object = std::ranges::find(scene_->objects, id, &msg::SceneObject::id);
    const std::string& category = query.options[option].category;
    if (object != scene_->objects.end() && !category.empty())
      said_.push_back({object->centroid_W, category});
  }

  ToldCategories Told() const {
    ToldCategories told;
    for (const auto& [centroid_W, category] : said_) {
      for (const auto& object : scene_->objects) {
        if ((object.centroid_W - centroid_W).norm() < kSamePlace_m) told[object.id] = category;
      }
    }
    return told;
  }

  void Quit() {
    setup_.sink.Request(msg::SessionKind::kRequestCancel);
    End();
  }

  void End() {
    if (std::exchange(ended_, true)) return;
    setup_.sink.Finish();
  }

  void StopReading() {
    if (std::exchange(watching_, false)) setup_.loop.RemoveFd(STDIN_FILENO);
    if (poll_) setup_.loop.Cancel(*std::exchange(poll_, std::nullopt));
  }

  static void Print(const std::string& text) {
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
  }

  const ConsoleConfig config_;
  const FrontEndSetup setup_;
  const bool terminal_in_;
  const bool terminal_out_;
  bool watching_ = false;
  std::optional<RunLoop::TimerId> poll_;
  std::string buffer_;             // of the line that is being typed
  std::deque<std::string> lines_;  // not used yet
  std::optional<msg::Scene> scene_;
  bool describe_ = false;                                      // the table, with the next question
  bool knows_commands_ = false;                                // they were shown once
  std::vector<std::pair<Eigen::Vector3d, std::string>> said_;  // what the user said stands where
  bool robot_at_work_ = false;
  std::optional<RunLoop::TimerId> offer_;  // of another session
  std::optional<msg::Query> query_;
  bool answered_ = false;
  bool in_session_ = false;
  bool stopped_ = false;
  bool between_ = false;  // a session is over and the next was not asked for
  bool eof_ = false;
  bool ended_ = false;
  int sessions_ = 0;
};

class ConsoleFactory final : public FrontEndFactory {
 public:
  std::string name() const override { return "console"; }
  std::string summary() const override {
    return "text and typed lines, on a terminal or through pipes";
  }

  void Configure(ConfigTable table) override {
    table.Get("seconds_per_question", config_.seconds_per_question, 0.001, 3600);
    table.Get("seconds_per_option", config_.seconds_per_option, 0, 3600);
    table.Get("false_yes", config_.false_yes, 0, 0.5);
    table.Get("false_no", config_.false_no, 0, 0.5);
    table.Get("kind", config_.kind, {"choice", "yesno"});
    table.Get("max_options", config_.max_options, 2, 64);
  }

  Result<std::unique_ptr<FrontEnd>> Create(const FrontEndSetup& setup) override {
    return std::unique_ptr<FrontEnd>(std::make_unique<ConsoleFrontEnd>(config_, setup));
  }

 private:
  ConsoleConfig config_;
};

const FrontEndRegistration kRegistration([]() -> std::unique_ptr<FrontEndFactory> {
  return std::make_unique<ConsoleFactory>();
});

}  // namespace
}  // namespace beckon::ui_bridge
