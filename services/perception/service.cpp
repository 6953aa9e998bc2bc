// Wires the bus, the worker and the perceiver.
#include "services/perception/service.h"

#include <spdlog/spdlog.h>

#include <exception>
#include <utility>

#include "lcmtypes/frame_image.h"
#include "services/perception/scene_message.h"

namespace beckon::perception {

/// Lives in the worker's thread: remembers the last frame and what was made of it.
class Service::FrameWorker {
 public:
  FrameWorker(const PerceiverConfig& config, std::optional<Categoriser> categoriser)
      : categoriser_(std::move(categoriser)),
        perceiver_(config, categoriser_ ? &*categoriser_ : nullptr) {}

  Outcome Work(msg::Frame frame) {
    Outcome outcome;
    outcome.repeated = last_frame_ && SameImage(frame, *last_frame_);
    if (!outcome.repeated && !Perceive(frame, outcome)) return outcome;
    outcome.scene = last_scene_;
    outcome.scene.utime = frame.utime;
    outcome.scene.frame_seq = frame.seq;
    outcome.scene.source = frame.source;
    outcome.state = last_state_;
    last_frame_ = std::move(frame);
    return outcome;
  }

 private:
  bool Perceive(const msg::Frame& frame, Outcome& outcome) {
    try {
      const auto image = DecodeImage(frame);
      if (!image) {
        outcome.damage = image.error().message;
        return false;
      }
      const Perception perception = perceiver_.Perceive(*image);
      last_scene_ = MakeScene(*image, perception);
      last_state_ = State(perception);
      return true;
    } catch (const std::exception& e) {
      outcome.failure = e.what();
      return false;
    }
  }

  static bool SameImage(const msg::Frame& a, const msg::Frame& b) {
    const auto camera = [](const msg::Frame& f) {
      const Intrinsics& i = f.intrinsics;
      return std::array{i.fx, i.fy, i.cx, i.cy, f.depth_unit_m};
    };
    return a.width == b.width && a.height == b.height && camera(a) == camera(b) &&
           a.depth_codec == b.depth_codec && a.colour_codec == b.colour_codec &&
           a.depth == b.depth && a.colour == b.colour;
  }

  static std::string State(const Perception& perception) {
    if (!perception.segmentation.table_C) {
      return "no table in view: " + perception.segmentation.reason;
    }
    const size_t n = perception.objects.size();
    return std::to_string(n) + (n == 1 ? " object" : " objects");
  }

  std::optional<Categoriser> categoriser_;
  Perceiver perceiver_;
  std::optional<msg::Frame> last_frame_;
  msg::Scene last_scene_;
  std::string last_state_;
};

Service::Service(Bus& bus, RunLoop& loop, const PerceiverConfig& config,
                 std::optional<Categoriser> categoriser)
    : bus_(bus),
      loop_(loop),
      work_(std::make_unique<FrameWorker>(config, std::move(categoriser))),
      status_("perception", bus, loop, [this](msg::Status& status) {
        const Counters c = counters();
        status.state = state_;
        for (const auto& [name, value] : std::initializer_list<std::pair<const char*, int64_t>>{
                 {"frames", c.frames},
                 {"dropped", c.dropped},
                 {"damaged", c.damaged},
                 {"failed", c.failed},
                 {"computed", c.computed},
                 {"repeated", c.repeated},
                 {"scenes", c.scenes},
                 {"objects", c.objects},
                 {"segmentation_us", c.segmentation_us},
                 {"categorisation_us", c.categorisation_us}}) {
          status.counters.push_back({name, value});
        }
      }) {
  worker_ = std::make_unique<LatestWorker<msg::Frame>>([this](msg::Frame frame) {
    loop_.Post([this, alive = std::weak_ptr<bool>(alive_),
                outcome = work_->Work(std::move(frame))]() mutable {
      if (alive.lock()) Publish(std::move(outcome));
    });
  });
  bus_.Subscribe<msg::Frame>(
      [this, alive = std::weak_ptr<bool>(alive_)](msg::Frame frame) {
        if (!alive.lock()) return;
        ++counters_.frames;
        worker_->Offer(std::move(frame));
      },
      1);
}

Service::~Service() {
  worker_.reset();  // waits for the frame at work
}

Service::Counters Service::counters() const {
  Counters counters = counters_;
  counters.dropped = worker_ ? worker_->dropped() : 0;
  return counters;
}

void Service::Publish(Outcome outcome) {
  if (!outcome.damage.empty()) {
    ++counters_.damaged;
    bus_.Refuse(Codec<msg::Frame>::kChannel, outcome.damage);
    return;
  }
  if (!outcome.failure.empty()) {
    ++counters_.failed;
    spdlog::error("a frame could not be perceived: {}", outcome.failure);
    return;
  }
  if (outcome.state != state_) spdlog::info("{}", outcome.state);
  state_ = std::move(outcome.state);
  ++(outcome.repeated ? counters_.repeated : counters_.computed);
  counters_.objects = static_cast<int64_t>(outcome.scene.objects.size());
  counters_.segmentation_us = static_cast<int64_t>(outcome.scene.segmentation_ms * 1000);
  counters_.categorisation_us = static_cast<int64_t>(outcome.scene.categorisation_ms * 1000);
  outcome.scene.seq = ++seq_;
  if (Status sent = bus_.Publish(outcome.scene); !sent) {
    ++counters_.failed;
    spdlog::error("{}", sent.error().message);
    return;
  }
  ++counters_.scenes;
}

}  // namespace beckon::perception
