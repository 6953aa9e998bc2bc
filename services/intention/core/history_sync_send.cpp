// What is sent: rows that others lack in bounded bursts, requests for what is wanted, digests.
#include <algorithm>

#include "services/intention/core/history_sync.h"

namespace beckon::intention {
namespace {

constexpr size_t kMostRows = 256;
constexpr size_t kMostDigests = 256;
constexpr size_t kMostOrigins = 32;  // in one burst
/// Encoded: a message's fixed fields with its seal; what a row and a digest need beside their
/// texts.
constexpr size_t kMessageBytes = 400;
constexpr size_t kRowBytes = 40;
constexpr size_t kDigestBytes = 24;
/// A request that nothing answered is repeated after this, twice this, ...
constexpr Utime kRetry = 300'000;
constexpr int kMostTries = 4;
/// So many new rows of one's own are sent without being asked for.
constexpr int64_t kMostPushed = 256;

size_t Bytes(const HistoryRow& row) {
  return kRowBytes + row.origin.size() + row.kind.size() + row.body.size();
}

msg::HistoryRow ToMessage(HistoryRow row) {
  return {std::move(row.origin), row.seq, row.hybrid_utime, std::move(row.kind),
          std::move(row.body)};
}

}  // namespace

std::vector<msg::History> HistorySync::Flush(const Instant& now) {
  std::vector<msg::History> out;
  PushOwn(now.steady);
  SendAnswers(out, now);
  SendRequest(out, now);
  if (!probes_.empty()) {
    msg::History probe = Message(now);
    for (const auto& [origin, seq] : probes_) {
      if (probe.digests.size() < kMostDigests) AddEntry(probe, origin, seq);
    }
    probes_.clear();
    out.push_back(std::move(probe));
  }
  if (now.steady >= next_digest_) SendDigest(out, now);
  return out;
}

/// What this machine wrote since the last time goes out at once.
void HistorySync::PushOwn(Utime now) {
  const std::string origin = source_.WriteOrigin();
  if (origin != pushed_origin_) {
    pushed_origin_ = origin;
    pushed_seq_ = 0;
  }
  const int64_t head = HeadOf(origin).seq;
  if (head <= pushed_seq_) return;
  if (head - pushed_seq_ <= kMostPushed)
    answers_.try_emplace(origin, Answer{pushed_seq_, now}).first->second.due = now;
  else
    next_digest_ = now;
  pushed_seq_ = head;
}

/// The rows that are due, in messages of which the last says how much more there is: on hearing
/// that, whoever still lacks rows asks for the next burst.
void HistorySync::SendAnswers(std::vector<msg::History>& out, const Instant& now) {
  Burst burst;
  std::vector<std::string> origins;
  for (auto next = answers_.begin(); next != answers_.end();) {
    if (origins.size() == kMostOrigins) break;  // the others with the next tick
    if (next->second.due > now.steady) {
      ++next;
      continue;
    }
    origins.push_back(next->first);
    for (int64_t after = next->second.after; after < HeadOf(next->first).seq;) {
      const int64_t added = AddRows(burst, next->first, after, now);
      if (added == 0) break;
      after += added;
    }
    next = answers_.erase(next);
  }
  if (burst.messages.empty()) return;
  for (const std::string& origin : origins)
    AddEntry(burst.messages.back(), origin, HeadOf(origin).seq);
  std::move(burst.messages.begin(), burst.messages.end(), std::back_inserter(out));
}

/// Into the last message of the burst, or another where that is full; how many. None: the burst
/// has all it may have, or the rows cannot be read.
int64_t HistorySync::AddRows(Burst& burst, const std::string& origin, int64_t after,
                             const Instant& now) {
  const auto place = [&] { return burst.messages.empty() ? 0 : burst.messages.back().rows.size(); };
  const size_t entry = kDigestBytes + origin.size();
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (burst.messages.empty() || attempt == 1 || place() >= kMostRows) {
      if (static_cast<int>(burst.messages.size()) == config_.burst_messages) return 0;
      burst.messages.push_back(Message(now));
      burst.room = config_.message_bytes - kMessageBytes;
    }
    const auto rows = source_.RowsAfter(origin, after, kMostRows - place(), burst.room);
    if (!rows) {
      Note(rows.error());
      return 0;
    }
    size_t taken = 0, bytes = entry;
    while (taken < rows->size()) {
      const size_t more = bytes + Bytes((*rows)[taken]);
      if (more > burst.room && (taken > 0 || place() > 0)) break;
      bytes = more;
      ++taken;
    }
    if (taken == 0) continue;  // in the next message
    burst.room -= std::min(burst.room, bytes);
    msg::History& message = burst.messages.back();
    AddEntry(message, origin, after);
    for (size_t i = 0; i < taken; ++i) message.rows.push_back(ToMessage((*rows)[i]));
    counters_.rows_sent += static_cast<int64_t>(taken);
    streams_[origin] = {after + static_cast<int64_t>(taken), now.steady, true};
    return static_cast<int64_t>(taken);
  }
  return 0;
}

/// A digest of the origins of which rows are wanted.
void HistorySync::SendRequest(std::vector<msg::History>& out, const Instant& now) {
  msg::History request = Message(now);
  for (auto& [origin, want] : wants_) {
    if (want.ask_at > now.steady || want.tries > kMostTries) continue;
    if (request.digests.size() == kMostDigests) break;
    const HistoryHead head = HeadOf(origin);
    if (head.seq >= want.seq) continue;
    AddEntry(request, origin, head.seq);
    want.ask_at = now.steady + (kRetry << want.tries);
    ++want.tries;
  }
  if (!request.digests.empty()) out.push_back(std::move(request));
}

/// All origins where one message names them, else the next ones in turn.
void HistorySync::SendDigest(std::vector<msg::History>& out, const Instant& now) {
  const auto& heads = source_.Heads();
  msg::History digest = Message(now);
  digest.complete = heads.size() <= kMostDigests;
  auto next = digest.complete ? heads.begin() : heads.upper_bound(digest_cursor_);
  size_t bytes = kMessageBytes;
  for (size_t i = 0; i < std::min(heads.size(), kMostDigests); ++i, ++next) {
    if (next == heads.end()) next = heads.begin();
    AddEntry(digest, next->first, next->second.seq);
    bytes += kDigestBytes + next->first.size();
    digest_cursor_ = next->first;
  }
  out.push_back(std::move(digest));
  const auto fair = static_cast<Utime>(static_cast<double>(bytes) / config_.quiet_bytes_per_s *
                                       static_cast<double>(kSecond));
  const Utime period = std::max(config_.digest_period, fair);
  next_digest_ = now.steady + period - period / 8 + Jitter(period / 4);
}

msg::History HistorySync::Message(const Instant& now) {
  msg::History message;
  message.utime = now.wall;
  message.machine = source_.WriteOrigin();
  message.run = config_.run;
  message.complete = false;
  return message;
}

void HistorySync::AddEntry(msg::History& message, const std::string& origin, int64_t seq) {
  if (const auto chain = source_.ChainAt(origin, seq))
    message.digests.push_back({origin, seq, static_cast<int64_t>(*chain)});
}

}  // namespace beckon::intention
