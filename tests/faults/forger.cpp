#include "tests/faults/forger.h"

#include <algorithm>
#include <tuple>

#include "lcmtypes/codec.h"
#include "services/base/utime.h"
#include "tests/lcmtypes/examples.h"

namespace beckon::faults {
namespace {

constexpr Utime kLifetime = 10 * kSecond;
constexpr Utime kHeldBack = 5 * kSecond;  // beyond its life
constexpr int kTries = 30;                // to alter a message within its type's rules

template <typename T>
constexpr bool kSealed = requires(T message) {
  message.seal;
};

void SealAs(const trust::OwnKey& key, Utime now, msg::Seal& seal) {
  seal.counter = now;
  seal.expires_utime = now + kLifetime;
  seal.key_id = trust::IdOf(key.node.key);
}

}  // namespace

template <typename T>
std::optional<std::vector<uint8_t>> Forger::Alter(std::span<const uint8_t> real) {
  for (int i = 0; i < kTries; ++i) {
    std::vector<uint8_t> bytes(real.begin(), real.end());
    for (uint64_t flips = 1 + random_() % 3; flips > 0; --flips)
      bytes[random_() % bytes.size()] ^= static_cast<uint8_t>(1U << random_() % 8);
    if (!std::ranges::equal(bytes, real) && Codec<T>::Decode(bytes)) return bytes;
  }
  return {};
}

template <typename T>
std::optional<std::vector<uint8_t>> Forger::ForgeAs(Forgery kind, std::span<const uint8_t> real) {
  auto message = Codec<T>::Decode(real);
  if (!message) return {};
  const trust::Demand demand = trust::DemandOf(*message);
  const Utime now = SystemClock().Now();
  const trust::OwnKey* signer = nullptr;
  switch (kind) {
    case Forgery::kReplayed:
      if (demand.may_repeat) return {};  // a stop is believed as often as it comes
      return std::vector<uint8_t>(real.begin(), real.end());
    case Forgery::kAltered:
      return Alter<T>(real);
    case Forgery::kUnsigned:
      message->seal.key_id.fill(0);
      message->seal.signature.fill(0);
      break;
    case Forgery::kUnknownKey:
      signer = &keys_.unknown;
      break;
    case Forgery::kRevoked:
      signer = &keys_.revoked;
      break;
    case Forgery::kWrongRole:
      if (keys_.wrong_role.node.may.HasAnyOf(demand.one_of)) return {};
      signer = &keys_.wrong_role;
      break;
    case Forgery::kExpired: {
      const auto found = std::ranges::find_if(keys_.genuine, [&](const auto& key) {
        return trust::IdOf(key.node.key) == message->seal.key_id;
      });
      if (found == keys_.genuine.end() || demand.may_last) return {};
      signer = &*found;
      break;
    }
  }
  if (signer != nullptr)
    SealAs(*signer, kind == Forgery::kExpired ? now - kLifetime - kHeldBack : now, message->seal);
  auto bytes = Codec<T>::Encode(*message);
  if (!bytes) return {};
  if (signer != nullptr) signer->secret.Sign(*bytes);
  return *std::move(bytes);
}

std::optional<std::vector<uint8_t>> Forger::Forge(Forgery kind, const std::string& channel,
                                                  std::span<const uint8_t> real) {
  std::optional<std::vector<uint8_t>> forged;
  const auto try_type = [&]<typename T>(const T&) {
    if constexpr (kSealed<T>) {
      if (channel == Codec<T>::kChannel) forged = ForgeAs<T>(kind, real);
    }
  };
  std::apply([&](const auto&... type) { (try_type(type), ...); }, msg::AllExamples());
  return forged;
}

std::map<std::string, std::vector<uint8_t>> ExamplesByChannel() {
  std::map<std::string, std::vector<uint8_t>> examples;
  const auto add = [&]<typename T>(const T& example) {
    if constexpr (kSealed<T>) examples[Codec<T>::kChannel] = *Codec<T>::Encode(example);
  };
  std::apply([&](const auto&... example) { (add(example), ...); }, msg::AllExamples());
  return examples;
}

std::vector<std::string> Forger::Channels() {
  std::vector<std::string> channels;
  for (const auto& [channel, bytes] : ExamplesByChannel()) channels.push_back(channel);
  return channels;
}

}  // namespace beckon::faults
