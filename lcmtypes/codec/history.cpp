// HISTORY: what each machine has of everybody's rows, and rows that others lack.
#include <zlib.h>

#include <beckon/history_t.hpp>

#include "lcmtypes/codec.h"
#include "lcmtypes/codec/message.h"
#include "lcmtypes/codec/parts.h"

namespace beckon {
namespace codec {

constexpr int kMaxEntries = 256;
constexpr int kMaxBody = 48 * 1024;

static void CheckRow(Rules& rules, const msg::HistoryRow& row) {
  rules.Name(row.origin, "origin")
      .Require(row.seq >= 1, "seq is below 1")
      .Time(row.hybrid_utime)
      .Name(row.kind, "kind")
      .Name(row.body, "body", kMaxBody);
}


static void Walk(Walker& w, const history_t*) {
  w.Skip(8);
  w.String("machine", kMaxName);
  w.String("run", kMaxName);
  w.Skip(1);
  const int32_t digests = w.Count("n_digests", kMaxEntries);
  for (int32_t i = 0; i < digests && w.ok(); ++i) {
    w.String("origin", kMaxName);
    w.Skip(8 + 8);
  }
  const int32_t rows = w.Count("n_rows", kMaxEntries);
  for (int32_t i = 0; i < rows && w.ok(); ++i) {
    w.String("origin", kMaxName);
    w.Skip(8 + 8);
    w.String("kind", kMaxName);
    w.String("body", kMaxBody);
    w.Skip(4);
  }
  Walk(w, static_cast<const seal_t*>(nullptr));
}

static Status Check(const msg::History& history) {
  Rules rules("history");
  rules.Time(history.utime)
      .Name(history.machine, "machine")
      .Name(history.run, "run")
      .Count(history.digests.size(), "digests", kMaxEntries)
      .Count(history.rows.size(), "rows", kMaxEntries)
      .Require(Check(history.seal));
  for (const auto& digest : history.digests) {
    rules.Name(digest.origin, "origin").Require(digest.highest_seq >= 0, "highest_seq is negative");
  }
  for (const auto& row : history.rows) CheckRow(rules, row);
  return rules;
}

int32_t Checksum(const msg::HistoryRow& row) {
  uLong crc = 0;
  const std::string seq = std::to_string(row.seq);
  const std::string time = std::to_string(row.hybrid_utime);
  // The terminating zeros keep ("ab", "c") and ("a", "bc") apart.
  for (const std::string* part : {&row.origin, &seq, &time, &row.kind, &row.body}) {
    crc = crc32_z(crc, reinterpret_cast<const Bytef*>(part->c_str()), part->size() + 1);
  }
  return static_cast<int32_t>(crc);
}

static history_t ToWire(const msg::History& history) {
  history_t wire{};
  wire.utime = history.utime;
  wire.machine = history.machine;
  wire.run = history.run;
  wire.complete = static_cast<int8_t>(history.complete);
  wire.n_digests = static_cast<int32_t>(history.digests.size());
  for (const auto& digest : history.digests) {
    history_digest_t d{};
    d.origin = digest.origin;
    d.highest_seq = digest.highest_seq;
    d.checksum = digest.checksum;
    wire.digests.push_back(d);
  }
  wire.n_rows = static_cast<int32_t>(history.rows.size());
  for (const auto& row : history.rows) {
    history_row_t r{};
    r.origin = row.origin;
    r.seq = row.seq;
    r.hybrid_utime = row.hybrid_utime;
    r.kind = row.kind;
    r.body = row.body;
    r.crc = Checksum(row);
    wire.rows.push_back(r);
  }
  wire.seal = ToWire(history.seal);
  return wire;
}

static Result<msg::History> FromWire(const history_t& wire) {
  if (!IsBool(wire.complete)) return Error{"complete is neither 0 nor 1"};
  msg::History history;
  history.utime = wire.utime;
  history.machine = wire.machine;
  history.run = wire.run;
  history.complete = wire.complete != 0;
  for (const auto& d : wire.digests)
    history.digests.push_back({d.origin, d.highest_seq, d.checksum});
  for (const auto& r : wire.rows) {
    msg::HistoryRow row{r.origin, r.seq, r.hybrid_utime, r.kind, r.body};
    Rules rules("history");
    CheckRow(rules, row);
    if (Checksum(row) == r.crc && Status(rules))
      history.rows.push_back(std::move(row));
    else
      ++history.refused_rows;  // a bad row spoils no good one
  }
  history.seal = FromWire(wire.seal);
  return history;
}

}  // namespace codec

BECKON_DEFINE_CODEC(History, history_t)

}  // namespace beckon
