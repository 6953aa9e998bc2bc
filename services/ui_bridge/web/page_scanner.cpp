#include "services/ui_bridge/web/page_scanner.h"

#include <algorithm>
#include <utility>

namespace beckon::ui_bridge::web {
namespace {

constexpr int64_t kIdlePage = -1;
constexpr int64_t kWaitingPage = -2;
constexpr int64_t kTrialPage = -3;
/// Between two questions nothing is lit; if the next does not come, stopping has to be possible.
constexpr Utime kPatience_us = 700'000;
constexpr int kKeep = 0;  // of the trial's two options

bool SaysNone(const msg::Option& option) {
  return option.category == msg::kUnknownCategory ||
         (option.category.empty() && option.actions.empty() && option.objects.empty());
}

scan::Page QuestionPage(const msg::Query& query) {
  const bool proposition =
      query.kind != msg::QueryKind::kChoice && query.kind != msg::QueryKind::kWhatIsIt;
  scan::Page page{.id = query.id, .n_options = static_cast<int>(query.options.size())};
  for (const auto& prospect : query.prospects) page.probabilities.push_back(prospect.probability);
  page.none_last = !proposition && SaysNone(query.options.back());
  if (query.questions_asked > 0) page.controls.push_back(scan::Control::kUndo);
  if (proposition) page.controls.push_back(scan::Control::kNone);
  page.controls.push_back(scan::Control::kPause);
  page.controls.push_back(scan::Control::kStop);
  return page;
}

}  // namespace

PageScanner::Offer PageScanner::Offered(Utime now, const PageState& state, bool trial) {
  const bool waiting = state.phase == Phase::kRunning && (!state.query || state.answered);
  if (!waiting) waiting_since_.reset();
  wait_over_.reset();
  if (trial) return Offer::kTrial;
  if (state.phase != Phase::kRunning) return Offer::kIdle;
  if (!waiting) return Offer::kQuestion;
  if (!waiting_since_) waiting_since_ = now;
  if (now >= *waiting_since_ + kPatience_us) return Offer::kWaiting;
  wait_over_ = *waiting_since_ + kPatience_us;
  return Offer::kNothing;
}

void PageScanner::Update(Utime now, const PageState& state, bool trial) {
  scanner_.SetStopped(now, state.phase == Phase::kStopped || state.stopping);
  const Offer offer = Offered(now, state, trial);
  const int64_t query_id = offer == Offer::kQuestion ? state.query->id : 0;
  if (offer == offer_ && query_id == query_id_) return;
  offer_ = offer;
  query_id_ = query_id;
  switch (offer) {
    case Offer::kNothing:
      page_ = {};
      break;
    case Offer::kIdle:
      page_ = {.id = kIdlePage, .controls = {scan::Control::kStart, scan::Control::kStop}};
      break;
    case Offer::kWaiting:
      page_ = {.id = kWaitingPage, .controls = {scan::Control::kUndo, scan::Control::kStop}};
      break;
    case Offer::kQuestion:
      page_ = QuestionPage(*state.query);
      break;
    case Offer::kTrial:
      page_ = {.id = kTrialPage, .n_options = 2};
      break;
  }
  scanner_.Show(now, page_);
}

std::vector<Scanned> PageScanner::OnSwitch(Utime now, scan::Switch which, bool down) {
  return Meaning(scanner_.OnSwitch(now, which, down));
}

std::vector<Scanned> PageScanner::Tick(Utime now) { return Meaning(scanner_.Tick(now)); }

std::optional<Utime> PageScanner::NextDeadline() const {
  const auto scanner = scanner_.NextDeadline();
  if (!scanner || !wait_over_) return scanner ? scanner : wait_over_;
  return std::min(*scanner, *wait_over_);
}

std::vector<Scanned> PageScanner::Meaning(const std::vector<scan::Action>& actions) const {
  using Kind = scan::Action::Kind;
  std::vector<Scanned> meaning;
  const auto request = [&](msg::SessionKind kind) { meaning.push_back(ScannedRequest{kind}); };
  for (const scan::Action& action : actions) {
    switch (action.kind) {
      case Kind::kChoose:
        if (action.page == kTrialPage) {
          meaning.push_back(ScannedTrial{action.option == kKeep});
        } else {
          meaning.push_back(ScannedAnswer{action.page, action.option});
        }
        break;
      case Kind::kControl:
        if (action.control == scan::Control::kUndo) request(msg::SessionKind::kRequestUndo);
        if (action.control == scan::Control::kNone) request(msg::SessionKind::kRequestNoneOfThese);
        if (action.control == scan::Control::kStart) request(msg::SessionKind::kRequestStart);
        break;
      case Kind::kStop:
        request(msg::SessionKind::kRequestStop);
        break;
      case Kind::kResume:
        request(msg::SessionKind::kRequestResume);
        break;
      default:
        break;
    }
  }
  return meaning;
}

msg::Highlight PageScanner::highlight() const {
  const scan::View view = scanner_.view();
  msg::Highlight highlight;
  highlight.query_id = std::max<int64_t>(view.page, 0);
  if (view.page == kTrialPage) {
    for (const int option : view.options)
      highlight.controls.push_back(option == kKeep ? "keep" : "revert");
  } else {
    highlight.options = view.options;
  }
  for (const scan::Control control : view.controls)
    highlight.controls.emplace_back(scan::Name(control));
  if (view.back) highlight.controls.emplace_back("back");
  highlight.pressed = view.pressed;
  highlight.paused = view.paused;
  highlight.dwell_ms = static_cast<int>(view.dwell_us / 1000);
  return highlight;
}

std::vector<std::string> PageScanner::controls() const {
  if (scanner_.stopped())
    return {scan::Name(scan::Control::kResume), scan::Name(scan::Control::kStay)};
  std::vector<std::string> names;
  if (offer_ == Offer::kTrial) names = {"keep", "revert"};
  for (const scan::Control control : page_.controls) names.emplace_back(scan::Name(control));
  return names;
}

ScanSeconds ExpectedScanSeconds(const scan::Config& config, int n) {
  scan::Page page{.id = 1, .n_options = n};
  page.controls = {scan::Control::kUndo, scan::Control::kPause, scan::Control::kStop};
  const scan::Plan plan = scan::MakePlan(config, page);
  double mean_x = (n + 1) / 2.0, mean_y = 0, xx = 0, xy = 0;
  const auto seconds = [&](int option) {
    return static_cast<double>(scan::TimeToOption(plan, config, option).value_or(0)) / kSecond;
  };
  for (int i = 0; i < n; ++i) mean_y += seconds(i) / n;
  for (int i = 0; i < n; ++i) {
    xx += (i + 1 - mean_x) * (i + 1 - mean_x);
    xy += (i + 1 - mean_x) * (seconds(i) - mean_y);
  }
  constexpr double kLeast_s = 0.001;  // that may be announced
  double slope = std::max(0.0, xx > 0 ? xy / xx : 0);
  if (mean_y - slope * mean_x < kLeast_s) slope = std::max(0.0, (mean_y - kLeast_s) / mean_x);
  return {std::max(kLeast_s, mean_y - slope * mean_x), slope};
}

}  // namespace beckon::ui_bridge::web
