#include "tools/beckon/top_view.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <set>

#include "tools/beckon/text_table.h"

namespace beckon::tool {
namespace {

constexpr char kTitle[] = "\x1b[1m", kFaint[] = "\x1b[2m", kWarn[] = "\x1b[33m",
               kBad[] = "\x1b[31m", kStopped[] = "\x1b[1;37;41m", kPlain[] = "\x1b[0m";

std::string Format(const char* format, double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

template <typename T, typename Words>
std::string OrDash(const std::optional<T>& value, Words words) {
  return value ? words(*value) : "-";
}

std::string OneDecimal(double value) {
  return value < 100 ? Format("%.1f", value) : ShortCount(static_cast<int64_t>(value));
}

/// 0 is nothing to look at.
std::string Rate(double value) { return value > 0 ? OneDecimal(value) : "0"; }

std::string Number(int64_t n) { return std::to_string(n); }

struct Column {
  const char* title;
  size_t width;
  std::string (*cell)(const TopRow&);
};

// 79 characters with a blank between two.
const std::array kColumns{
    Column{"UP", 6, [](const TopRow& r) { return ShortTime(r.uptime_s * kSecond); }},
    Column{"CPU%", 4, [](const TopRow& r) { return OrDash(r.cpu_percent, Number); }},
    Column{"MEM", 5,
           [](const TopRow& r) {
             return OrDash(r.rss_kb, [](int64_t kb) { return ShortCount(kb * 1024); });
           }},
    Column{"IN/s", 5, [](const TopRow& r) { return OrDash(r.in_per_s, ShortCount); }},
    Column{"OUT/s", 5, [](const TopRow& r) { return OrDash(r.out_per_s, ShortCount); }},
    Column{"FPS", 5, [](const TopRow& r) { return OrDash(r.frames_per_s, OneDecimal); }},
    Column{"DROP/s", 6, [](const TopRow& r) { return OrDash(r.drops_per_s, Rate); }},
    Column{"AGE", 6, [](const TopRow& r) { return OrDash(r.age_us, ShortTime); }},
    Column{"REF/s", 5, [](const TopRow& r) { return Rate(r.refused_per_s); }}};
constexpr size_t kServiceWidth = 12, kHostWidth = 10;

/// Draws lines that fit.
class Canvas {
 public:
  explicit Canvas(const TopScreen& screen) : screen_(screen) {}

  void Line(const std::string& text, const char* style = "") {
    std::string line = Printable(text);
    if (TextWidth(line) > screen_.columns) line = Fit(line, screen_.columns);
    line.resize(line.find_last_not_of(' ') + 1);
    if (screen_.colour && *style != '\0' && !line.empty()) line = style + line + kPlain;
    lines_.push_back(std::move(line));
  }
  std::vector<std::string> Take() { return std::move(lines_); }

 private:
  const TopScreen& screen_;
  std::vector<std::string> lines_;
};

std::string Titles() {
  std::string line = Fit("SERVICE", kServiceWidth) + " " + Fit("HOST", kHostWidth);
  for (const auto& column : kColumns) line += " " + Fit(column.title, column.width, true);
  return line;
}

std::string RowText(const TopRow& row) {
  std::string line =
      Fit(Printable(row.service), kServiceWidth) + " " + Fit(Printable(row.host), kHostWidth);
  if (row.silent) return line + "  silent for " + ShortTime(row.heard_us);
  for (const auto& column : kColumns) line += " " + Fit(column.cell(row), column.width, true);
  return line;
}

const char* RowStyle(const TopRow& row) {
  if (row.silent) return kBad;
  return row.refused_per_s > 0 || row.drops_per_s.value_or(0) > 0 ? kWarn : "";
}

/// "  showing table.pcd; refused 3 stale (0.5/s), 1 malformed"
std::string SecondLine(const TopRow& row) {
  std::string text = "  " + row.state;
  for (size_t i = 0; i < row.refused.size(); ++i) {
    const auto& refused = row.refused[i];
    text += (i == 0 ? "; refused " : ", ") + ShortCount(refused.total) + " " + refused.reason;
    if (refused.per_s > 0) text += " (" + OneDecimal(refused.per_s) + "/s)";
  }
  return text;
}

std::string Summary(const std::vector<TopRow>& rows, const TopScreen& screen) {
  std::set<std::string> hosts;
  int64_t silent = 0, messages = 0;
  for (const auto& row : rows) {
    hosts.insert(row.host);
    silent += row.silent;
    if (!row.silent) messages += row.out_per_s.value_or(0);
  }
  return "beckon top  " + screen.clock + "  " + std::to_string(rows.size()) + " processes" +
         (silent > 0 ? ", " + std::to_string(silent) + " silent" : "") + ", " +
         std::to_string(hosts.size()) + (hosts.size() == 1 ? " host, " : " hosts, ") +
         ShortCount(messages) + " messages/s sent";
}

std::string TalkText(const TopTalk& talk) {
  std::string text = talk.user + ": ";
  if (talk.state == "asked") {
    text += "question " + std::to_string(talk.questions + 1) + " (" + talk.kind + ") \"" +
            talk.text + "\"";
  } else {
    text += talk.state + (talk.text.empty() ? "" : ": " + talk.text);
  }
  return text + ", " + (talk.silent ? "nothing heard since " : "for ") + ShortTime(talk.since_us);
}

void DrawTalks(const TopTalks& talks, Canvas& canvas) {
  if (talks.stopped) canvas.Line(" STOPPED: nothing moves until a front end resumes ", kStopped);
  for (const auto& talk : talks.talks) canvas.Line(TalkText(talk), talk.silent ? kBad : "");
  if (talks.last_task) {
    const TopTask& task = *talks.last_task;
    canvas.Line("last task: " + task.task + " for " + task.user + ", " + task.state + ", " +
                ShortTime(task.since_us) + " ago");
  }
}

}  // namespace

std::string ShortTime(Utime us) {
  const auto seconds = static_cast<double>(us) / kSecond;
  if (seconds < 0.01) return Format("%.1fms", seconds * 1e3);
  if (seconds < 1) return Format("%.0fms", seconds * 1e3);
  if (seconds < 100) return Format("%.1fs", seconds);
  if (seconds < 6000) return Format("%.0fmin", seconds / 60);
  if (seconds < 360'000) return Format("%.1fh", seconds / 3600);
  return Format("%.0fd", seconds / 86'400);
}

std::string ShortCount(int64_t n) {
  const char* kUnits[] = {"", "k", "M", "G", "T", "P", "E"};
  auto value = static_cast<double>(n);
  size_t unit = 0;
  while (value >= 999.5 && unit + 1 < std::size(kUnits)) {
    value /= 1000;
    ++unit;
  }
  return Format(unit > 0 && value < 9.95 ? "%.1f" : "%.0f", value) + kUnits[unit];
}

std::vector<std::string> DrawTop(const std::vector<TopRow>& rows, const TopTalks& talks,
                                 const TopScreen& screen) {
  Canvas below_canvas(screen);
  DrawTalks(talks, below_canvas);
  std::vector<std::string> below = below_canvas.Take();
  // Title, heads, a blank line before the conversations.
  const size_t around = 2 + (below.empty() ? 0 : 1 + below.size());
  const size_t room = screen.rows == 0           ? SIZE_MAX
                      : screen.rows > around + 1 ? screen.rows - around
                                                 : 1;
  const bool with_states = 2 * rows.size() <= room;
  const size_t shown = rows.size() <= room ? rows.size() : room - 1;

  Canvas canvas(screen);
  canvas.Line(Summary(rows, screen), kTitle);
  canvas.Line(Titles(), kFaint);
  for (size_t i = 0; i < shown; ++i) {
    canvas.Line(RowText(rows[i]), RowStyle(rows[i]));
    if (with_states) canvas.Line(SecondLine(rows[i]), kFaint);
  }
  if (shown < rows.size())
    canvas.Line("  and " + std::to_string(rows.size() - shown) + " more, on a taller terminal");
  std::vector<std::string> lines = canvas.Take();
  if (!below.empty()) lines.emplace_back();
  lines.insert(lines.end(), below.begin(), below.end());
  if (screen.rows > 0 && lines.size() > screen.rows) lines.resize(screen.rows);
  return lines;
}

}  // namespace beckon::tool
