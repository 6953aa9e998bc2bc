#include "services/base/trust/signing.h"

#include <sodium.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace beckon::trust {
namespace {

constexpr size_t kSignature = crypto_sign_BYTES;
static_assert(kSignature == 64 && crypto_sign_PUBLICKEYBYTES == 32 && crypto_sign_SEEDBYTES == 32);

/// Before any use; harmless when repeated.
void Initialise() {
  static const int done = sodium_init();
  if (done < 0) throw std::runtime_error("libsodium cannot be initialised");
}

std::string ToBase64(std::span<const uint8_t> bytes) {
  std::string text(sodium_base64_encoded_len(bytes.size(), sodium_base64_VARIANT_ORIGINAL), '\0');
  sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(),
                    sodium_base64_VARIANT_ORIGINAL);
  text.pop_back();  // the terminating zero
  return text;
}

Result<std::array<uint8_t, 32>> FromBase64(const std::string& text) {
  std::array<uint8_t, 32> bytes{};
  size_t length = 0;
  if (sodium_base642bin(bytes.data(), bytes.size(), text.data(), text.size(), nullptr, &length,
                        nullptr, sodium_base64_VARIANT_ORIGINAL) != 0 ||
      length != bytes.size()) {
    return Error{"expected a key of 32 bytes in base64 (44 characters)"};
  }
  return bytes;
}

std::vector<uint8_t> WithoutSignature(std::span<const uint8_t> encoded) {
  std::vector<uint8_t> bytes(encoded.begin(), encoded.end());
  std::fill(bytes.end() - kSignature, bytes.end(), 0);
  return bytes;
}

}  // namespace

KeyId IdOf(const PublicKey& key) {
  KeyId id;
  std::copy_n(key.begin(), id.size(), id.begin());
  return id;
}

std::string ToText(const KeyId& id) {
  std::string text(2 * id.size() + 1, '\0');
  sodium_bin2hex(text.data(), text.size(), id.data(), id.size());
  text.pop_back();
  return text;
}

std::string ToText(const PublicKey& key) { return ToBase64(key); }

Result<PublicKey> PublicKeyFromText(const std::string& text) { return FromBase64(text); }

SecretKey::SecretKey(const std::array<uint8_t, 32>& seed) {
  Initialise();
  crypto_sign_seed_keypair(public_key_.data(), secret_.data(), seed.data());
}

SecretKey::~SecretKey() { sodium_memzero(secret_.data(), secret_.size()); }

SecretKey SecretKey::Generate() {
  Initialise();
  std::array<uint8_t, 32> seed{};
  randombytes_buf(seed.data(), seed.size());
  SecretKey key(seed);
  sodium_memzero(seed.data(), seed.size());
  return key;
}

Result<SecretKey> SecretKey::FromText(const std::string& text) {
  auto seed = FromBase64(text);
  if (!seed) return seed.error();
  SecretKey key(*seed);
  sodium_memzero(seed->data(), seed->size());
  return key;
}

std::string SecretKey::ToText() const {
  std::array<uint8_t, 32> seed{};
  crypto_sign_ed25519_sk_to_seed(seed.data(), secret_.data());
  std::string text = ToBase64(seed);
  sodium_memzero(seed.data(), seed.size());
  return text;
}

void SecretKey::Sign(std::span<uint8_t> encoded) const {
  if (encoded.size() < kSignature) throw std::invalid_argument("no room for a signature");
  const auto signature = encoded.last(kSignature);
  std::ranges::fill(signature, uint8_t{0});
  std::array<uint8_t, kSignature> made{};
  crypto_sign_detached(made.data(), nullptr, encoded.data(), encoded.size(), secret_.data());
  std::ranges::copy(made, signature.begin());
}

bool IsSignedBy(std::span<const uint8_t> encoded, const PublicKey& key) {
  if (encoded.size() < kSignature) return false;
  Initialise();
  const auto bytes = WithoutSignature(encoded);
  const auto signature = encoded.last(kSignature);
  return crypto_sign_verify_detached(signature.data(), bytes.data(), bytes.size(), key.data()) == 0;
}

}  // namespace beckon::trust
