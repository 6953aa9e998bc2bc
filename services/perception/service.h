// The running service: takes the newest FRAME, publishes its SCENE, reports how it fares.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/messages.h"
#include "services/base/bus.h"
#include "services/base/latest_worker.h"
#include "services/base/run_loop.h"
#include "services/base/status_reporter.h"
#include "services/perception/perceiver.h"
#include "services/perception/told_store.h"

namespace beckon::perception {

/// All of it runs in `loop`'s thread but the perceiving, which has a thread of its own that takes
/// the newest frame and skips those it is too slow for. A frame whose image equals the last one's
/// is not computed again: its scene is published with the new time. What LABEL says of an object
/// shows in a scene at once, of the newest frame; it must name a scene of this run, for ids are
/// others in another.
class Service {
 public:
  /// `bus` and `loop` must outlive this; `categoriser` is taken over.
  Service(Bus& bus, RunLoop& loop, const PerceiverConfig& config,
          std::optional<Categoriser> categoriser, const ToldStoreConfig& learning = {});
  ~Service();
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  struct Counters {
    int64_t frames = 0;           // received whole
    int64_t dropped = 0;          // skipped for a newer one
    int64_t damaged = 0;          // whose images could not be decoded
    int64_t failed = 0;           // that could not be perceived: a fault of ours
    int64_t computed = 0;         // perceived
    int64_t repeated = 0;         // that equalled the one before
    int64_t scenes = 0;           // published
    int64_t objects = 0;          // in the last scene
    int64_t segmentation_us = 0;  // of the last computed frame
    int64_t categorisation_us = 0;
    int64_t labels = 0;            // received: of these
    int64_t labels_stale = 0;      // of a scene that is not known (any more),
    int64_t labels_unmatched = 0;  // of an object that is not known (any more),
    int64_t labels_taken = 0;      // new, and heeded
    int64_t examples = 0;          // views of named objects, remembered
    int64_t examples_kept = 0;     // written to the folder
    int64_t examples_failed = 0;   // that could not be written or removed
    int64_t examples_torn = 0;     // left out at the start
  };
  Counters counters() const;
  /// One line for people.
  const std::string& state() const { return state_; }

 private:
  /// What the worker made of a frame.
  struct Outcome {
    msg::Scene scene;
    std::string state;
    bool repeated = false;
    bool idle = false;    // looked for labels only, and none were new
    std::string damage;   // why the frame was refused; empty where it was not
    std::string failure;  // why perceiving it failed
    int labels_taken = 0, labels_unmatched = 0;
    int examples = 0, examples_kept = 0;
    std::vector<std::string> examples_failed;
  };
  /// By which a LABEL names a scene.
  struct SceneName {
    int64_t seq = 0;
    Utime utime = 0;
    std::string source;
    bool operator==(const SceneName&) const = default;
  };
  class FrameWorker;
  class Inbox;
  using FramePtr = std::shared_ptr<const msg::Frame>;

  void OnLabel(msg::Label label);

  void Publish(Outcome outcome);

  Bus& bus_;
  RunLoop& loop_;
  Counters counters_;
  int64_t seq_ = 0;
  std::string state_ = "no frame yet";
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);  // for what is posted and comes late
  FramePtr newest_;                  // received; the worker may have it too, or be done with it
  std::deque<SceneName> published_;  // the newest
  std::shared_ptr<Inbox> inbox_;     // of the worker
  std::unique_ptr<FrameWorker> work_;
  std::unique_ptr<LatestWorker<FramePtr>> worker_;
  StatusReporter status_;
};

}  // namespace beckon::perception
