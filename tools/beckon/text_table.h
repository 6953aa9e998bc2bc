// Columns of text that line up.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace beckon::tool {

/// As it may go to a terminal: what would steer it is replaced by '?', what is no UTF-8 too.
std::string Printable(const std::string& text);

/// Characters (code points) of UTF-8.
size_t TextWidth(const std::string& text);

/// `text` in exactly `width` characters: cut with '…', or filled up with blanks, on the left where
/// `right` is set.
std::string Fit(const std::string& text, size_t width, bool right = false);

class TextTable {
 public:
  struct Column {
    std::string title;
    bool right = true;  // numbers; false: words
  };

  explicit TextTable(std::vector<Column> columns) : columns_(std::move(columns)) {}
  /// One cell a column.
  void Add(std::vector<std::string> row);
  /// Title, then rows, each as wide as its widest cell; "(none)" without rows.
  std::string Render() const;

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace beckon::tool
