#include "tests/faults/tap.h"

namespace beckon::faults {

Tap::Tap(const Lab& lab, size_t host, RunLoop& loop) : loop_(loop) {
  lab.In(host, [this] {
    lcm_ = std::make_unique<lcm::LCM>(Lab::LcmUrl());
    lcm_->subscribe("BECKON_.*", &Tap::Hear, this)->setQueueCapacity(0);  // without bound
  });
  loop_.AddFd(lcm_->getFileno(), [this] { lcm_->handleTimeout(0); });
}

Tap::~Tap() { loop_.RemoveFd(lcm_->getFileno()); }

void Tap::Hear(const lcm::ReceiveBuffer* buffer, const std::string& name) {
  Channel& channel = channels_[name];
  ++channel.heard;
  const auto* data = static_cast<const uint8_t*>(buffer->data);
  channel.latest.emplace_back(data, data + buffer->data_size);
  if (channel.latest.size() > kKept) channel.latest.pop_front();
}

void Tap::Say(const std::string& name, std::span<const uint8_t> bytes) {
  ++channels_[name].said;
  lcm_->publish(name, bytes.data(), static_cast<unsigned>(bytes.size()));
}

}  // namespace beckon::faults
