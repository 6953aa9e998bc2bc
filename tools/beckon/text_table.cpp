#include "tools/beckon/text_table.h"

#include <algorithm>
#include <cstdint>

namespace beckon::tool {
namespace {

/// Bytes of the valid UTF-8 character at `at`; 0 where there is none.
size_t CharacterBytes(const std::string& text, size_t at) {
  const auto lead = static_cast<uint8_t>(text[at]);
  const size_t n = lead < 0x80                   ? 1
                   : lead >= 0xc2 && lead < 0xe0 ? 2
                   : lead >= 0xe0 && lead < 0xf0 ? 3
                   : lead >= 0xf0 && lead < 0xf5 ? 4
                                                 : 0;
  if (n == 0 || at + n > text.size()) return 0;
  for (size_t i = 1; i < n; ++i) {
    if ((static_cast<uint8_t>(text[at + i]) & 0xc0) != 0x80) return 0;
  }
  return n;
}

/// C0, DEL and C1.
bool Steers(const std::string& text, size_t at) {
  const auto byte = static_cast<uint8_t>(text[at]);
  if (byte < 0x20 || byte == 0x7f) return true;
  return byte == 0xc2 && static_cast<uint8_t>(text[at + 1]) < 0xa0;
}

/// The first `width` characters.
std::string Head(const std::string& text, size_t width) {
  size_t end = 0;
  for (; width > 0 && end < text.size(); --width)
    end += std::max<size_t>(CharacterBytes(text, end), 1);
  return text.substr(0, end);
}

}  // namespace

std::string Printable(const std::string& text) {
  std::string clean;
  for (size_t at = 0; at < text.size();) {
    const size_t n = CharacterBytes(text, at);
    clean += n == 0 || Steers(text, at) ? "?" : text.substr(at, n);
    at += std::max<size_t>(n, 1);
  }
  return clean;
}

size_t TextWidth(const std::string& text) {
  return static_cast<size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<uint8_t>(c) & 0xc0) != 0x80; }));
}

std::string Fit(const std::string& text, size_t width, bool right) {
  const size_t has = TextWidth(text);
  if (has > width) return width == 0 ? "" : Head(text, width - 1) + "…";
  const std::string blanks(width - has, ' ');
  return right ? blanks + text : text + blanks;
}

void TextTable::Add(std::vector<std::string> row) {
  row.resize(columns_.size());
  for (auto& cell : row) cell = Printable(cell);
  rows_.push_back(std::move(row));
}

std::string TextTable::Render() const {
  std::vector<std::string> titles;
  for (const auto& column : columns_) titles.push_back(column.title);
  std::vector<size_t> widths;
  for (size_t c = 0; c < columns_.size(); ++c) {
    size_t width = TextWidth(titles[c]);
    for (const auto& row : rows_) width = std::max(width, TextWidth(row[c]));
    widths.push_back(width);
  }
  const auto line = [&](const std::vector<std::string>& row) {
    std::string text;
    for (size_t c = 0; c < row.size(); ++c)
      text += (c == 0 ? "" : "  ") + Fit(row[c], widths[c], columns_[c].right);
    return text.substr(0, text.find_last_not_of(' ') + 1) + "\n";
  };
  std::string text = line(titles);
  for (const auto& row : rows_) text += line(row);
  return rows_.empty() ? text + "(none)\n" : text;
}

}  // namespace beckon::tool
