#include "services/intention/history_commands.h"

#include <cstdio>
#include <ctime>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "services/intention/store.h"
#include "services/intention/store_rows.h"

namespace beckon::intention {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

/// Longest line that import reads.
constexpr size_t kMaxLine = 1'000'000;

std::string LocalTime(Utime utime) {
  const std::time_t seconds = utime / kSecond;
  std::tm local{};
  char text[32] = "";
  if (localtime_r(&seconds, &local) != nullptr)
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &local);
  return text;
}

HistoryRow ParseRow(const std::string& line) {
  const json root = json::parse(line);
  return {
      root.at("origin").get<std::string>(), root.at("seq").get<int64_t>(),
      root.at("kind").get<std::string>(),
      root.at("body").is_string() ? root.at("body").get<std::string>() : root.at("body").dump()};
}

Result<std::vector<HistoryRow>> ReadRows(std::istream& in, const std::string& name) {
  std::vector<HistoryRow> rows;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const std::string place = name + ":" + std::to_string(number) + ": ";
    if (line.size() > kMaxLine) return Error{place + "the line is longer than 1 MB"};
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    try {
      HistoryRow row = ParseRow(line);
      if (const auto head = HeadOf(row.origin, row.seq, row.kind, row.body); !head) {
        return Error{place + head.error().message};
      }
      rows.push_back(std::move(row));
    } catch (const json::exception& e) {
      return Error{place + "not a row of an export: " + e.what()};
    }
  }
  return rows;
}

}  // namespace

Status PrintHistory(const HistoryOptions& options) {
  const auto store = Store::Open(options.db, "", Store::Mode::kRead);
  if (!store) return store.error();
  const auto sessions = (*store)->AllSessions();
  if (!sessions) return sessions.error();
  if (!options.json)
    std::printf("%-19s  %-16s  %-28s  %9s  %s\n", "time", "user", "task", "questions", "device");
  for (const SessionRecord& s : *sessions) {
    if (!options.user.empty() && s.user != options.user) continue;
    if (options.json) {
      std::printf("%s\n", ToBody(s).c_str());
      continue;
    }
    const std::string task = s.action + " " + s.category + " " + std::to_string(s.instance);
    std::printf("%-19s  %-16s  %-28s  %9d  %s\n", LocalTime(s.utime).c_str(), s.user.c_str(),
                task.c_str(), s.questions, s.device.c_str());
  }
  return {};
}

Status ExportHistory(const HistoryOptions& options) {
  const auto store = Store::Open(options.db, "", Store::Mode::kRead);
  if (!store) return store.error();
  const auto rows = (*store)->Rows();
  if (!rows) return rows.error();
  std::ofstream file;
  if (!options.file.empty()) {
    file.open(options.file);
    if (!file) return Error{options.file + ": cannot write the export"};
  }
  std::ostream& out = options.file.empty() ? std::cout : file;
  for (const HistoryRow& row : *rows) {
    const ordered_json line = {
        {"origin", row.origin}, {"seq", row.seq}, {"kind", row.kind}, {"body", row.body}};
    out << line.dump() << '\n';
  }
  out.flush();
  if (!out)
    return Error{options.file + ": the export could not be written to the end; is the disk full?"};
  return {};
}

Status ImportHistory(const HistoryOptions& options, const std::string& machine) {
  std::ifstream file;
  if (!options.file.empty()) {
    file.open(options.file);
    if (!file) return Error{options.file + ": cannot read the file to import"};
  }
  const std::string name = options.file.empty() ? "standard input" : options.file;
  const auto rows = ReadRows(options.file.empty() ? std::cin : file, name);
  if (!rows) return rows.error();
  const auto store = Store::Open(options.db, machine);
  if (!store) return store.error();
  const auto added = (*store)->AddRows(*rows);
  if (!added) return Error{name + ": " + added.error().message};
  std::printf("%zu rows read, %d new\n", rows->size(), *added);
  return {};
}

Status ForgetHistory(const HistoryOptions& options, const std::string& machine, Utime now) {
  if (!options.last && options.user.empty())
    return Error{"forget: expected --user NAME, --last, or both"};
  const auto store = Store::Open(options.db, machine);
  if (!store) return store.error();
  if (options.last) {
    const auto forgotten = (*store)->ForgetLast(options.user, now);
    if (!forgotten) return forgotten.error();
    std::printf("forgot: %s %s of %s, %s\n", forgotten->action.c_str(), forgotten->category.c_str(),
                forgotten->user.c_str(), LocalTime(forgotten->utime).c_str());
    return {};
  }
  const auto count = (*store)->ForgetUser(options.user, now);
  if (!count) return count.error();
  std::printf("forgot %d sessions of %s\n", *count, options.user.c_str());
  return {};
}

}  // namespace beckon::intention
