// Wires the bus, the worker and the perceiver.
#include "services/perception/service.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <utility>

#include "lcmtypes/frame_image.h"
#include "services/perception/scene_message.h"

namespace beckon::perception {
namespace {

/// Scenes that a LABEL may name: more than a minute of them.
constexpr size_t kNamedScenes = 2048;
/// Labels that are known to have been heard.
constexpr size_t kHeard = 256;

}  // namespace

/// Labels on their way to the worker.
class Service::Inbox {
 public:
  void Put(msg::Label label) {
    std::lock_guard lock(mutex_);
    if (labels_.size() < kMost) labels_.push_back(std::move(label));
  }
  std::vector<msg::Label> Take() {
    std::lock_guard lock(mutex_);
    return std::exchange(labels_, {});
  }

 private:
  static constexpr size_t kMost = 256;  // they are repeated
  std::mutex mutex_;
  std::vector<msg::Label> labels_;
};

/// Lives in the worker's thread: remembers the last frame and what was made of it.
class Service::FrameWorker {
 public:
  FrameWorker(const PerceiverConfig& config, std::optional<Categoriser> categoriser,
              std::optional<ToldStore> store, std::shared_ptr<Inbox> inbox)
      : categoriser_(std::move(categoriser)),
        perceiver_(config, categoriser_ ? &*categoriser_ : nullptr),
        store_(std::move(store)),
        inbox_(std::move(inbox)) {
    if (!store_) return;
    for (const ToldExample& example : store_->loaded()) perceiver_.Learn(example);
  }

  Outcome Work(FramePtr frame) {
    Outcome outcome;
    for (const msg::Label& label : inbox_->Take()) Hear(label, outcome);
    outcome.idle = outcome.labels_taken == 0 && frame == last_frame_;
    outcome.repeated = outcome.labels_taken == 0 && last_frame_ && SameImage(*frame, *last_frame_);
    if (outcome.idle || (!outcome.repeated && !Perceive(*frame, outcome))) return outcome;
    outcome.scene = last_scene_;
    outcome.scene.utime = frame->utime;
    outcome.scene.frame_seq = frame->seq;
    outcome.scene.source = frame->source;
    outcome.state = last_state_;
    outcome.examples = static_cast<int>(perceiver_.examples().all().size());
    last_frame_ = std::move(frame);
    return outcome;
  }

 private:
  void Note(const Status& stored, Outcome& outcome) {
    if (!stored) outcome.examples_failed.push_back(stored.error().message);
  }

  /// Each label once, however often it is repeated.
  void Hear(const msg::Label& label, Outcome& outcome) {
    const auto heard = std::ranges::find(heard_, label.label_id, &msg::Label::label_id);
    if (heard != heard_.end() && heard->utime >= label.utime) return;
    const bool changes = heard == heard_.end() || heard->category != label.category;
    const std::string name = ToldStore::NameOf(label.label_id);
    if (label.state == msg::LabelState::kRetracted) {
      perceiver_.Retract(name);
      if (store_) Note(store_->Remove(name), outcome);
    } else {
      const auto outdated = perceiver_.Tell(label.object_id, {name, label.category});
      if (!outdated) {
        ++outcome.labels_unmatched;
        return;  // it may come again, with another id
      }
      if (store_ && !outdated->empty()) Note(store_->Remove(*outdated), outcome);
      if (store_ && heard != heard_.end() && changes) Note(store_->Remove(name), outcome);
    }
    ++outcome.labels_taken;
    if (heard != heard_.end()) heard_.erase(heard);
    heard_.push_back(label);
    if (heard_.size() > kHeard) heard_.pop_front();
  }

  void Keep(const RgbdImage& image, const Perception& perception, Outcome& outcome) {
    for (const PerceivedObject& object : perception.objects) {
      if (!store_ || !object.is_example) continue;
      const Status kept =
          store_->Add(object.told->label_id, object.told->category,
                      {image, object.shape.pixels, perception.segmentation.table_C});
      outcome.examples_kept += kept ? 1 : 0;
      Note(kept, outcome);
    }
  }

