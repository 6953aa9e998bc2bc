// Messages that are not to be believed, made of ones that are, as somebody on the network could:
// one kind for each reason to refuse a message.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "services/base/trust/key_folder.h"

namespace beckon::faults {

enum class Forgery {
  kUnsigned,    // the seal wiped
  kUnknownKey,  // signed by a key that nobody trusts
  kRevoked,     // by one that was revoked
  kWrongRole,   // by one that is trusted with other things
  kExpired,     // truly signed, but held back too long
  kAltered,     // some bits changed
  kReplayed     // sent again as it was
};
inline constexpr std::array kForgeries = {
    std::pair{Forgery::kUnsigned, "unsigned"},   std::pair{Forgery::kUnknownKey, "unknown key"},
    std::pair{Forgery::kRevoked, "revoked key"}, std::pair{Forgery::kWrongRole, "wrong role"},
    std::pair{Forgery::kExpired, "expired"},     std::pair{Forgery::kAltered, "altered"},
    std::pair{Forgery::kReplayed, "replayed"}};

class Forger {
 public:
  struct Keys {
    trust::OwnKey unknown, revoked, wrong_role;
    std::vector<trust::OwnKey> genuine;  // whose messages are to be believed
  };
  Forger(Keys keys, uint64_t seed) : keys_(std::move(keys)), random_(seed) {}

  /// Of `real`, which travelled on `channel`. Always a well-formed message that its type's rules
  /// allow; nothing where that cannot be made of it.
  std::optional<std::vector<uint8_t>> Forge(Forgery kind, const std::string& channel,
                                            std::span<const uint8_t> real);
  /// Channels whose messages are sealed.
  static std::vector<std::string> Channels();

 private:
  template <typename T>
  std::optional<std::vector<uint8_t>> ForgeAs(Forgery kind, std::span<const uint8_t> real);
  template <typename T>
  std::optional<std::vector<uint8_t>> Alter(std::span<const uint8_t> real);

  Keys keys_;
  std::mt19937_64 random_;
};

/// A valid message of each sealed type, for those that were not heard.
std::map<std::string, std::vector<uint8_t>> ExamplesByChannel();

}  // namespace beckon::faults
