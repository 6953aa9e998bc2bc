// Speaks by a program (espeak-ng): one sentence at a time, cut off by the next.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "services/base/run_loop.h"
#include "services/ui_bridge/child.h"

namespace beckon::ui_bridge {

/// Runs `command` with "--" and the sentence after it; no shell is involved. In the loop's
/// thread; speaking itself is the child's.
class Speaker {
 public:
  /// `command` is a program and its arguments. `tell` hears once where it does not work; where it
  /// cannot even be started, Say does nothing from then on.
  Speaker(std::vector<std::string> command, RunLoop& loop,
          std::function<void(const std::string&)> tell);
  ~Speaker();
  Speaker(const Speaker&) = delete;
  Speaker& operator=(const Speaker&) = delete;

  /// Cuts off what is spoken.
  void Say(const std::string& text);
  void CutOff();
  bool speaking() const { return child_.has_value(); }

 private:
  void Look();
  void Tell(const std::string& why);

  const std::vector<std::string> command_;
  RunLoop& loop_;
  const std::function<void(const std::string&)> tell_;
  std::optional<Child> child_;
  std::optional<RunLoop::TimerId> timer_;  // while it speaks
  bool missing_ = false;
  bool told_ = false;
};

}  // namespace beckon::ui_bridge
