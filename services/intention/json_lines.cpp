#include "services/intention/json_lines.h"

#include <set>
#include <vector>

namespace beckon::intention {
namespace {

using nlohmann::json;

/// Parses; throws json's exceptions, or what is wrong in words.
json ParseStrictly(const std::string& text) {
  std::vector<std::set<std::string>> keys;  // by depth, of the objects that are open
  return json::parse(text, [&](int depth, json::parse_event_t event, json& parsed) {
    using Event = json::parse_event_t;
    if (depth > JsonLines::kMaxDepth)
      throw "nests deeper than " + std::to_string(JsonLines::kMaxDepth) + " levels";
    if (event == Event::object_start) keys.emplace_back();
    if (event == Event::object_end) keys.pop_back();
    if (event == Event::key) {
      const auto& key = parsed.get_ref<const std::string&>();
      if (!keys.back().insert(key).second) throw "the key '" + Plain(key) + "' is there twice";
    }
    return true;
  });
}

}  // namespace

std::string Plain(const std::string& message) {
  constexpr size_t kLongest = 200;
  const bool prefixed = message.starts_with("[json.exception");
  const size_t start = prefixed ? message.find("] ") + 2 : 0;
  std::string plain;
  for (const char c : message.substr(start, kLongest)) plain += c >= ' ' && c < 127 ? c : '?';
  if (message.size() - start > kLongest) plain += " ...";
  return plain;
}

Error JsonLines::At(const std::string& what) const {
  return Error{name_ + ":" + std::to_string(number_) + ": " + what};
}

bool JsonLines::ReadLine() {
  using Traits = std::istream::traits_type;
  text_.clear();
  length_ = 0;
  std::streambuf* bytes = in_.rdbuf();
  int byte = bytes->sbumpc();
  if (byte == Traits::eof()) return false;
  for (; byte != Traits::eof() && byte != '\n'; byte = bytes->sbumpc()) {
    if (++length_ <= kMaxLine) text_ += Traits::to_char_type(byte);
  }
  ++number_;
  if (number_ == 1 && text_.starts_with("\xEF\xBB\xBF")) text_.erase(0, 3);
  if (text_.ends_with('\r')) text_.pop_back();
  return true;
}

Result<std::optional<json>> JsonLines::Next() {
  do {
    if (!ReadLine()) return std::optional<json>();
  } while (text_.find_first_not_of(" \t") == std::string::npos);
  if (length_ > kMaxLine) {
    return At("the line has " + std::to_string(length_) + " bytes, expected at most " +
              std::to_string(kMaxLine));
  }
  try {
    json root = ParseStrictly(text_);
    if (!root.is_object())
      return At(std::string("expected a JSON object, found ") + root.type_name());
    return std::optional(std::move(root));
  } catch (const std::string& what) {
    return At(what);
  } catch (const json::exception& e) {
    return At("not a JSON object: " + Plain(e.what()));
  }
}

}  // namespace beckon::intention