  bool Perceive(const msg::Frame& frame, Outcome& outcome) {
    try {
      const auto image = DecodeImage(frame);
      if (!image) {
        outcome.damage = image.error().message;
        return false;
      }
      const Perception perception = perceiver_.Perceive(*image);
      Keep(*image, perception, outcome);
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
  std::optional<ToldStore> store_;
  const std::shared_ptr<Inbox> inbox_;
  std::deque<msg::Label> heard_;  // the newest of each, oldest first
  FramePtr last_frame_;
  msg::Scene last_scene_;
  std::string last_state_;
};

namespace {

/// Nothing where there is no folder, and where it is of no use: perception lives without it.
std::optional<ToldStore> OpenStore(const ToldStoreConfig& learning, Service::Counters& counters) {
  if (learning.folder.empty()) return std::nullopt;
  auto store = ToldStore::Open(learning);
  if (!store) {
    ++counters.examples_failed;
    spdlog::error("{}; what the user says is remembered in this run alone", store.error().message);
    return std::nullopt;
  }
  for (const std::string& warning : store->warnings()) spdlog::warn("{}", warning);
  counters.examples_torn = static_cast<int64_t>(store->warnings().size());
  counters.examples = static_cast<int64_t>(store->loaded().size());
  spdlog::info("{} examples of named objects in {}", store->loaded().size(), learning.folder);
  return *std::move(store);
}

}  // namespace

Service::Service(Bus& bus, RunLoop& loop, const PerceiverConfig& config,
                 std::optional<Categoriser> categoriser, const ToldStoreConfig& learning)
    : bus_(bus),
      loop_(loop),
      inbox_(std::make_shared<Inbox>()),
      work_(std::make_unique<FrameWorker>(config, std::move(categoriser),
                                          OpenStore(learning, counters_), inbox_)),
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
                 {"categorisation_us", c.categorisation_us},
                 {"labels", c.labels},
                 {"labels_stale", c.labels_stale},
                 {"labels_unmatched", c.labels_unmatched},
                 {"labels_taken", c.labels_taken},
                 {"examples", c.examples},
                 {"examples_kept", c.examples_kept},
                 {"examples_failed", c.examples_failed},
                 {"examples_torn", c.examples_torn}}) {
          status.counters.push_back({name, value});
        }
      }) {
  worker_ = std::make_unique<LatestWorker<FramePtr>>([this](FramePtr frame) {
    loop_.Post([this, alive = std::weak_ptr<bool>(alive_),
                outcome = work_->Work(std::move(frame))]() mutable {
      if (alive.lock()) Publish(std::move(outcome));
    });
  });
  bus_.Subscribe<msg::Frame>(
      [this, alive = std::weak_ptr<bool>(alive_)](msg::Frame frame) {
        if (!alive.lock()) return;
        ++counters_.frames;
        newest_ = std::make_shared<const msg::Frame>(std::move(frame));
        worker_->Offer(newest_);
      },
      1);
  bus_.Subscribe<msg::Label>([this, alive = std::weak_ptr<bool>(alive_)](msg::Label label) {
    if (alive.lock()) OnLabel(std::move(label));
  });
}

Service::~Service() {
  worker_.reset();  // waits for the frame at work
}

Service::Counters Service::counters() const {
  Counters counters = counters_;
  counters.dropped = worker_ ? worker_->dropped() : 0;
  return counters;
}

void Service::OnLabel(msg::Label label) {
  ++counters_.labels;
  const SceneName named{label.scene_seq, label.scene_utime, label.source};
  const bool known = std::ranges::find(published_, named) != published_.end();
  if (!known && label.state == msg::LabelState::kGiven) {
    ++counters_.labels_stale;
    return;
  }
  inbox_->Put(std::move(label));
  if (newest_) worker_->Offer(newest_);  // the view that the user spoke of, or the next
}

void Service::Publish(Outcome outcome) {
  counters_.labels_taken += outcome.labels_taken;
  counters_.labels_unmatched += outcome.labels_unmatched;
  counters_.examples_kept += outcome.examples_kept;
  counters_.examples_failed += static_cast<int64_t>(outcome.examples_failed.size());
  for (const std::string& failed : outcome.examples_failed) spdlog::error("{}", failed);
  if (outcome.idle) return;
  if (!outcome.damage.empty()) {
    ++counters_.damaged;
    bus_.Refuse(Codec<msg::Frame>::kChannel, refusal::kDamaged, outcome.damage);
    return;
  }
  if (!outcome.failure.empty()) {
    ++counters_.failed;
    spdlog::error("a frame could not be perceived: {}", outcome.failure);
    return;
  }
  if (outcome.state != state_) spdlog::info("{}", outcome.state);
  state_ = std::move(outcome.state);
  counters_.examples = outcome.examples;
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
  published_.push_back({outcome.scene.seq, outcome.scene.utime, outcome.scene.source});
  if (published_.size() > kNamedScenes) published_.pop_front();
}

}  // namespace beckon::perception
