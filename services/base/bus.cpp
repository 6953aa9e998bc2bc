#include "services/base/bus.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <exception>
#include <lcm/lcm-cpp.hpp>

namespace beckon {

/// What one channel's subscription hands to LCM; lives as long as the bus.
struct Bus::Handler {
  Bus* bus;
  BytesHandler handle;
  int queue;
  lcm::Subscription* subscription = nullptr;

  // Called from LCM's C code: nothing may be thrown through it.
  void OnMessage(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    ++bus->received_;
    ChannelTraffic& traffic = bus->traffic_[channel];
    ++traffic.received;
    traffic.received_bytes += buffer->data_size;
    const Utime wait_us = SystemClock().Now() - buffer->recv_utime;
    traffic.wait_us_max = std::max(traffic.wait_us_max, wait_us);
    const Stopwatch stopwatch;
    bus->Guarded(channel, [&] {
      handle({static_cast<const uint8_t*>(buffer->data), buffer->data_size});
    });
    const auto handler_us = static_cast<Utime>(stopwatch.Milliseconds() * 1000);
    traffic.handler_us_max = std::max(traffic.handler_us_max, handler_us);
  }
};

Result<std::unique_ptr<Bus>> Bus::Open(const std::string& url,
                                       std::unique_ptr<trust::Guard> guard) {
  auto lcm = std::make_unique<lcm::LCM>(url);
  if (!lcm->good()) {
    return Error{"LCM cannot open '" + url + "': expected e.g. " + kDefaultLcmUrl +
                 "; for udpm:// the machine needs a multicast route "
                 "(ip route add 224.0.0.0/4 dev lo), see 'beckon doctor'"};
  }
  return std::unique_ptr<Bus>(new Bus(std::move(lcm), std::move(guard)));
}

Bus::Bus(std::unique_ptr<lcm::LCM> lcm, std::unique_ptr<trust::Guard> guard)
    : lcm_(std::move(lcm)), guard_(std::move(guard)) {}
Bus::~Bus() = default;

void Bus::Stamp(msg::Seal& seal, bool may_last) {
  if (guard_ != nullptr) return guard_->Stamp(seal, may_last);
  counter_ = std::max(counter_ + 1, SystemClock().Now());
  seal.counter = counter_;
}

bool Bus::Believe(const char* channel, const msg::Seal& seal, const trust::Demand& demand,
                  std::span<const uint8_t> bytes) {
  if (guard_ == nullptr) return true;
  const auto rejection = guard_->Check(channel, seal, demand, bytes);
  if (rejection) Refuse(channel, rejection->reason, rejection->detail);
  return !rejection;
}

void Bus::Refuse(const std::string& channel, const std::string& reason, const std::string& detail) {
  ++refused_;
  const int64_t count = ++traffic_[channel].refused[reason];
  // The first few, then each power of two: a flood must not fill the log.
  if (count <= 8 || (count & (count - 1)) == 0) {
    spdlog::warn("{}: refused message ({}, {} so far): {}", channel, reason, count, detail);
  }
}

void Bus::ForgetPeaks() {
  for (auto& [channel, traffic] : traffic_) traffic.ForgetPeaks();
}

void Bus::NoteStreamed(const char* channel, int64_t seq, Utime stamp) {
  ChannelTraffic& traffic = traffic_[channel];
  traffic.NoteSeq(seq);
  traffic.age_us_max = std::max(traffic.age_us_max, SystemClock().Now() - stamp);
}

int Bus::fd() const { return lcm_->getFileno(); }

void Bus::HandleReadable() { lcm_->handleTimeout(0); }

Status Bus::PublishBytes(const char* channel, const std::vector<uint8_t>& bytes) {
  if (lcm_->publish(channel, bytes.data(), static_cast<unsigned>(bytes.size())) != 0) {
    return Error{std::string(channel) + ": LCM could not send " + std::to_string(bytes.size()) +
                 " bytes"};
  }
  ChannelTraffic& traffic = traffic_[channel];
  ++traffic.sent;
  traffic.sent_bytes += static_cast<int64_t>(bytes.size());
  return {};
}

void Bus::Guarded(const std::string& channel, const std::function<void()>& call) {
  try {
    call();
  } catch (const std::exception& e) {
    Refuse(channel, refusal::kHandler, std::string("handler failed: ") + e.what());
  }
}

void Bus::SubscribeBytes(const char* channel, int queue, BytesHandler handle) {
  auto& handler = handlers_[channel];
  handler = std::make_unique<Handler>(Handler{this, std::move(handle), queue});
  handler->subscription = lcm_->subscribe(channel, &Handler::OnMessage, handler.get());
  handler->subscription->setQueueCapacity(queue);
}

void Bus::Widen(const char* channel, int queue) {
  Handler& handler = *handlers_.at(channel);
  if (queue <= handler.queue) return;
  handler.queue = queue;
  handler.subscription->setQueueCapacity(queue);
}

}  // namespace beckon
