// Reads text files that hold a JSON object a line, strictly and in bounded memory.
#pragma once

#include <istream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "services/base/result.h"

namespace beckon::intention {

/// Blank lines are skipped; a byte order mark, CRLF and a last line without an end are all right.
/// An error names file and line.
class JsonLines {
 public:
  static constexpr size_t kMaxLine = 1'000'000;  // bytes
  static constexpr int kMaxDepth = 32;

  /// `name` stands for `in` in messages.
  JsonLines(std::istream& in, std::string name) : in_(in), name_(std::move(name)) {}

  /// The next object, or nothing at the end. Fails on a line that is too long, is not JSON, is no
  /// object, nests too deeply or has a key twice.
  Result<std::optional<nlohmann::json>> Next();
  /// The line of the last object.
  const std::string& text() const { return text_; }
  /// "file:line: what".
  Error At(const std::string& what) const;

 private:
  bool ReadLine();

  std::istream& in_;
  const std::string name_;
  int number_ = 0;
  std::string text_;
  size_t length_ = 0;  // of the line in the file; text_ holds at most kMaxLine of it
};

/// One of the library's messages as one short printable line.
std::string Plain(const std::string& message);

}  // namespace beckon::intention
