// The database's schema and its steps from version to version.
#pragma once

#include <string>

#include "services/base/result.h"

namespace SQLite {
class Database;
class Exception;
}  // namespace SQLite

namespace beckon::intention {

/// PRAGMA user_version of a database of this program.
inline constexpr int kSchemaVersion = 4;
/// PRAGMA application_id: "BCKN".
inline constexpr int kApplicationId = 0x42434B4E;

/// What an SQLite error means for a person, naming the file.
Error Explain(const SQLite::Exception& error, const std::string& path);

/// What leads from version 3 to 4: rows that can be shared (store_schema_4.cpp).
extern const char* const kSchemaStep4;

/// Makes row_hash(origin, seq, hybrid_utime, kind, body), as RowHash, known to SQL.
void AddFunctions(SQLite::Database& database);

/// Brings a database to kSchemaVersion, a transaction a step. Fails on newer versions and on
/// databases of other programs, which stay untouched.
Status Migrate(SQLite::Database& database, const std::string& path);

/// The same checks without changing anything.
Status CheckVersion(SQLite::Database& database, const std::string& path);

}  // namespace beckon::intention
