// Ed25519 signatures (RFC 8032, by libsodium) over encoded messages. Pure: bytes in, bytes out.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "services/base/result.h"

namespace beckon::trust {

using KeyId = std::array<uint8_t, 8>;
using PublicKey = std::array<uint8_t, 32>;

/// First bytes of the key, as seal_t carries them.
KeyId IdOf(const PublicKey& key);
/// "9f3a52c0d1e4b687"
std::string ToText(const KeyId& id);

/// Base64 of 32 bytes, as key files hold it.
std::string ToText(const PublicKey& key);
Result<PublicKey> PublicKeyFromText(const std::string& text);

/// A key pair; the secret is wiped when it goes.
class SecretKey {
 public:
  /// From the machine's random numbers.
  static SecretKey Generate();
  /// From what ToText gave.
  static Result<SecretKey> FromText(const std::string& text);
  SecretKey(const SecretKey& other) = default;
  SecretKey& operator=(const SecretKey& other) = default;
  ~SecretKey();

  /// The seed in base64: a secret.
  std::string ToText() const;
  const PublicKey& public_key() const { return public_key_; }

  /// Signs an encoded message whose last field is a seal_t, thus whose last 64 bytes are the
  /// signature: they are overwritten. What is signed is the message with those bytes zero; its
  /// first bytes, LCM's fingerprint, bind the type and with it the channel.
  void Sign(std::span<uint8_t> encoded) const;

 private:
  explicit SecretKey(const std::array<uint8_t, 32>& seed);
  std::array<uint8_t, 64> secret_{};
  PublicKey public_key_{};
};

/// Whether Sign of the matching key made this.
bool IsSignedBy(std::span<const uint8_t> encoded, const PublicKey& key);

}  // namespace beckon::trust
