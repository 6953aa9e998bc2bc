// Strict TOML configuration: defaults live in each service's struct, a file over them, flags over
// that. A key nobody asked for, a wrong type or a value out of range is an error that names file
// and line.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "services/base/result.h"

namespace beckon {

/// A table of a configuration file. Copies share the record of what was read.
class ConfigTable {
 public:
  /// Reads a file; an empty path gives an empty table.
  static Result<ConfigTable> Load(const std::string& path);
  /// The same from text; `name` stands for the file in messages.
  static Result<ConfigTable> Parse(const std::string& text, const std::string& name);

  /// The sub-table [key]; empty where it is absent.
  ConfigTable Section(const std::string& key);

  /// Each replaces `value` where the key is there and right, and records an error where it is
  /// wrong.
  void Get(const std::string& key, double& value, double min = -std::numeric_limits<double>::max(),
           double max = std::numeric_limits<double>::max());
  void Get(const std::string& key, int& value, int min = std::numeric_limits<int>::min(),
           int max = std::numeric_limits<int>::max());
  void Get(const std::string& key, bool& value);
  void Get(const std::string& key, std::string& value);
  void Get(const std::string& key, std::vector<std::string>& value);
  void Get(const std::string& key, std::vector<double>& value);
  /// One of `choices`.
  void Get(const std::string& key, std::string& value, const std::vector<std::string>& choices);

  /// The keys of this table, for tables whose keys are data (they count as read once asked for).
  std::vector<std::string> Keys() const;
  bool Has(const std::string& key) const;

  /// Records an error of the caller's own about a key.
  void Fail(const std::string& key, const std::string& what);

  /// The first error of the whole file: a wrong value, else a key that nobody read (with the
  /// nearest known key as a suggestion). Call once, after all sections were read.
  Status Finish() const;

 private:
  struct File;
  ConfigTable(std::shared_ptr<File> file, std::string path)
      : file_(std::move(file)), path_(std::move(path)) {}

  std::shared_ptr<File> file_;
  std::string path_;  // dotted, of this table; empty at the root
};

}  // namespace beckon
