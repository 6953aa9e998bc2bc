// The page's own scanner: what of the conversation can be chosen with a switch, and what a choice
// means for it. Drives scan::Scanner; time is passed in.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "lcmtypes/messages.h"
#include "services/ui_bridge/scan/scanner.h"
#include "services/ui_bridge/web/page_state.h"

namespace beckon::ui_bridge::web {

/// What the user chose.
struct ScannedAnswer {
  int64_t query_id;
  int option;
};
struct ScannedRequest {
  msg::SessionKind request;
};
/// Of settings on trial.
struct ScannedTrial {
  bool keep;
};
using Scanned = std::variant<ScannedAnswer, ScannedRequest, ScannedTrial>;

class PageScanner {
 public:
  explicit PageScanner(const scan::Config& config) : scanner_(config) {}

  void SetConfig(Utime now, const scan::Config& config) { scanner_.SetConfig(now, config); }
  /// Takes up what is to be chosen now: keeping settings that are on trial, a question's options
  /// with undo, none of these, pause and stop, or a new conversation. A question stays as it is
  /// while it stands.
  void Update(Utime now, const PageState& state, bool trial);

  std::vector<Scanned> OnSwitch(Utime now, scan::Switch which, bool down);
  std::vector<Scanned> Tick(Utime now);
  void ReleaseAll(Utime now) { scanner_.ReleaseAll(now); }
  std::optional<Utime> NextDeadline() const;

  /// What is lit; `utime`, `device` and `user` are the caller's.
  msg::Highlight highlight() const;
  /// What can be chosen besides options.
  std::vector<std::string> controls() const;

 private:
  enum class Offer { kNothing, kIdle, kWaiting, kQuestion, kTrial };

  Offer Offered(Utime now, const PageState& state, bool trial);
  std::vector<Scanned> Meaning(const std::vector<scan::Action>& actions) const;

  scan::Scanner scanner_;
  Offer offer_ = Offer::kNothing;
  int64_t query_id_ = 0;
  scan::Page page_;
  std::optional<Utime> waiting_since_;
  std::optional<Utime> wait_over_;
};

/// The line through the times after which each of `n` equally likely options is chosen: what the
/// interface announces. Right on average; for each option where grouping is linear and the first
/// item is not lit longer.
struct ScanSeconds {
  double per_question;  // s, > 0
  double per_option;    // s, >= 0, for each option up to the one that is chosen
};
ScanSeconds ExpectedScanSeconds(const scan::Config& config, int n);

}  // namespace beckon::ui_bridge::web
