// A Lab Streaming Layer stream of class probabilities, read by a thread of its own.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "services/base/run_loop.h"
#include "services/ui_bridge/bci/lsl_library.h"

namespace beckon::ui_bridge::bci {

struct LslSample {
  std::vector<double> channels;
  double age_s = 0;  // since it was recorded, >= 0
};

class LslSource {
 public:
  struct Handlers {  // called in the loop's thread
    std::function<void(const LslSample&)> sample;
    std::function<void(bool found)> stream;  // it is there now, or no longer
  };

  /// Looks for the stream of that name until it is there, and again when it is lost. `loop` must
  /// outlive it.
  LslSource(const LslLibrary& library, const std::string& name, RunLoop& loop, Handlers handlers);
  /// Waits for the thread: half a second at most.
  ~LslSource();
  LslSource(const LslSource&) = delete;
  LslSource& operator=(const LslSource&) = delete;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;  // what was posted to the loop may outlive this
};

}  // namespace beckon::ui_bridge::bci
