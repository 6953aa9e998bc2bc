#include "services/intention/history_text.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <map>

namespace beckon::intention {
namespace {

constexpr size_t kTen = 10;
constexpr size_t kPlotWidth = 30;

/// Mean of questions[from..to).
double Mean(const std::vector<int>& questions, size_t from, size_t to) {
  double sum = 0;
  for (size_t i = from; i < to; ++i) sum += questions[i];
  return to > from ? sum / static_cast<double>(to - from) : 0;
}

/// Questions over the sessions, as bars of one character; several sessions share one where there
/// are many.
std::string Plot(const std::vector<int>& questions) {
  static constexpr std::array kBars = {"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  const size_t width = std::min(questions.size(), kPlotWidth);
  std::vector<double> means(width);
  for (size_t i = 0; i < width; ++i) {
    means[i] = Mean(questions, i * questions.size() / width, (i + 1) * questions.size() / width);
  }
  const double most = std::max(1.0, *std::max_element(means.begin(), means.end()));
  std::string plot;
  for (const double mean : means) {
    const auto bar = static_cast<size_t>(std::max(0.0, mean / most * (kBars.size() - 1) + 0.5));
    plot += kBars[std::min(bar, kBars.size() - 1)];
  }
  return plot;
}

std::string Line(const char* format, const std::string& user, const std::vector<int>& questions) {
  const size_t n = questions.size(), ten = std::min(kTen, n);
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), format, user.c_str(), n, Mean(questions, 0, ten),
                Mean(questions, n - ten, n));
  return text.data() + Plot(questions) + "\n";
}

}  // namespace

std::string LocalTime(Utime utime) {
  const std::time_t seconds = utime / kSecond;
  std::tm local{};
  std::array<char, 32> text{};
  if (localtime_r(&seconds, &local) != nullptr)
    std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S", &local);
  return text.data();
}

std::string HistoryText(const std::vector<SessionRecord>& sessions) {
  if (sessions.empty()) return "no sessions\n";
  std::array<char, 300> line{};
  const auto add = [&](const std::string& time, const std::string& user, const std::string& task,
                       const std::string& questions, const std::string& device) {
    std::snprintf(line.data(), line.size(), "%-19s  %-16s  %-28s  %9s  %s\n", time.c_str(),
                  user.c_str(), task.c_str(), questions.c_str(), device.c_str());
    return std::string(line.data());
  };
  std::string text = add("time", "user", "task", "questions", "device");
  std::map<std::string, std::vector<int>> by_user;
  for (const SessionRecord& s : sessions) {
    text += add(LocalTime(s.utime), s.user,
                s.action + " " + s.category + " " + std::to_string(s.instance),
                std::to_string(s.questions), s.device);
    by_user[s.user].push_back(s.questions);
  }
  text += "\nmean questions    sessions  first 10  last 10  over time\n";
  for (const auto& [user, questions] : by_user)
    text += Line("%-16s  %8zu  %8.1f  %7.1f  ", user, questions);
  return text;
}

std::string OriginsText(const std::vector<OriginSummary>& origins) {
  if (origins.empty()) return "";
  std::string text = "\nwritten by            rows  sessions  forgotten  last\n";
  std::array<char, 300> line{};
  for (const OriginSummary& o : origins) {
    std::snprintf(line.data(), line.size(), "%-20s  %4lld  %8lld  %9lld  %s\n", o.origin.c_str(),
                  static_cast<long long>(o.rows), static_cast<long long>(o.sessions),
                  static_cast<long long>(o.erased), LocalTime(o.last_utime).c_str());
    text += line.data();
  }
  return text;
}

}  // namespace beckon::intention
