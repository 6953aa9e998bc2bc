// Keeps LOG.index.json of a log that may still be written.
#pragma once

#include <string>

#include "services/base/result.h"
#include "tools/beckon/log_index.h"
#include "tools/beckon/log_reader.h"

namespace beckon::tool {

class LogFollower {
 public:
  static Result<LogFollower> Open(const std::string& log);

  /// Reads what is new in the log; whether there was anything.
  bool Read();
  /// Writes the index beside the log, and renames, so that nobody sees half of it.
  Status WriteIndex() const;

  const LogIndex& index() const { return indexer_.index(); }
  /// What of the log cannot be read, in words for people; empty where all is well.
  std::string Damage() const;
  std::string IndexFile() const { return log_ + ".index.json"; }

 private:
  LogFollower(std::string log, LogReader reader)
      : log_(std::move(log)), reader_(std::move(reader)) {}

  std::string log_;
  LogReader reader_;
  LogIndexer indexer_;
};

}  // namespace beckon::tool
