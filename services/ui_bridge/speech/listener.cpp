#include "services/ui_bridge/speech/listener.h"

#include <algorithm>
#include <utility>

namespace beckon::ui_bridge::speech {
namespace {

constexpr size_t kMostWaiting = 8;

}  // namespace

Listener::Listener(RecogniserConfig config, RunLoop& loop, Callbacks callbacks)
    : loop_(loop),
      callbacks_(std::move(callbacks)),
      self_(std::make_shared<Listener*>(this)),
      thread_([this, config = std::move(config)] { Run(config); }) {}

Listener::~Listener() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_one();
  thread_.join();
  *self_ = nullptr;
}

void Listener::Expect(std::vector<Command> commands, int64_t tag) {
  {
    std::lock_guard lock(mutex_);
    jobs_.emplace_back(Expectation{std::move(commands), tag});
  }
  changed_.notify_one();
}

void Listener::Hear(Segment segment) {
  {
    std::lock_guard lock(mutex_);
    const auto is_pause = [](const Job& job) {
      const auto* waiting = std::get_if<Segment>(&job);
      return waiting != nullptr && !waiting->ended;
    };
    std::erase_if(jobs_, is_pause);  // what comes now holds what was said before the pause
    const auto waiting = static_cast<size_t>(std::ranges::count_if(
        jobs_, [](const Job& job) { return std::holds_alternative<Segment>(job); }));
    if (waiting >= kMostWaiting) {
      ++dropped_;
      return;
    }
    jobs_.emplace_back(std::move(segment));
  }
  changed_.notify_one();
}

int64_t Listener::dropped() const {
  std::lock_guard lock(mutex_);
  return dropped_;
}

bool Listener::Next(Job& job) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return stopping_ || !jobs_.empty(); });
  if (stopping_) return false;
  job = std::move(jobs_.front());
  jobs_.pop_front();
  return true;
}

void Listener::Post(std::function<void(Listener&)> work) {
  loop_.Post([self = self_, work = std::move(work)] {
    if (*self != nullptr) work(**self);
  });
}

void Listener::Run(const RecogniserConfig& config) {
  auto opened = Recogniser::Open(config);
  const auto fail = [this](const std::string& reason) {
    Post([reason](Listener& listener) { listener.callbacks_.failed(reason); });
  };
  if (!opened) return fail(opened.error().message);
  Recogniser& recogniser = **opened;
  std::shared_ptr<const Grammar> grammar;
  int64_t tag = 0;
  for (Job job; Next(job);) {
    if (const auto* expected = std::get_if<Expectation>(&job)) {
      grammar.reset();
      tag = expected->tag;
      if (auto set = recogniser.Expect(expected->commands); !set) {
        fail(set.error().message);
      } else {
        grammar = std::make_shared<const Grammar>(recogniser.grammar());
      }
      continue;
    }
    if (grammar == nullptr) continue;
    const auto& segment = std::get<Segment>(job);
    Hearing hearing{recogniser.Hear(segment),
                    grammar,
                    tag,
                    segment.ended,
                    segment.begin_frame,
                    segment.loud_end - segment.loud_begin};
    Post(
        [hearing = std::move(hearing)](Listener& listener) { listener.callbacks_.heard(hearing); });
  }
}

}  // namespace beckon::ui_bridge::speech
