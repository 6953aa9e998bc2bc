#include "services/intention/store_recovery.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "services/intention/store_rows.h"
#include "services/intention/store_try.h"

namespace beckon::intention {
namespace {

namespace fs = std::filesystem;

/// Whether the file was an SQLite database; a person's other file is never put aside.
bool WasDatabase(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string magic(15, '\0');
  file.read(magic.data(), static_cast<std::streamsize>(magic.size()));
  return magic == "SQLite format 3" || fs::path(path).extension() == ".db";
}

bool IsDamaged(const std::string& path) {
  std::error_code failed;
  if (!fs::is_regular_file(path, failed) || !WasDatabase(path)) return false;
  try {
    SQLite::Database database(path, SQLite::OPEN_READWRITE, Store::kBusyMs);
    if (!CheckVersion(database, path)) return false;
    return database.execAndGet("PRAGMA quick_check(1)").getString() != "ok";
  } catch (const SQLite::Exception& e) {
    return e.getErrorCode() == SQLITE_CORRUPT || e.getErrorCode() == SQLITE_NOTADB;
  }
}

/// With its write-ahead log. Returns the new name.
Result<std::string> PutAside(const std::string& path, Utime now) {
  std::string aside = path + ".damaged-" + std::to_string(now);
  std::error_code failed;
  fs::rename(path, aside, failed);
  if (failed) return Error{path + ": cannot be put aside: " + failed.message()};
  for (const char* with : {"-wal", "-shm"}) {
    if (fs::exists(path + with)) fs::rename(path + with, aside + with, failed);
  }
  return aside;
}

/// Reads in one direction until something cannot be read.
void ReadSound(SQLite::Database& damaged, const char* sql, std::set<int64_t>& seen,
               std::vector<HistoryRow>& rows) {
  try {
    SQLite::Statement query(damaged, sql);
    while (query.executeStep()) {
      HistoryRow row = RowFrom(query);
      const auto head = HeadOf(row);
      const bool sound = head && head->hash == static_cast<uint64_t>(query.getColumn(5).getInt64());
      if (sound && seen.insert(query.getColumn(6).getInt64()).second)
        rows.push_back(std::move(row));
    }
  } catch (const SQLite::Exception&) {  // as far as it goes
  }
}

std::vector<HistoryRow> SoundRows(const std::string& path) {
  std::vector<HistoryRow> rows;
  try {
    SQLite::Database damaged(path, SQLite::OPEN_READWRITE, Store::kBusyMs);
    std::set<int64_t> seen;
    ReadSound(damaged,
              "SELECT origin, seq, kind, body, hybrid_utime, hash, rowid FROM rows NOT INDEXED "
              "ORDER BY rowid",
              seen, rows);
    ReadSound(damaged,
              "SELECT origin, seq, kind, body, hybrid_utime, hash, rowid FROM rows NOT INDEXED "
              "ORDER BY rowid DESC",
              seen, rows);
  } catch (const SQLite::Exception&) {  // not one
  }
  return rows;
}

bool WasStopped(const std::string& path) {
  try {
    SQLite::Database damaged(path, SQLite::OPEN_READWRITE, Store::kBusyMs);
    SQLite::Statement query(damaged, "SELECT stopped FROM stops ORDER BY rowid DESC LIMIT 1");
    return query.executeStep() && query.getColumn(0).getInt() != 0;
  } catch (const SQLite::Exception&) {
    return true;
  }
}

}  // namespace

Result<OpenedStore> OpenOrReplace(const std::string& path, const std::string& machine, Utime now) {
  auto opened = Store::Open(path, machine);
  if (opened) return OpenedStore{*std::move(opened), ""};
  if (!IsDamaged(path)) return opened.error();
  const auto aside = PutAside(path, now);
  if (!aside) return aside.error();
  auto fresh = Store::Open(path, machine);
  if (!fresh) return fresh.error();
  Store& store = **fresh;
  if (Status left = store.LeaveOrigin("its database was damaged", now); !left) return left.error();
  if (Status set = store.SetStopped(WasStopped(*aside), now); !set) return set.error();
  // One by one: what is wrong with one row must not cost the others.
  int saved = 0;
  const auto rows = SoundRows(*aside);
  if (const auto all = store.AddRows(rows, now)) {
    saved = *all;
  } else {
    for (const HistoryRow& row : rows) {
      if (const auto one = store.AddRows({row}, now)) saved += *one;
    }
  }
  return OpenedStore{*std::move(fresh), "the database was damaged: it is kept as " + *aside + ", " +
                                            std::to_string(saved) +
                                            " rows were saved, other machines send the rest"};
}

}  // namespace beckon::intention
