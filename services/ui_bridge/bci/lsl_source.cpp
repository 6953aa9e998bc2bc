#include "services/ui_bridge/bci/lsl_source.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <utility>

namespace beckon::ui_bridge::bci {
namespace {

constexpr double kLook_s = 0.4;
constexpr double kPull_s = 0.2;
constexpr int32_t kBuffer_s = 10;
constexpr int kMostChannels = 65;  // 64 classes and a trial

}  // namespace

struct LslSource::Shared : std::enable_shared_from_this<Shared> {
  LslLibrary lsl{};
  std::string name;
  RunLoop* loop = nullptr;
  Handlers handlers;  // of the loop's thread
  std::atomic<bool> leave{false};
  std::thread thread;

  void Say(bool found) {
    loop->Post([self = shared_from_this(), found] {
      if (!self->leave) self->handlers.stream(found);
    });
  }

  void Pull(LslLibrary::Inlet inlet, int channels) {
    std::vector<double> values(static_cast<size_t>(channels));
    while (!leave) {
      int32_t error = 0;
      const double stamp = lsl.pull_sample_d(inlet, values.data(), channels, kPull_s, &error);
      if (error == LslLibrary::kLost) return;
      if (stamp == 0) continue;  // none yet
      LslSample sample{values, std::max(0.0, lsl.local_clock() - stamp)};
      loop->Post([self = shared_from_this(), sample = std::move(sample)] {
        if (!self->leave) self->handlers.sample(sample);
      });
    }
  }

  void Run() {
    while (!leave) {
      LslLibrary::Info info = nullptr;
      if (lsl.resolve_byprop(&info, 1, "name", name.c_str(), 1, kLook_s) < 1 || info == nullptr)
        continue;
      const int channels = std::clamp<int>(lsl.get_channel_count(info), 1, kMostChannels);
      // Not recovered by liblsl: a stream that is lost is to be seen as lost.
      LslLibrary::Inlet inlet = lsl.create_inlet(info, kBuffer_s, 0, 0);
      if (inlet != nullptr) {
        lsl.set_postprocessing(inlet, LslLibrary::kSynchroniseClocks);
        Say(true);
        Pull(inlet, channels);
        Say(false);
        lsl.destroy_inlet(inlet);
      }
      lsl.destroy_streaminfo(info);
    }
  }
};

LslSource::LslSource(const LslLibrary& library, const std::string& name, RunLoop& loop,
                     Handlers handlers)
    : shared_(std::make_shared<Shared>()) {
  shared_->lsl = library;
  shared_->name = name;
  shared_->loop = &loop;
  shared_->handlers = std::move(handlers);
  shared_->thread = std::thread([shared = shared_.get()] { shared->Run(); });
}

LslSource::~LslSource() {
  shared_->leave = true;
  shared_->thread.join();
}

}  // namespace beckon::ui_bridge::bci
