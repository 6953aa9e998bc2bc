// Typed publish and subscribe over LCM. Whatever arrives is checked before a handler sees it; what
// fails is counted by reason, logged, and the process lives on. No exception crosses LCM.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lcmtypes/codec.h"
#include "services/base/bus_traffic.h"
#include "services/base/refusal.h"
#include "services/base/result.h"
#include "services/base/trust/guard.h"

namespace lcm {
class LCM;
class Subscription;
}  // namespace lcm

namespace beckon {

/// Everything on this machine, nothing beyond it, and a receive buffer that holds frames (Debian's
/// default loses any message over about 200 kB at 30 Hz).
inline constexpr char kDefaultLcmUrl[] = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=2097152";

class Bus {
 public:
  /// `url` as LCM takes it (udpm://, memq://, file://). With a guard, messages that have a seal are
  /// signed, and only those that it believes reach a handler.
  static Result<std::unique_ptr<Bus>> Open(const std::string& url,
                                           std::unique_ptr<trust::Guard> guard = nullptr);
  ~Bus();

  /// Sends a message on its type's channel; refuses values that break the type's rules or its size.
  /// Of a seal the sender and, where it matters, the expiry are the caller's; the rest is filled
  /// in.
  template <typename T>
  Status Publish(const T& message) {
    if constexpr (requires { message.seal; }) {
      T sealed = message;
      Stamp(sealed.seal, trust::DemandOf(message).may_last);
      auto bytes = Codec<T>::Encode(sealed);
      if (!bytes) return bytes.error();
      if (guard_ != nullptr) guard_->Sign(*bytes);
      return PublishBytes(Codec<T>::kChannel, *bytes);
    } else {
      auto bytes = Codec<T>::Encode(message);
      if (!bytes) return bytes.error();
      return PublishBytes(Codec<T>::kChannel, *bytes);
    }
  }

  /// Calls `handler` with each valid message of the type that is to be believed. `queue` messages
  /// may wait; frames take 1, state and commands the default. Several handlers of one type are
  /// called in the order of subscription, with what is checked and counted once; the longest of
  /// their queues is everyone's.
  template <typename T>
  void Subscribe(std::function<void(T)> handler, int queue = 30) {
    auto& known = listeners_[Codec<T>::kChannel];
    const bool is_first = known == nullptr;
    if (is_first) known = std::make_shared<Listeners<T>>();
    auto listeners = std::static_pointer_cast<Listeners<T>>(known);
    listeners->push_back(std::move(handler));
    if (!is_first) return Widen(Codec<T>::kChannel, queue);
    SubscribeBytes(Codec<T>::kChannel, queue, [this, listeners](std::span<const uint8_t> bytes) {
      auto message = Codec<T>::Decode(bytes);
      if (!message) return Refuse(Codec<T>::kChannel, refusal::kMalformed, message.error().message);
      if constexpr (requires { message->seal; }) {
        if (!Believe(Codec<T>::kChannel, message->seal, trust::DemandOf(*message), bytes)) return;
      }
      if constexpr (requires { message->seq; })
        NoteStreamed(Codec<T>::kChannel, message->seq, message->utime);
      const size_t last = listeners->size() - 1;  // handlers may add to them
      for (size_t i = 0; i < last; ++i)
        Guarded(Codec<T>::kChannel, [&] { (*listeners)[i](*message); });
      Guarded(Codec<T>::kChannel, [&] { (*listeners)[last](*std::move(message)); });
    });
  }

  /// Counts and logs something refused; services use it for messages that are well formed but wrong
  /// (a stale answer). `reason` is a key of refusal.h, `detail` is for people.
  void Refuse(const std::string& channel, const std::string& reason, const std::string& detail);

  /// For RunLoop::AddFd: readable when HandleReadable has something to do.
  int fd() const;
  void HandleReadable();

  /// Messages received, and those refused, since the start.
  int64_t received() const { return received_; }
  int64_t refused() const { return refused_; }
  /// All of it by channel; the peaks are of the time since ForgetPeaks.
  const BusTraffic& traffic() const { return traffic_; }
  void ForgetPeaks();

 private:
  using BytesHandler = std::function<void(std::span<const uint8_t>)>;
  struct Handler;
  /// A deque, so that a handler which adds another one stays where it is.
  template <typename T>
  using Listeners = std::deque<std::function<void(T)>>;

  Bus(std::unique_ptr<lcm::LCM> lcm, std::unique_ptr<trust::Guard> guard);
  void Stamp(msg::Seal& seal, bool may_last);
  bool Believe(const char* channel, const msg::Seal& seal, const trust::Demand& demand,
               std::span<const uint8_t> bytes);
  Status PublishBytes(const char* channel, const std::vector<uint8_t>& bytes);
  void SubscribeBytes(const char* channel, int queue, BytesHandler handler);
  void Widen(const char* channel, int queue);
  /// Calls a handler; what it throws is refused.
  void Guarded(const std::string& channel, const std::function<void()>& call);
  void NoteStreamed(const char* channel, int64_t seq, Utime stamp);

  std::unique_ptr<lcm::LCM> lcm_;
  std::unique_ptr<trust::Guard> guard_;                       // null: messages are not signed
  int64_t counter_ = 0;                                       // of seals, where they are not
  std::map<std::string, std::unique_ptr<Handler>> handlers_;  // by channel
  std::map<std::string, std::shared_ptr<void>> listeners_;    // Listeners of the channel's type
  int64_t received_ = 0;
  int64_t refused_ = 0;
  BusTraffic traffic_;
};

}  // namespace beckon
