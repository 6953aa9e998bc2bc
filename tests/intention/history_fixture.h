// A history in a list, and machines that share theirs over a network that tests may cut, delay,
// double and lose on.
#pragma once

#include <map>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "services/intention/core/history_sync.h"

namespace beckon::intention {

/// Bodies are the rows' ids here.
class ListHistory : public HistorySource {
 public:
  explicit ListHistory(std::string origin) : origin_(std::move(origin)) {}

  void Write(const std::string& body, Utime now) {
    latest_ = std::max(now, latest_ + 1);
    Append({origin_, Seq(origin_) + 1, "note", body, latest_});
  }
  std::set<std::string> Bodies() const {
    std::set<std::string> bodies;
    for (const auto& [origin, rows] : rows_) {
      for (const HistoryRow& row : rows) bodies.insert(row.body);
    }
    return bodies;
  }

  const std::map<std::string, HistoryHead>& Heads() override { return heads_; }
  std::optional<uint64_t> ChainAt(const std::string& origin, int64_t seq) override {
    if (seq == 0) return 0;
    const auto chain = chains_.find(origin);
    if (chain == chains_.end() || seq > static_cast<int64_t>(chain->second.size())) return {};
    return chain->second[static_cast<size_t>(seq - 1)];
  }
  Result<std::vector<HistoryRow>> RowsAfter(const std::string& origin, int64_t seq, size_t max_rows,
                                            size_t max_bytes) override {
    std::vector<HistoryRow> found;
    size_t bytes = 0;
    for (auto i = static_cast<size_t>(seq); i < rows_[origin].size() && found.size() < max_rows;
         ++i) {
      bytes += rows_[origin][i].body.size();
      if (!found.empty() && bytes > max_bytes) break;
      found.push_back(rows_[origin][i]);
    }
    return found;
  }
  Result<TakenRows> Take(const std::vector<HistoryRow>& rows, Utime) override {
    TakenRows taken;
    for (const HistoryRow& row : rows) {
      if (row.seq != Seq(row.origin) + 1) continue;
      if (row.body == refused) {
        ++taken.refused["body"];
        continue;
      }
      latest_ = std::max(latest_, row.hybrid_utime);
      Append(row);
      ++taken.added;
    }
    return taken;
  }
  std::string WriteOrigin() override { return origin_; }
  Status LeaveOrigin(const std::string&, Utime) override {
    origin_ = origin_.substr(0, origin_.find('~')) + "~" + std::to_string(++names_taken);
    return {};
  }
  Status Yield(const std::string& origin, int64_t seq, Utime) override {
    auto& rows = rows_[origin];
    const std::vector<HistoryRow> moved(rows.begin() + seq - 1, rows.end());
    rows.resize(static_cast<size_t>(seq - 1));
    auto& chain = chains_[origin];
    chain.resize(rows.size());
    if (rows.empty())
      heads_.erase(origin);
    else
      heads_[origin] = {seq - 1, chain.back()};
    for (HistoryRow row : moved) {
      row.origin = origin_;
      row.seq = Seq(origin_) + 1;
      Append(row);
    }
    return {};
  }

  std::string refused;  // a body that cannot be taken
  static inline int names_taken = 0;

 private:
  int64_t Seq(const std::string& origin) const {
    const auto head = heads_.find(origin);
    return head == heads_.end() ? 0 : head->second.seq;
  }
  void Append(const HistoryRow& row) {
    auto& chain = chains_[row.origin];
    rows_[row.origin].push_back(row);
    chain.push_back(ExtendChain(chain.empty() ? 0 : chain.back(), RowHash(row)));
    heads_[row.origin] = {row.seq, chain.back()};
  }

