// Under which name this machine writes: its own, until somebody else is found to use it too.
#include <SQLiteCpp/SQLiteCpp.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <random>

#include "services/intention/store.h"
#include "services/intention/store_try.h"

namespace beckon::intention {
namespace {

/// A checksum of the computer's own id; empty where it has none (containers).
std::string HostId() {
  std::ifstream file("/etc/machine-id");
  std::string id;
  if (!std::getline(file, id) || id.empty()) return "";
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%08lx",
                crc32_z(0, reinterpret_cast<const Bytef*>(id.data()), id.size()));
  return text.data();
}

/// "kitchen~3f0a": nobody else's, in all likelihood.
std::string NewName(const std::string& machine) {
  constexpr size_t kLongest = 59;  // with the ending 64, as messages take it
  std::array<char, 8> ending{};
  std::snprintf(ending.data(), ending.size(), "~%04x", std::random_device()() & 0xffffu);
  return machine.substr(0, std::min(machine.find('~'), kLongest)) + ending.data();
}

}  // namespace

void Store::ReadIdentity() {
  SQLite::Transaction transaction(*database_, kImmediate);
  const std::string host = HostId();
  std::string last_host;
  {
    SQLite::Statement query(*database_,
                            "SELECT host, origin, reason FROM identities WHERE machine = ? "
                            "ORDER BY rowid DESC LIMIT 1");
    query.bind(1, machine_);
    if (query.executeStep()) {
      last_host = query.getColumn(0).getString();
      origin_ = query.getColumn(1).getString();
      origin_reason_ = query.getColumn(2).getString();
      if (host.empty() || last_host == host) return;
    }
  }
  if (!last_host.empty())
    WriteIdentity(NewName(machine_), "the database was copied from another computer");
  else
    WriteIdentity(origin_, origin_reason_);
  transaction.commit();
}

void Store::WriteIdentity(const std::string& origin, const std::string& reason) {
  SQLite::Statement insert(
      *database_, "INSERT INTO identities (machine, host, origin, reason) VALUES (?, ?, ?, ?)");
  insert.bind(1, machine_);
  insert.bind(2, HostId());
  insert.bind(3, origin);
  insert.bind(4, reason);
  insert.exec();
  origin_ = origin;
  origin_reason_ = reason;
}

Status Store::LeaveOrigin(const std::string& reason, Utime) {
  return Try<void>([&]() -> Status {
    WriteIdentity(NewName(machine_), reason);
    return {};
  });
}

}  // namespace beckon::intention
