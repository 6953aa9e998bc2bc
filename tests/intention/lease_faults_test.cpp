// Two to five services share a user over a network that loses, doubles, delays and falls apart, and
// are killed and stand still: never two leaders for long, never a user without one for long.
#include <gtest/gtest.h>

#include <memory>
#include <optional>

#include "services/intention/core/lease.h"
#include "tests/intention/unreliable_network.h"

namespace beckon::intention {
namespace {

constexpr int kSeeds = 400;
constexpr Utime kLasts = 120 * kSecond;
constexpr char kUser[] = "ann";
constexpr Utime kStartPeriod = kSecond / 2;
constexpr Utime kTick = kSecond / 20;
const LeaseConfig kLease;

class Simulation {
 public:
  Simulation(uint64_t seed, size_t nodes, double loss)
      : net_(nodes + 1, seed, loss), nodes_(nodes), loss_(loss), front_end_(nodes) {
    for (size_t i = 0; i < nodes; ++i) Begin(i);
    both_.assign(nodes * nodes, 0);
  }

  void Run() {
    const Utime end = net_.now() + kLasts;
    while (net_.now() < end && !testing::Test::HasFailure()) Step();
    Calm();
  }
  int64_t changes_of_hands() const { return changes_; }

 private:
  /// What a service does with its leases, without the conversation.
  struct Node {
    std::unique_ptr<Leases> leases;
    Utime offset = 0;  // of its clock
    Utime tick_at = 0;
    Utime session_ends = 0;
    bool was_reachable = false;
  };

  Utime ClockOf(size_t i) const { return net_.now() + nodes_[i].offset; }
  bool Holds(size_t i) const { return net_.Awake(i) && nodes_[i].leases->Holds(kUser, ClockOf(i)); }

  void Begin(size_t i) {
    Node& node = nodes_[i];
    node = {};
    node.offset = static_cast<Utime>(net_.Below(1000)) * kSecond;
    const LeaseHolder self{"machine" + std::to_string(i), std::to_string(net_.Below(1'000'000))};
    node.leases = std::make_unique<Leases>(self, ClockOf(i));
  }

  void HearNews(size_t i) {
    Node& node = nodes_[i];
    for (auto news = node.leases->Taken(); !news.empty(); news = node.leases->Taken()) {
      for (const LeaseNews& one : news) {
        if (const auto* lease = std::get_if<msg::Lease>(&one)) {
          net_.Send(i, [this, lease = *lease](size_t to) { Deliver(lease, to); });
        } else if (std::holds_alternative<LeaseWon>(one)) {
          ++changes_;
          node.session_ends =
              net_.now() + kSecond / 2 + static_cast<Utime>(net_.Below(8 * kSecond));
        } else if (const auto* orphan = std::get_if<LeaseOrphaned>(&one)) {
          node.leases->Claim(kUser, orphan->session_id, net_.Below(2) == 0, ClockOf(i));
        }
      }
    }
  }

  void Deliver(const msg::Lease& lease, size_t to) {
    if (to == front_end_) return;
    nodes_[to].leases->Tick(ClockOf(to));
    EXPECT_TRUE(nodes_[to].leases->OnLease(lease, ClockOf(to)));
    HearNews(to);
  }

  void Request() {
    net_.Send(front_end_, [this](size_t to) {
      if (to == front_end_) return;
      nodes_[to].leases->Tick(ClockOf(to));
      nodes_[to].leases->Claim(kUser, "s", net_.Below(2) == 0, ClockOf(to));
      HearNews(to);
    });
  }

  void Disturb() {
    const size_t i = net_.Below(nodes_.size());
    switch (net_.Below(6)) {
      case 0:
        if (net_.Alive(i)) net_.Kill(i);
        break;
      case 1:
      case 2:
        if (net_.Alive(i)) return;
        net_.Revive(i);
        Begin(i);
        break;
      case 3:
        net_.Pause(i, static_cast<Utime>(net_.Below(6 * kSecond)));
        break;
      case 4:
        for (size_t k = 0; k <= front_end_; ++k) net_.Move(k, static_cast<int>(net_.Below(2)));
        break;
      default:
        for (size_t k = 0; k <= front_end_; ++k) net_.Move(k, 0);
    }
    disturbed_ = net_.now();
  }

  void Step() {
    if (net_.now() >= disturb_at_) {
      Disturb();
      disturb_at_ = net_.now() + kSecond / 5 + static_cast<Utime>(net_.Below(12 * kSecond));
    }
    Live();
    CheckLeaders();
    CheckServed();
  }

