#include "services/base/cloud_bytes.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

namespace beckon::cloud {
namespace {

template <typename T>
double LoadAs(const char* bytes, bool swap) {
  char copy[sizeof(T)];
  std::memcpy(copy, bytes, sizeof(T));
  if (swap) std::reverse(copy, copy + sizeof(T));
  T value;
  std::memcpy(&value, copy, sizeof(T));
  return static_cast<double>(value);
}

bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

}  // namespace

size_t SizeOf(Scalar type) {
  switch (type) {
    case Scalar::kI8:
    case Scalar::kU8:
      return 1;
    case Scalar::kI16:
    case Scalar::kU16:
      return 2;
    case Scalar::kI32:
    case Scalar::kU32:
    case Scalar::kF32:
      return 4;
    default:
      return 8;
  }
}

bool IsFloat(Scalar type) { return type == Scalar::kF32 || type == Scalar::kF64; }

double Load(const char* bytes, Scalar type, bool swap) {
  switch (type) {
    case Scalar::kI8:
      return LoadAs<int8_t>(bytes, swap);
    case Scalar::kU8:
      return LoadAs<uint8_t>(bytes, swap);
    case Scalar::kI16:
      return LoadAs<int16_t>(bytes, swap);
    case Scalar::kU16:
      return LoadAs<uint16_t>(bytes, swap);
    case Scalar::kI32:
      return LoadAs<int32_t>(bytes, swap);
    case Scalar::kU32:
      return LoadAs<uint32_t>(bytes, swap);
    case Scalar::kI64:
      return LoadAs<int64_t>(bytes, swap);
    case Scalar::kU64:
      return LoadAs<uint64_t>(bytes, swap);
    case Scalar::kF32:
      return LoadAs<float>(bytes, swap);
    case Scalar::kF64:
      return LoadAs<double>(bytes, swap);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::optional<std::string_view> Scanner::Line() {
  if (position_ >= text_.size()) return std::nullopt;
  size_t end = text_.find('\n', position_);
  if (end == std::string_view::npos) end = text_.size();
  std::string_view line = text_.substr(position_, end - position_);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  position_ = std::min(end + 1, text_.size());
  ++line_;
  return line;
}

std::string_view Scanner::Token() {
  while (position_ < text_.size() && IsSpace(text_[position_])) {
    if (text_[position_] == '\n') ++line_;
    ++position_;
  }
  const size_t start = position_;
  while (position_ < text_.size() && !IsSpace(text_[position_])) ++position_;
  return text_.substr(start, position_ - start);
}

std::vector<std::string_view> Words(std::string_view line, std::string_view separators) {
  std::vector<std::string_view> words;
  size_t position = 0;
  while ((position = line.find_first_not_of(separators, position)) != std::string_view::npos) {
    const size_t end = std::min(line.find_first_of(separators, position), line.size());
    words.push_back(line.substr(position, end - position));
    position = end;
  }
  return words;
}

std::optional<double> ParseNumber(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (end != token.data() + token.size()) return std::nullopt;
  if (error == std::errc::result_out_of_range) return std::numeric_limits<double>::quiet_NaN();
  if (error != std::errc()) return std::nullopt;
  return value;
}

std::optional<uint64_t> ParseCount(std::string_view token) {
  uint64_t value = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (error != std::errc() || end != token.data() + token.size()) return std::nullopt;
  return value;
}

std::string Quote(std::string_view found) {
  constexpr size_t kLongest = 40;
  std::string quoted = "\"";
  for (char c : found.substr(0, kLongest)) quoted += c >= 32 && c < 127 ? c : '?';
  return quoted + (found.size() > kLongest ? "...\"" : "\"");
}

Eigen::Vector3f MakePoint(double x, double y, double z) {
  constexpr double kFarthest_m = 1e4;
  if (std::abs(x) <= kFarthest_m && std::abs(y) <= kFarthest_m && std::abs(z) <= kFarthest_m) {
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
  }
  return Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
}

uint32_t MakeLabel(double value) {
  return value >= 0 && value <= std::numeric_limits<uint32_t>::max() ? static_cast<uint32_t>(value)
                                                                     : 0;
}

}  // namespace beckon::cloud
