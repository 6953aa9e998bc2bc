// What the readers of cloud files share: scalars of any type in bounded bytes, and numbers in text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/base/rgbd.h"

namespace beckon::cloud {

/// Most points a file may hold.
inline constexpr uint64_t kMaxPoints = 50'000'000;

enum class Scalar { kI8, kU8, kI16, kU16, kI32, kU32, kI64, kU64, kF32, kF64 };

size_t SizeOf(Scalar type);
bool IsFloat(Scalar type);

/// The value of `SizeOf(type)` bytes, as a double; `swap` for the other byte order.
double Load(const char* bytes, Scalar type, bool swap = false);

/// Reads text token by token without copying it.
class Scanner {
 public:
  Scanner(std::string_view text, uint64_t first_line) : text_(text), line_(first_line) {}

  /// The rest of the current line without its end; nothing at the end of the text.
  std::optional<std::string_view> Line();
  /// The next token, over line ends; empty at the end of the text.
  std::string_view Token();
  uint64_t line() const { return line_; }
  size_t position() const { return position_; }

 private:
  std::string_view text_;
  size_t position_ = 0;
  uint64_t line_;
};

/// The words of a line.
std::vector<std::string_view> Words(std::string_view line, std::string_view separators = " \t\r");

/// A whole token as a number; "nan" and "inf" are numbers, as is what overflows (it becomes NaN).
std::optional<double> ParseNumber(std::string_view token);
/// A whole token as a count.
std::optional<uint64_t> ParseCount(std::string_view token);

/// A printable extract of what was found, for messages.
std::string Quote(std::string_view found);

/// A point, all NaN where a coordinate is not finite or is beyond 10 km (garbled, not measured).
Eigen::Vector3f MakePoint(double x, double y, double z);

/// A label; 0 where it is none.
uint32_t MakeLabel(double value);

}  // namespace beckon::cloud
