// The commands for people: history, export, import, forget.
#pragma once

#include <string>

#include "services/base/result.h"
#include "services/base/utime.h"

namespace beckon::intention {

struct HistoryOptions {
  std::string db;
  std::string user;  // empty: everybody
  std::string file;  // of export and import; empty: standard output, standard input
  bool json = false;
  bool last = false;
};

/// Prints the sessions as a table with a summary a user, or with `json` as a line each; then where
/// the rows came from.
Status PrintHistory(const HistoryOptions& options);
/// Writes every row as a JSON line: {"origin", "seq", "hybrid_utime", "kind",
/// "body"}.
Status ExportHistory(const HistoryOptions& options);
/// Adds the rows that are not there yet (set union); all or none, in one transaction. Fails with
/// file and line.
Status ImportHistory(const HistoryOptions& options, const std::string& machine, Utime now = 0);
/// Forgets a user, or the last session.
Status ForgetHistory(const HistoryOptions& options, const std::string& machine, Utime now);

}  // namespace beckon::intention
