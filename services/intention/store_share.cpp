// What the store offers to the sharing of histories, and what it takes from it.
#include <SQLiteCpp/SQLiteCpp.h>

#include <algorithm>

#include "services/intention/store.h"
#include "services/intention/store_rows.h"
#include "services/intention/store_try.h"

namespace beckon::intention {
namespace {

/// As lcmtypes/codec/history.cpp takes them; what no message can carry must not get in.
constexpr size_t kMostName = 64;

bool IsText(const std::string& text, size_t most) {
  return !text.empty() && text.size() <= most &&
         std::none_of(text.begin(), text.end(),
                      [](unsigned char c) { return (c < 0x20 && c != '\n') || c == 0x7f; });
}

std::string NameOf(const HistoryRow& row) {
  return "row " + std::to_string(row.seq) + " of '" + row.origin + "'";
}

}  // namespace

const std::map<std::string, HistoryHead>& Store::Heads() {
  if (!heads_known_) {
    const Status read = Try<void>([&]() -> Status {
      ReadHeads();
      return {};
    });
    heads_known_ = read.ok();
  }
  return heads_;
}

std::optional<uint64_t> Store::ChainAt(const std::string& origin, int64_t seq) {
  if (seq == 0) return 0;
  Heads();
  const auto chain = chains_.find(origin);
  if (chain == chains_.end() || seq < 0 || seq > static_cast<int64_t>(chain->second.size()))
    return {};
  return chain->second[static_cast<size_t>(seq - 1)];
}

void Store::ReadHeads() {
  heads_.clear();
  chains_.clear();
  data_version_ = database_->execAndGet("PRAGMA data_version").getInt64();
  SQLite::Statement query(*database_, "SELECT origin, seq, hash FROM rows ORDER BY origin, seq");
  while (query.executeStep()) {
    const std::string origin = query.getColumn(0).getString();
    auto& chain = chains_[origin];
    if (query.getColumn(1).getInt64() != static_cast<int64_t>(chain.size()) + 1) continue;  // a gap
    chain.push_back(ExtendChain(chain.empty() ? 0 : chain.back(),
                                static_cast<uint64_t>(query.getColumn(2).getInt64())));
    heads_[origin] = {static_cast<int64_t>(chain.size()), chain.back()};
  }
}

/// After rows of an origin were added. Never fails what was committed already.
void Store::Advance(const std::string& origin) {
  if (!heads_known_) return;
  heads_known_ = Try<void>([&]() -> Status {
                   Extend(origin);
                   return {};
                 }).ok();
}

void Store::Extend(const std::string& origin) {
  auto& chain = chains_[origin];
  auto& query = Prepared("SELECT seq, hash FROM rows WHERE origin = ? AND seq > ? ORDER BY seq");
  query.bind(1, origin);
  query.bind(2, static_cast<int64_t>(chain.size()));
  while (query.executeStep() &&
         query.getColumn(0).getInt64() == static_cast<int64_t>(chain.size()) + 1) {
    chain.push_back(ExtendChain(chain.empty() ? 0 : chain.back(),
                                static_cast<uint64_t>(query.getColumn(1).getInt64())));
  }
  query.reset();
  if (!chain.empty()) heads_[origin] = {static_cast<int64_t>(chain.size()), chain.back()};
}

Status Store::Refresh() {
  return Try<void>([&]() -> Status {
    if (!heads_known_) return {};
    const int64_t version = database_->execAndGet("PRAGMA data_version").getInt64();
    if (version == data_version_) return {};
    data_version_ = version;
    SQLite::Statement query(*database_, "SELECT DISTINCT origin FROM rows");
    std::vector<std::string> origins;
    while (query.executeStep()) origins.push_back(query.getColumn(0).getString());
    for (const std::string& origin : origins) Advance(origin);
    return {};
  });
}

Result<std::vector<HistoryRow>> Store::RowsAfter(const std::string& origin, int64_t seq,
                                                 size_t max_rows, size_t max_bytes) {
  return Try<std::vector<HistoryRow>>([&]() -> Result<std::vector<HistoryRow>> {
    auto& query = Prepared(
        "SELECT origin, seq, kind, body, hybrid_utime FROM rows WHERE origin = ? AND seq > ? "
        "ORDER BY seq");
    query.bind(1, origin);
    query.bind(2, seq);
    std::vector<HistoryRow> rows;
    size_t bytes = 0;
    while (rows.size() < max_rows && query.executeStep()) {
      HistoryRow row = RowFrom(query);
      bytes += row.body.size();
      const bool follows = row.seq == seq + static_cast<int64_t>(rows.size()) + 1;
      if (!follows || (!rows.empty() && bytes > max_bytes)) break;
      rows.push_back(std::move(row));
    }
    query.reset();
    return rows;
  });
}

std::string Store::TakeOne(const HistoryRow& row, Utime now) {
  if (!IsText(row.origin, kMostName) || !IsText(row.kind, kMostName) || row.hybrid_utime < 1)
    return "name";
  if (!IsText(row.body, kMostBody)) return "body";
  const auto head = HeadOf(row);
  if (!head) return "body";
  const std::string origin = row.origin;
  if (row.seq != NextSeq(origin)) {
    auto& query = Prepared("SELECT hash FROM rows WHERE origin = ? AND seq = ?");
    query.bind(1, origin);
    query.bind(2, row.seq);
    const bool there = query.executeStep();
    const bool same = there && static_cast<uint64_t>(query.getColumn(0).getInt64()) == head->hash;
    query.reset();
    if (there) return same ? "" : "contradiction";
  }
  AddForeign(row, *head, now);
  return "";
}

Result<TakenRows> Store::Take(const std::vector<HistoryRow>& rows, Utime now) {
  auto result = Try<TakenRows>([&]() -> Result<TakenRows> {
    TakenRows taken;
    SQLite::Transaction transaction(*database_, kImmediate);
    std::map<std::string, int64_t> next;  // of each origin
    for (const HistoryRow& row : rows) {
      const auto head = Heads().find(row.origin);
      auto& expected = next.try_emplace(row.origin, head == heads_.end() ? 1 : head->second.seq + 1)
                           .first->second;
      if (row.seq != expected) continue;  // it follows one that was refused
      if (const std::string reason = TakeOne(row, now); !reason.empty()) {
        ++taken.refused[reason];
        continue;
      }
      ++expected;
      ++taken.added;
      if (row.hybrid_utime > now + kMostAhead) ++taken.far_future;
    }
    transaction.commit();
    for (const auto& [origin, seq] : next) Advance(origin);
    Advance(origin_);  // echoes
    return taken;
  });
  Scrub();
  return result;
}

/// An unchanged copy under the next number of this machine, unless another origin has the row.
void Store::MoveRow(const HistoryRow& row, const RowHead& head) {
  auto& elsewhere = Prepared(
      "SELECT 1 FROM rows WHERE uid = ? AND origin <> ? AND (kind = ? OR kind = 'erased')");
  elsewhere.bind(1, head.uid);
  elsewhere.bind(2, row.origin);
  elsewhere.bind(3, row.kind);
  const bool kept = elsewhere.executeStep();
  elsewhere.reset();
  if (!kept) {
    HistoryRow copy = row;
    RowHead copy_head = head;
    copy.origin = origin_;
    copy.seq = NextSeq(origin_);
    if (row.kind != "session" && row.kind != "label" && row.kind != kErased)
      copy.body = WithUid(row.body, head.uid);
    if (row.kind != kErased) copy_head.hash = RowHash(copy);
    InsertRow(copy, copy_head);
  }
  auto& remove = Prepared("DELETE FROM rows WHERE origin = ? AND seq = ?");
  remove.bind(1, row.origin);
  remove.bind(2, row.seq);
  remove.exec();
  remove.reset();
}

Status Store::Yield(const std::string& origin, int64_t seq, Utime) {
  if (origin == origin_) return Error{"cannot yield the origin that is written to"};
  return Try<void>([&]() -> Status {
    SQLite::Transaction transaction(*database_, kImmediate);
    std::vector<HistoryRow> rows;
    {
      SQLite::Statement query(*database_,
                              "SELECT origin, seq, kind, body, hybrid_utime FROM rows "
                              "WHERE origin = ? AND seq >= ? ORDER BY seq");
      query.bind(1, origin);
      query.bind(2, seq);
      while (query.executeStep()) rows.push_back(RowFrom(query));
    }
    for (const HistoryRow& row : rows) {
      const auto head = HeadOf(row);
      if (!head) return Error{path_ + ": " + NameOf(row) + ": " + head.error().message};
      MoveRow(row, *head);
    }
    transaction.commit();
    chains_[origin].resize(static_cast<size_t>(
        std::min<int64_t>(seq - 1, static_cast<int64_t>(chains_[origin].size()))));
    if (chains_[origin].empty())
      heads_.erase(origin);
    else
      heads_[origin] = {static_cast<int64_t>(chains_[origin].size()), chains_[origin].back()};
    Advance(origin_);
    return {};
  });
}

Result<int> Store::AddRows(const std::vector<HistoryRow>& rows, Utime now) {
  auto result = Try<int>([&]() -> Result<int> {
    SQLite::Transaction transaction(*database_, kImmediate);
    int added = 0;
    for (const HistoryRow& given : rows) {
      const std::string name = NameOf(given);
      if (!IsText(given.origin, kMostName) || given.seq < 1 || !IsText(given.kind, kMostName))
        return Error{name + ": origin, seq or kind is empty or too long"};
      const auto head = HeadOf(given);
      if (!head) return Error{name + ": " + head.error().message};
      if (!IsText(given.body, kMostBody))
        return Error{name + ": the body is too long or has control characters"};
      auto& query = Prepared("SELECT hash, kind FROM rows WHERE origin = ? AND seq = ?");
      query.bind(1, given.origin);
      query.bind(2, given.seq);
      if (query.executeStep()) {
        const bool same = static_cast<uint64_t>(query.getColumn(0).getInt64()) == head->hash;
        query.reset();
        if (same) continue;
        return Error{name +
                     ": another row of that number is in the database; two machines share a name"};
      }
      AddForeign(Timed(given, *head), *head, now);
      ++added;
    }
    transaction.commit();
    heads_known_ = false;
    return added;
  });
  Scrub();
  return result;
}

}  // namespace beckon::intention
