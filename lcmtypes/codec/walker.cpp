#include "lcmtypes/codec/walker.h"

namespace beckon::codec {
namespace {

uint64_t BigEndian(std::span<const uint8_t> bytes) {
  uint64_t value = 0;
  for (uint8_t byte : bytes) value = value << 8 | byte;
  return value;
}

}  // namespace

void Walker::Fail(std::string what) {
  if (error_.empty()) error_ = std::move(what);
  left_ = {};
}

void Walker::Skip(size_t size) {
  if (!ok()) return;
  if (left_.size() < size) return Fail("truncated");
  left_ = left_.subspan(size);
}

int32_t Walker::Int32(const char* field) {
  if (!ok()) return 0;
  if (left_.size() < 4) {
    Fail(std::string("truncated at ") + field);
    return 0;
  }
  const auto value = static_cast<int32_t>(BigEndian(left_.first(4)));
  left_ = left_.subspan(4);
  return value;
}

int32_t Walker::Count(const char* field, int32_t max) {
  const int32_t count = Int32(field);
  if (count >= 0 && count <= max) return count;
  Fail(std::string(field) + " is " + std::to_string(count) + ", expected 0 .. " +
       std::to_string(max));
  return 0;
}

void Walker::String(const char* field, int32_t max) {
  // LCM counts the terminating zero.
  const int32_t size = Int32(field);
  if (!ok()) return;
  if (size < 1 || size > max + 1) {
    return Fail(std::string(field) + " has " + std::to_string(size - 1) +
                " characters, expected 0 .. " + std::to_string(max));
  }
  if (left_.size() < static_cast<size_t>(size)) return Fail(std::string("truncated in ") + field);
  if (left_[size - 1] != 0) return Fail(std::string(field) + " is not terminated");
  left_ = left_.subspan(size);
}

void Walker::Fingerprint(int64_t expected) {
  if (left_.size() < 8) return Fail("shorter than a fingerprint");
  if (static_cast<int64_t>(BigEndian(left_.first(8))) != expected) {
    return Fail("another type or another version of the type (fingerprint differs)");
  }
  left_ = left_.subspan(8);
}

void Walker::End() {
  if (ok() && !left_.empty()) Fail(std::to_string(left_.size()) + " bytes too many");
}

}  // namespace beckon::codec
