#include "tools/beckon/log_index_text.h"

#include <array>
#include <cstdio>
#include <ctime>
#include <nlohmann/json.hpp>

#include "tools/beckon/text_table.h"

namespace beckon::tool {
namespace {

using nlohmann::ordered_json;

std::string LocalTime(Utime utime) {
  const std::time_t seconds = utime / kSecond;
  std::tm local{};
  std::array<char, 32> text{};
  if (localtime_r(&seconds, &local) == nullptr) return "?";
  return {text.data(), std::strftime(text.data(), text.size(), "%F %T", &local)};
}

std::string Seconds(Utime us) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%.1f", static_cast<double>(us) / kSecond);
  return text.data();
}

std::string Outcome(const LoggedSession& session) {
  return session.detail.empty() ? session.outcome : session.outcome + ", " + session.detail;
}

TextTable Sessions(const LogIndex& index) {
  TextTable table({{"N"},
                   {"SESSION", false},
                   {"USER", false},
                   {"BEGIN", false},
                   {"AT s"},
                   {"LASTS s"},
                   {"QUESTIONS"},
                   {"TASK", false},
                   {"OUTCOME", false}});
  for (const auto& s : index.sessions) {
    table.Add({std::to_string(s.number), s.id.substr(0, 8), s.user, LocalTime(s.begin),
               Seconds(s.begin - index.begin), Seconds(s.end - s.begin),
               std::to_string(s.questions), s.task, Outcome(s)});
  }
  return table;
}

TextTable Processes(const LogIndex& index) {
  TextTable table(
      {{"HOST", false}, {"SERVICE", false}, {"PID"}, {"BUILD", false}, {"FROM s"}, {"TO s"}});
  for (const auto& [key, process] : index.processes) {
    const auto& [host, service, pid] = key;
    table.Add({host, service, std::to_string(pid), process.build,
               Seconds(process.first - index.begin), Seconds(process.last - index.begin)});
  }
  return table;
}

TextTable Channels(const LogIndex& index) {
  TextTable table({{"CHANNEL", false}, {"MESSAGES"}, {"BYTES"}});
  for (const auto& [name, channel] : index.channels)
    table.Add({name, std::to_string(channel.messages), std::to_string(channel.bytes)});
  return table;
}

}  // namespace

std::string RenderIndex(const LogIndex& index) {
  if (index.messages == 0) return "no messages\n";
  return LocalTime(index.begin) + ", " + Seconds(index.end - index.begin) + " s, " +
         std::to_string(index.messages) + " messages, " + std::to_string(index.bytes) +
         " bytes\n\n" + Sessions(index).Render() + "\n" + Processes(index).Render() + "\n" +
         Channels(index).Render();
}

std::string IndexJson(const LogIndex& index, const std::string& log) {
  ordered_json json{{"log", log},
                    {"log_bytes", index.bytes},
                    {"begin_utime", index.begin},
                    {"end_utime", index.end},
                    {"messages", index.messages},
                    {"unreadable", index.refused}};
  json["sessions"] = ordered_json::array();
  for (const auto& s : index.sessions) {
    json["sessions"].push_back({{"session", s.number},
                                {"id", s.id},
                                {"user", s.user},
                                {"begin_utime", s.begin},
                                {"end_utime", s.end},
                                {"offset", s.offset},
                                {"end_offset", s.end_offset},
                                {"questions", s.questions},
                                {"outcome", s.outcome},
                                {"task", s.task},
                                {"detail", s.detail}});
  }
  json["processes"] = ordered_json::array();
  for (const auto& [key, process] : index.processes) {
    const auto& [host, service, pid] = key;
    json["processes"].push_back({{"host", host},
                                 {"service", service},
                                 {"pid", pid},
                                 {"build", process.build},
                                 {"first_utime", process.first},
                                 {"last_utime", process.last}});
  }
  json["channels"] = ordered_json::object();
  for (const auto& [name, channel] : index.channels)
    json["channels"][name] = {{"messages", channel.messages}, {"bytes", channel.bytes}};
  // Channels are named by whoever is on the bus, in whatever bytes.
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace beckon::tool
