#include "services/intention/history_commands.h"

#include <cstdio>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "services/intention/history_text.h"
#include "services/intention/json_lines.h"
#include "services/intention/store.h"
#include "services/intention/store_rows.h"

namespace beckon::intention {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

Result<HistoryRow> ParseRow(const json& line) {
  try {
    HistoryRow row;
    line.at("origin").get_to(row.origin);
    const json& seq = line.at("seq");
    if (!seq.is_number_integer() || seq < 1)
      return Error{"'seq' must be a whole number from 1, found " + Plain(seq.dump())};
    seq.get_to(row.seq);
    line.at("kind").get_to(row.kind);
    const json& body = line.at("body");
    row.body = body.is_string() ? body.get<std::string>() : body.dump();
    if (row.origin.empty() || row.kind.empty()) return Error{"'origin' or 'kind' is empty"};
    if (line.contains("hybrid_utime")) {
      const json& time = line.at("hybrid_utime");
      if (!time.is_number_integer() || time < 1)
        return Error{"'hybrid_utime' must be a whole number from 1, found " + Plain(time.dump())};
      time.get_to(row.hybrid_utime);
    }
    if (const auto head = HeadOf(row); !head)
      return Error{"not a " + Plain(row.kind) + ": " + Plain(head.error().message)};
    return row;
  } catch (const json::exception& e) {
    return Error{"not a row of an export: " + Plain(e.what())};
  }
}

Result<std::vector<HistoryRow>> ReadRows(std::istream& in, const std::string& name) {
  std::vector<HistoryRow> rows;
  JsonLines lines(in, name);
  for (;;) {
    const auto line = lines.Next();
    if (!line) return line.error();
    if (!*line) return rows;
    auto row = ParseRow(**line);
    if (!row) return lines.At(row.error().message);
    rows.push_back(*std::move(row));
  }
}

}  // namespace

Status PrintHistory(const HistoryOptions& options) {
  const auto store = Store::Open(options.db, "", Store::Mode::kRead);
  if (!store) return store.error();
  auto sessions = (*store)->AllSessions();
  if (!sessions) return sessions.error();
  if (!options.user.empty())
    std::erase_if(*sessions, [&](const SessionRecord& s) { return s.user != options.user; });
  if (!options.json) {
    const auto origins = (*store)->Origins();
    if (!origins) return origins.error();
    std::fputs((HistoryText(*sessions) + OriginsText(*origins)).c_str(), stdout);
    return {};
  }
  for (const SessionRecord& s : *sessions) std::printf("%s\n", ToBody(s).c_str());
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
    const ordered_json line = {{"origin", row.origin},
                               {"seq", row.seq},
                               {"hybrid_utime", row.hybrid_utime},
                               {"kind", row.kind},
                               {"body", row.body}};
    out << line.dump() << '\n';
  }
  out.flush();
  if (!out)
    return Error{options.file + ": the export could not be written to the end; is the disk full?"};
  return {};
}

Status ImportHistory(const HistoryOptions& options, const std::string& machine, Utime now) {
  std::ifstream file;
  if (!options.file.empty()) {
    file.open(options.file, std::ios::binary);
    if (!file) return Error{options.file + ": cannot read the file to import"};
  }
  const std::string name = options.file.empty() ? "standard input" : options.file;
  const auto rows = ReadRows(options.file.empty() ? std::cin : file, name);
  if (!rows) return rows.error();
  const auto store = Store::Open(options.db, machine);
  if (!store) return store.error();
  const auto added = (*store)->AddRows(*rows, now);
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
  std::printf("forgot %d session%s of %s\n", *count, *count == 1 ? "" : "s", options.user.c_str());
  return {};
}

}  // namespace beckon::intention
