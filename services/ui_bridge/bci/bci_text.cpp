#include "services/ui_bridge/bci/bci_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace beckon::ui_bridge::bci {
namespace {

constexpr size_t kWidest = 36;  // characters of a cell
constexpr size_t kNarrowest = 8;
constexpr size_t kPage = 110;

bool BeginsCharacter(char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }

size_t Characters(const std::string& text) {
  return static_cast<size_t>(std::count_if(text.begin(), text.end(), BeginsCharacter));
}

/// Cut or padded to `width` characters (of UTF-8, none of them cut through).
std::string Fitted(const std::string& text, size_t width) {
  if (Characters(text) <= width) return text + std::string(width - Characters(text), ' ');
  std::string cut;
  size_t left = width;
  for (const char c : text) {
    if (BeginsCharacter(c) && left-- == 0) break;
    cut += c;
  }
  return cut;
}

size_t WidthOf(const Layout& layout) {
  size_t longest = kNarrowest;
  for (const auto& label : layout.labels) longest = std::max(longest, Characters(label));
  const size_t fits = kPage / static_cast<size_t>(layout.columns);
  return std::max<size_t>(4, std::min({longest, kWidest, fits > 3 ? fits - 3 : 1}));
}

/// One line a row of the matrix; `cell` makes what stands in a class.
template <typename Cell>
std::string Row(const Layout& layout, int row, size_t width, Cell cell) {
  std::string line = " ";
  for (int column = 0; column < layout.columns; ++column) {
    const auto place = static_cast<size_t>(row * layout.columns + column);
    line += " " + Fitted(cell(place), width) + " |";
  }
  return line.substr(0, line.size() - 2) + "\n";
}

std::string Bar(double p, size_t width) {
  const auto filled = static_cast<size_t>(std::lround(std::clamp(p, 0.0, 1.0) * width));
  return std::string(filled, '#') + std::string(width - filled, '.');
}

}  // namespace

std::string RenderAsked(const std::string& text, const Layout& layout) {
  std::string shown = text.empty() ? "" : "\n" + text + "\n";
  const size_t width = WidthOf(layout);
  for (int row = 0; row < layout.rows; ++row)
    shown += Row(layout, row, width, [&](size_t i) { return layout.labels[i]; });
  return shown;
}

std::string RenderPosterior(const Layout& layout, const std::vector<double>& posterior,
                            int repetitions) {
  std::string shown =
      "  after " + std::to_string(repetitions) + (repetitions == 1 ? " trial\n" : " trials\n");
  const size_t width = WidthOf(layout);
  for (int row = 0; row < layout.rows; ++row) {
    shown += Row(layout, row, width, [&](size_t i) { return layout.labels[i]; });
    shown += Row(layout, row, width, [&](size_t i) {
      return layout.labels[i].empty() ? std::string() : Bar(posterior[i], width);
    });
  }
  return shown;
}

std::string RenderAnswer(const msg::Query& query, const std::vector<double>& likelihoods) {
  const auto best = std::max_element(likelihoods.begin(), likelihoods.end());
  char share[16];
  std::snprintf(share, sizeof share, "%.0f %%", 100 * *best);
  return "  = " + query.options[static_cast<size_t>(best - likelihoods.begin())].text + " (" +
         share + ")\n";
}

std::string RenderEvent(const msg::Session& event) {
  using Kind = msg::SessionKind;
  switch (event.kind) {
    case Kind::kBegun:
      return event.text.empty() ? "" : event.text + "\n";
    case Kind::kConfirmed:
      return "\n" + event.text + "\n";
    case Kind::kAbandoned:
      return "\nNo task: " + event.text + "\n";
    case Kind::kStopped:
      return "\nSTOPPED. Nothing moves until somebody says to go on.\n";
    default:
      return "";
  }
}

std::string RenderKeys() {
  return "Keys for a carer, each with Enter: s stop, r go on after a stop, u undo, p pause, Enter "
         "another task, q quit.\n";
}

Key ParseKey(const std::string& line) {
  static const std::array<std::pair<const char*, Key>, 12> kKeys = {{{"s", Key::kStop},
                                                                     {"stop", Key::kStop},
                                                                     {"r", Key::kResume},
                                                                     {"resume", Key::kResume},
                                                                     {"u", Key::kUndo},
                                                                     {"undo", Key::kUndo},
                                                                     {"p", Key::kPause},
                                                                     {"pause", Key::kPause},
                                                                     {"n", Key::kNew},
                                                                     {"", Key::kNew},
                                                                     {"q", Key::kQuit},
                                                                     {"quit", Key::kQuit}}};
  std::string word;
  for (const char c : line) {
    if (c == ' ' || c == '\t' || c == '\r') continue;
    word += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  for (const auto& [name, key] : kKeys)
    if (word == name) return key;
  return Key::kUnknown;
}

}  // namespace beckon::ui_bridge::bci