  std::string origin_;
  Utime latest_ = 0;
  std::map<std::string, std::vector<HistoryRow>> rows_;
  std::map<std::string, std::vector<uint64_t>> chains_;
  std::map<std::string, HistoryHead> heads_;
};

/// Encoded size, without the constant parts of LCM's framing.
inline size_t BytesOf(const msg::History& message) {
  size_t bytes = 180 + message.machine.size() + message.run.size();
  for (const auto& d : message.digests) bytes += 21 + d.origin.size();
  for (const auto& r : message.rows) bytes += 35 + r.origin.size() + r.kind.size() + r.body.size();
  return bytes;
}

/// Machines on one multicast network, in steps of 10 ms.
class HistoryNetwork {
 public:
  static constexpr Utime kStep = 10'000;
  struct Machine {
    HistorySource* source = nullptr;
    std::unique_ptr<HistorySync> sync;
    Utime skew = 0;
    int island = 0;
    int64_t bytes_sent = 0;
    size_t largest = 0;
    int64_t messages = 0;
  };

  explicit HistoryNetwork(uint64_t seed) : random(seed) {}

  Machine& Add(HistorySource& source, Utime skew = 0) {
    machines.push_back({});
    Machine& machine = machines.back();
    machine.source = &source;
    machine.skew = skew;
    Restart(machine);
    return machine;
  }
  void Restart(Machine& machine) {
    HistorySyncConfig config;
    config.run = "run" + std::to_string(++runs_);
    config.seed = random();
    machine.sync = std::make_unique<HistorySync>(*machine.source, config);
  }
  Utime WallOf(const Machine& machine) const { return kEpoch + now + machine.skew; }

  void Run(Utime duration) {
    for (const Utime end = now + duration; now < end; now += kStep) Step();
  }
  /// How long it takes until all machines agree; at most `limit`.
  Utime RunUntilEqual(Utime limit) {
    const Utime begin = now;
    while (now - begin < limit && !Equal()) {
      Step();
      now += kStep;
    }
    return now - begin;
  }
  bool Equal() const {
    for (const Machine& machine : machines) {
      if (machine.source->Heads() != machines.front().source->Heads()) return false;
    }
    return true;
  }
  bool Draw(double probability) {
    return std::uniform_real_distribution<>(0, 1)(random) < probability;
  }

  double loss = 0, doubling = 0;
  Utime delay = 0;  // most; each message its own, so they overtake each other
  Utime now = 0;
  std::mt19937_64 random;
  std::vector<Machine> machines;

 private:
  static constexpr Utime kEpoch = 1'800'000'000 * kSecond;
  struct Flight {
    size_t to;
    std::shared_ptr<const msg::History> message;
  };

  void Step() {
    const auto arrived = in_flight_.upper_bound(now);
    std::vector<Flight> due;
    for (auto i = in_flight_.begin(); i != arrived; ++i) due.push_back(i->second);
    in_flight_.erase(in_flight_.begin(), arrived);
    for (const Flight& flight : due) {
      Machine& to = machines[flight.to];
      Send(flight.to, to.sync->OnMessage(*flight.message, {now, WallOf(to)}));
    }
    for (size_t i = 0; i < machines.size(); ++i)
      Send(i, machines[i].sync->Tick({now, WallOf(machines[i])}));
  }
  void Send(size_t from, std::vector<msg::History> messages) {
    for (msg::History& message : messages) {
      const size_t bytes = BytesOf(message);
      machines[from].bytes_sent += static_cast<int64_t>(bytes);
      machines[from].largest = std::max(machines[from].largest, bytes);
      ++machines[from].messages;
      const auto shared = std::make_shared<const msg::History>(std::move(message));
      for (size_t to = 0; to < machines.size(); ++to) {
        if (to == from || machines[to].island != machines[from].island) continue;
        for (int copies = Draw(doubling) ? 2 : 1; copies > 0; --copies) {
          if (Draw(loss)) continue;
          const Utime late =
              delay == 0 ? 0 : static_cast<Utime>(random() % static_cast<uint64_t>(delay));
          in_flight_.emplace(now + 1 + late, Flight{to, shared});
        }
      }
    }
  }

  int runs_ = 0;
  std::multimap<Utime, Flight> in_flight_;
};

}  // namespace beckon::intention
