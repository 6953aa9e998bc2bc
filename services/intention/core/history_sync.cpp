// What is heard: rows are taken where they follow what is there, digests are compared.
#include "services/intention/core/history_sync.h"

#include <algorithm>

namespace beckon::intention {
namespace {

constexpr Utime kMillisecond = kSecond / 1000;
/// A machine that was not heard for so long is told at once what there is.
constexpr Utime kAway = 5 * kSecond;
/// A machine that was not heard for so long is not spoken of any more.
constexpr Utime kGone = 600 * kSecond;
/// What nobody repeated for so long is not to be had any more.
constexpr Utime kStaleWant = 60 * kSecond;
/// Rows that were on the bus so recently are not sent again on a request that they crossed.
constexpr Utime kJustSent = 200 * kMillisecond;
/// Who sent an origin's rows within this goes on sending them.
constexpr Utime kStillSending = kSecond;
/// Others wait between these, for somebody else to answer.
constexpr Utime kFirstAnswer = 30 * kMillisecond;
constexpr Utime kLastAnswer = 180 * kMillisecond;
constexpr Utime kProbePeriod = 50 * kMillisecond;
constexpr int64_t kProbePoints = 16;
/// Of one origin: whatever somebody claims, the sum is a number.
constexpr int64_t kMostBehind = 1'000'000'000;

uint64_t ToChain(int64_t checksum) { return static_cast<uint64_t>(checksum); }

HistoryRow FromMessage(const msg::HistoryRow& row) {
  return {row.origin, row.seq, row.kind, row.body, row.hybrid_utime};
}

}  // namespace

HistorySync::HistorySync(HistorySource& source, HistorySyncConfig config)
    : source_(source), config_(std::move(config)), random_(config_.seed) {
  pushed_origin_ = source_.WriteOrigin();
  pushed_seq_ = HeadOf(pushed_origin_).seq;
}

std::vector<msg::History> HistorySync::OnMessage(const msg::History& message, const Instant& now) {
  if (message.run == config_.run) return {};
  const auto known = peers_.find(message.machine);
  if (known == peers_.end() || now.steady - known->second > kAway)
    next_digest_ = std::min(next_digest_, now.steady + Jitter(kLastAnswer));
  peers_[message.machine] = now.steady;
  if (message.refused_rows > 0) counters_.refused["damaged"] += message.refused_rows;

  std::map<std::string, Entries> entries;
  for (const auto& digest : message.digests)
    entries[digest.origin][digest.highest_seq] = ToChain(digest.checksum);
  TakeRows(message, entries, now);
  ReadDigests(message, entries, now);
  return Flush(now);
}

std::vector<msg::History> HistorySync::Tick(const Instant& now) {
  std::erase_if(wants_, [&](const auto& want) {
    return now.steady - want.second.told > kStaleWant || HeadOf(want.first).seq >= want.second.seq;
  });
  const auto old = [&](Utime at, Utime age) { return now.steady - at > age; };
  std::erase_if(streams_, [&](const auto& s) { return old(s.second.at, kStillSending); });
  std::erase_if(probed_, [&](const auto& p) { return old(p.second.at, kStillSending); });
  std::erase_if(peers_, [&](const auto& p) { return old(p.second, kGone); });
  return Flush(now);
}

/// Every run of rows comes with the checksum of what precedes it; one that does not continue the
/// history here is left.
void HistorySync::TakeRows(const msg::History& message,
                           const std::map<std::string, Entries>& entries, const Instant& now) {
  std::vector<HistoryRow> follow;
  for (size_t i = 0, end = 0; i < message.rows.size(); i = end) {
    const std::string& origin = message.rows[i].origin;
    for (end = i + 1; end < message.rows.size() && message.rows[end].origin == origin &&
                      message.rows[end].seq - 1 == message.rows[end - 1].seq;)
      ++end;
    const int64_t before = message.rows[i].seq - 1, last = message.rows[end - 1].seq;
    const auto claims = entries.find(origin);
    const bool founded = claims != entries.end() && claims->second.contains(before);
    if (!founded && before > 0) {
      counters_.refused["unfounded"] += static_cast<int64_t>(end - i);
      continue;
    }
    const auto answer = answers_.find(origin);
    if (answer != answers_.end() && answer->second.after >= before && answer->second.after < last)
      answers_.erase(answer);
    Stream& stream = streams_[origin];
    stream = {last, now.steady, false};
    const auto mine = source_.ChainAt(origin, before);
    if (!mine) {
      counters_.rows_early += static_cast<int64_t>(end - i);
      continue;
    }
    if (before > 0 && *mine != claims->second.at(before)) continue;  // ReadDigests settles it
    const int64_t head = HeadOf(origin).seq;
    if (last > head) LeaveIfOwn(origin, "another machine writes under this name", now);
    for (size_t k = i; k < end; ++k) {
      if (message.rows[k].seq > head)
        follow.push_back(FromMessage(message.rows[k]));
      else
        ++counters_.rows_again;
    }
  }
  if (follow.empty()) return;
  const auto taken = source_.Take(follow, now.wall);
  if (!taken) {
    Note(taken.error());
    return;
  }
  trouble_.clear();
  counters_.rows_received += taken->added;
  counters_.far_future += taken->far_future;
  for (const auto& [reason, count] : taken->refused) counters_.refused[reason] += count;
  for (const HistoryRow& row : follow) {
    const auto want = wants_.find(row.origin);
    if (want == wants_.end()) continue;
    want->second.tries = 0;
    if (HeadOf(row.origin).seq >= want->second.seq) wants_.erase(want);
  }
}

/// A message without rows is also a request.
void HistorySync::ReadDigests(const msg::History& message,
                              const std::map<std::string, Entries>& entries, const Instant& now) {
  const bool request = message.rows.empty();
  for (const auto& [origin, claims] : entries) ReadEntries(origin, claims, request, now);
  if (!request || !message.complete) return;
  for (const auto& [origin, head] : source_.Heads()) {
    if (!entries.contains(origin) && head.seq > 0) AnswerLater(origin, 0, now.steady);
  }
}

void HistorySync::ReadEntries(const std::string& origin, const Entries& entries, bool request,
                              const Instant& now) {
  const int64_t head = HeadOf(origin).seq;
  const auto [highest, checksum] = *entries.rbegin();
  const auto equal = [&](const auto& entry) {
    const auto mine = source_.ChainAt(origin, entry.first);
    return !mine || *mine == entry.second;
  };
  if (!std::all_of(entries.begin(), entries.end(), equal)) {
    Settle(origin, entries, now);
    return;
  }
  if (highest > head) {
    LeaveIfOwn(origin, "others have rows of this name that are not here", now);
    Wanted(origin, highest, !request, now.steady);
  } else if (request && highest < head) {
    AnswerLater(origin, highest, now.steady);
  }
}

/// Somebody's rows of `origin` differ from those here. Finds where by halving with probes, then
/// the side whose checksum there is the greater yields: all decide alike.
void HistorySync::Settle(const std::string& origin, const Entries& entries, const Instant& now) {
  int64_t low = 0, high = 0;
  for (const auto& [seq, checksum] : entries) {
    const auto mine = source_.ChainAt(origin, seq);
    if (!mine) break;
    if (*mine != checksum) {
      high = seq;
      break;
    }
    low = seq;
  }
  LeaveIfOwn(origin, "another machine has other rows of this name", now);
  if (high > low + 1 || *source_.ChainAt(origin, high) < entries.at(high))
    return Probe(origin, low, high, now.steady);
  ++counters_.yielded;
  if (Note(source_.Yield(origin, high, now.wall)))
    Wanted(origin, entries.rbegin()->first, true, now.steady);
}

/// Not twice as wide within a moment: every machine that knows of the fork takes part.
void HistorySync::Probe(const std::string& origin, int64_t low, int64_t high, Utime now) {
  const auto last = probed_.find(origin);
  if (last != probed_.end() && now - last->second.at < kProbePeriod &&
      high - low >= last->second.width)
    return;
  probed_[origin] = {high - low, now};
  const int64_t step = std::max<int64_t>(1, (high - low) / kProbePoints);
  for (int64_t seq = low; seq < high; seq += step) probes_.emplace_back(origin, seq);
  probes_.emplace_back(origin, high);
  probes_.emplace_back(origin, HeadOf(origin).seq);
}

void HistorySync::LeaveIfOwn(const std::string& origin, const char* reason, const Instant& now) {
  if (origin == source_.WriteOrigin()) Note(source_.LeaveOrigin(reason, now.wall));
}

/// `ask_now`: whoever said so has just ended a burst and can go on.
void HistorySync::Wanted(const std::string& origin, int64_t seq, bool ask_now, Utime now) {
  const bool fresh = !wants_.contains(origin);
  Want& want = wants_[origin];
  want.seq = std::max(want.seq, seq);
  want.told = now;
  if (fresh || ask_now) {
    want.ask_at = now;
    want.tries = 0;
  }
}

/// Who writes the origin, or is sending its rows, answers at once; the others wait whether
/// somebody does.
void HistorySync::AnswerLater(const std::string& origin, int64_t after, Utime now) {
  const auto stream = streams_.find(origin);
  const Utime since = stream == streams_.end() ? kSecond * 1000 : now - stream->second.at;
  if (since < kJustSent && after < stream->second.upto) return;
  const bool at_once =
      origin == source_.WriteOrigin() || (since < kStillSending && stream->second.mine);
  const Utime due = at_once ? now : now + kFirstAnswer + Jitter(kLastAnswer - kFirstAnswer);
  const auto [answer, added] = answers_.try_emplace(origin, Answer{after, due});
  if (added) return;
  answer->second.after = std::min(answer->second.after, after);
  answer->second.due = std::min(answer->second.due, due);
}

HistoryHead HistorySync::HeadOf(const std::string& origin) {
  const auto& heads = source_.Heads();
  const auto head = heads.find(origin);
  return head == heads.end() ? HistoryHead{} : head->second;
}

int64_t HistorySync::BehindBy() const {
  int64_t rows = 0;
  for (const auto& [origin, want] : wants_) {
    const auto& heads = source_.Heads();
    const auto head = heads.find(origin);
    const int64_t here = head == heads.end() ? 0 : head->second.seq;
    rows += std::clamp<int64_t>(want.seq - here, 0, kMostBehind);
  }
  return rows;
}

bool HistorySync::Note(const Status& status) {
  if (!status) {
    ++counters_.errors;
    trouble_ = status.error().message;
  }
  return status.ok();
}

Utime HistorySync::Jitter(Utime most) {
  return static_cast<Utime>(random_() % static_cast<uint64_t>(most));
}

}  // namespace beckon::intention
