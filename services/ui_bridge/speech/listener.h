// The recogniser in a thread of its own: segments go in, what was heard comes out in the loop's
// thread. Segments are judged in order, a pause within one only while nothing newer waits.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "services/base/run_loop.h"
#include "services/ui_bridge/speech/recogniser.h"

namespace beckon::ui_bridge::speech {

/// Something heard, with the grammar and the question for which it was judged.
struct Hearing {
  Heard heard;
  std::shared_ptr<const Grammar> grammar;
  int64_t tag = 0;  // of Listener::Expect
  bool ended = false;
  int64_t begin_frame = 0;
  int loud_frames = 0;
};

class Listener {
 public:
  struct Callbacks {
    std::function<void(const Hearing&)> heard;
    /// A grammar that cannot be built, or no recogniser at all.
    std::function<void(const std::string&)> failed;
  };

  /// The recogniser is opened in the thread. `loop` outlives it; callbacks in its thread.
  Listener(RecogniserConfig config, RunLoop& loop, Callbacks callbacks);
  ~Listener();

  /// What may be said from now on; what was said before is judged by what was possible then.
  void Expect(std::vector<Command> commands, int64_t tag);
  void Hear(Segment segment);

  /// Segments that were left out because too many waited.
  int64_t dropped() const;

 private:
  struct Expectation {
    std::vector<Command> commands;
    int64_t tag;
  };
  using Job = std::variant<Expectation, Segment>;

  void Run(const RecogniserConfig& config);
  bool Next(Job& job);
  void Post(std::function<void(Listener&)> work);

  RunLoop& loop_;
  const Callbacks callbacks_;
  std::shared_ptr<Listener*> self_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> jobs_;
  int64_t dropped_ = 0;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace beckon::ui_bridge::speech
