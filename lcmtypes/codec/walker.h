// Walks over an encoded message before LCM's generated decoder sees it. That decoder trusts the
// lengths it reads: a negative one throws, a huge one allocates gigabytes. The walk reads lengths
// only, within bounds.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace beckon::codec {

/// A cursor over big-endian LCM bytes. The first failure sticks; later steps do nothing.
class Walker {
 public:
  explicit Walker(std::span<const uint8_t> bytes) : left_(bytes) {}

  /// Fields of fixed size, in bytes.
  void Skip(size_t size);
  /// A count of array elements, 0 .. max.
  int32_t Count(const char* field, int32_t max);
  /// A string of at most `max` characters.
  void String(const char* field, int32_t max);
  /// The 8-byte fingerprint that starts a message.
  void Fingerprint(int64_t expected);
  /// Everything must have been consumed.
  void End();

  bool ok() const { return error_.empty(); }
  const std::string& error() const { return error_; }

 private:
  int32_t Int32(const char* field);
  void Fail(std::string what);

  std::span<const uint8_t> left_;
  std::string error_;
};

}  // namespace beckon::codec