  void Live() {
    net_.Step();
    if (net_.now() % kStartPeriod == 0) Request();
    for (size_t i = 0; i < nodes_.size(); ++i) {
      Node& node = nodes_[i];
      if (!net_.Awake(i) || net_.now() < node.tick_at) continue;
      node.tick_at = net_.now() + kTick;
      node.leases->Tick(ClockOf(i));
      HearNews(i);
      if (Holds(i) && net_.now() >= node.session_ends) {
        node.leases->GiveBack(kUser, ClockOf(i));
        HearNews(i);
      }
    }
  }

  /// The messages that may all be lost before one arrives take `repeat` each.
  Utime Lost(Utime repeat) const {
    return loss_ > 0 ? UnreliableNetwork::kMostLostInARow * repeat : 0;
  }

  /// Two that hear each other hear of each other's leases within a repetition.
  void CheckLeaders() {
    const Utime most = kLease.repeat + Lost(kLease.repeat) + kLease.claim_window +
                       2 * UnreliableNetwork::kMostDelay + 2 * kTick;
    for (size_t a = 0; a < nodes_.size(); ++a) {
      for (size_t b = 0; b < a; ++b) {
        Utime& since = both_[a * nodes_.size() + b];
        if (!Holds(a) || !Holds(b) || !net_.Connected(a, b)) {
          since = net_.now();
        } else {
          EXPECT_LE(net_.now() - since, most) << a << " and " << b << " both lead";
        }
      }
    }
  }

  bool IsServed() const {
    bool reachable = false;
    for (size_t i = 0; i < nodes_.size(); ++i) {
      if (!net_.Connected(i, front_end_)) continue;
      if (Holds(i)) return true;
      reachable = reachable || net_.Awake(i);
    }
    return !reachable;
  }

  /// Also by a service that stood still, and took what it heard before for the newest.
  void CheckServed() {
    const bool resumes = std::exchange(all_awake_, AllAwake()) != all_awake_;
    if (resumes) disturbed_ = net_.now();
    if (IsServed()) served_ = net_.now();
    const Utime most = kLease.duration + 2 * kLease.claim_window + kStartPeriod +
                       Lost(kStartPeriod) + 2 * kLease.repeat + 4 * UnreliableNetwork::kMostDelay +
                       4 * kTick;
    EXPECT_LE(net_.now() - std::max(served_, disturbed_), most) << "nobody leads";
  }

  int AllAwake() const {
    int awake = 0;
    for (size_t i = 0; i < nodes_.size(); ++i) awake |= (net_.Awake(i) ? 1 : 0) << i;
    return awake;
  }

  /// Undisturbed, one leads.
  void Calm() {
    for (size_t k = 0; k <= front_end_; ++k) {
      net_.Move(k, 0);
      net_.Pause(k, 0);
    }
    for (size_t i = 0; i < nodes_.size(); ++i) {
      nodes_[i].session_ends = net_.now() + 100 * kSecond;
      if (net_.Alive(i)) continue;
      net_.Revive(i);
      Begin(i);
    }
    for (const Utime end = net_.now() + 6 * kSecond; net_.now() < end;) Live();
    size_t leaders = 0, followers = 0;
    for (size_t i = 0; i < nodes_.size(); ++i) {
      leaders += Holds(i) ? 1 : 0;
      followers += nodes_[i].leases->StateOf(kUser) == LeaseState::kElsewhere ? 1 : 0;
    }
    // One may have just given it back.
    EXPECT_LE(leaders, 1u);
    EXPECT_EQ(followers, leaders == 1 ? nodes_.size() - 1 : followers);
  }

  UnreliableNetwork net_;
  std::vector<Node> nodes_;
  const double loss_;
  const size_t front_end_;
  std::vector<Utime> both_;  // by pair: when they last did not both lead
  Utime disturb_at_ = 0;
  Utime disturbed_ = 0;
  Utime served_ = 0;
  int all_awake_ = 0;
  int64_t changes_ = 0;
};

void Live(double loss) {
  int64_t changes = 0;
  for (uint64_t seed = 1; seed <= kSeeds && !testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Simulation simulation(seed, 2 + seed % 4, loss);
    simulation.Run();
    changes += simulation.changes_of_hands();
  }
  EXPECT_GT(changes, 10 * kSeeds) << "the simulations say little";
}

TEST(LeaseFaults, OneLeadsAndSoonWhereNothingIsLost) { Live(0); }

TEST(LeaseFaults, OneLeadsAndSoonWhereMessagesAreLost) { Live(0.2); }

}  // namespace
}  // namespace beckon::intention
