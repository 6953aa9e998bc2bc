// The habits of simulated users, a small class each, and the table of them.
#include <algorithm>
#include <utility>

#include "services/intention/core/simulated_tastes.h"
#include "services/intention/core/simulated_user.h"

namespace beckon::intention {
namespace {

constexpr double kSlip = 0.1;           // P(something else than the habit says)
constexpr double kNewHabit = 1.0 / 50;  // a session, where habits end by chance
constexpr Utime kDay = Utime{86'400} * kSecond;
constexpr Utime kFirstDay = Utime{1'767'571'200} * kSecond;  // 2026-01-05, a Monday

/// Has tastes, finds a new random table each time, and wants what is nearest.
class TastefulUser : public SimulatedUser {
 public:
  TastefulUser(const Affordances& affordances, SeededRandom& random)
      : affordances_(affordances), tastes_(Tastes::Sparse(affordances, random)) {}

  std::vector<Thing> NextTable(const std::vector<Thing>&, SeededRandom& random) override {
    return DrawTable(affordances_, random);
  }
  int Choose(const Situation& table, SeededRandom& random) override {
    return tastes_.Draw(table, random);
  }

 protected:
  const Affordances& affordances_;
  Tastes tastes_;
};

class SparseUser : public TastefulUser {
 public:
  SparseUser(const Affordances& affordances, const SimulationConfig& config, SeededRandom& random)
      : TastefulUser(affordances, random), change_at_(config.sessions / 2) {}
  int Choose(const Situation& table, SeededRandom& random) override {
    if (lived_++ == change_at_) tastes_ = Tastes::Sparse(affordances_, random);
    return tastes_.Draw(table, random);
  }

 private:
  int change_at_;
  int lived_ = 0;
};

class SuddenUser : public TastefulUser {
 public:
  SuddenUser(const Affordances& affordances, const SimulationConfig&, SeededRandom& random)
      : TastefulUser(affordances, random) {}
  int Choose(const Situation& table, SeededRandom& random) override {
    if (random.Chance(kNewHabit)) tastes_ = Tastes::Sparse(affordances_, random);
    return tastes_.Draw(table, random);
  }
};

class DriftingUser : public TastefulUser {
 public:
  DriftingUser(const Affordances& affordances, const SimulationConfig&, SeededRandom& random)
      : TastefulUser(affordances, random), next_(Tastes::Sparse(affordances, random)) {}
  int Choose(const Situation& table, SeededRandom& random) override {
    constexpr int kWay = 80;  // sessions from one set of tastes to the next
    if (lived_ == kWay) {
      tastes_ = std::exchange(next_, Tastes::Sparse(affordances_, random));
      lived_ = 0;
    }
    const double share = static_cast<double>(lived_++) / kWay;
    return Tastes::Blend(tastes_, next_, share).Draw(table, random);
  }

 private:
  Tastes next_;
  int lived_ = 0;
};

/// Keeps to one group of pairs for a while: those of one category, or those of one action.
class DevotedUser : public TastefulUser {
 public:
  enum class To { kCategory, kAction };
  template <To to>
  static std::unique_ptr<SimulatedUser> Make(const Affordances& affordances,
                                             const SimulationConfig&, SeededRandom& random) {
    return std::make_unique<DevotedUser>(affordances, to, random);
  }
  DevotedUser(const Affordances& affordances, To to, SeededRandom& random)
      : TastefulUser(affordances, random), to_(to), devotion_(affordances) {
    Devote(random);
  }
  int Choose(const Situation& table, SeededRandom& random) override {
    if (random.Chance(kNewHabit)) Devote(random);
    return (random.Chance(kSlip) ? tastes_ : devotion_).Draw(table, random);
  }

 private:
  void Devote(SeededRandom& random) {
    const auto all = AllTastes(affordances_);
    const auto key = [&](const Taste& taste) {
      return to_ == To::kCategory ? taste.category : taste.action;
    };
    const int chosen = key(all[random.Below(static_cast<int>(all.size()))]);
    std::vector<Taste> group;
    for (const Taste& taste : all) {
      if (key(taste) == chosen) group.push_back(taste);
    }
    devotion_ = Tastes(affordances_);
    devotion_.LikeInTurn(group, static_cast<int>(group.size()), 0.7, random);
  }

  To to_;
  Tastes devotion_;
};

/// Wants of the favourite category the second nearest: the nearest belongs to somebody else.
class FavouriteInstanceUser : public TastefulUser {
 public:
  FavouriteInstanceUser(const Affordances& affordances, const SimulationConfig&,
                        SeededRandom& random)
      : TastefulUser(affordances, random),
        favourite_(random.Below(static_cast<int>(affordances.categories().size()))),
        favourites_(affordances) {
    std::vector<Taste> pairs;
    for (const int action : affordances.categories()[favourite_].actions) {
      pairs.push_back({favourite_, action});
    }
    favourites_.LikeInTurn(pairs, static_cast<int>(pairs.size()), 0.5, random);
    tastes_ = Tastes::Blend(tastes_, favourites_, 0.5);
  }
  std::vector<Thing> NextTable(const std::vector<Thing>&, SeededRandom& random) override {
    while (true) {
      auto things = DrawTable(affordances_, random);
      const auto count = std::count_if(things.begin(), things.end(), [&](const Thing& thing) {
        return thing.category == favourite_;
      });
      if (count >= 2 || random.Chance(kSlip)) return things;
    }
  }
  int Choose(const Situation& table, SeededRandom& random) override {
    const int nearest = tastes_.Draw(table, random);
    const Pair& pair = table.pairs[nearest];
    if (table.objects[pair.object].category != favourite_ || random.Chance(kSlip)) return nearest;
    const int second = table.Find(favourite_, 2, pair.action);
    return second >= 0 ? second : nearest;
  }

 private:
  int favourite_;
  Tastes favourites_;
};

/// The same things at the same times of each day.
class RoutineUser : public TastefulUser {
 public:
  RoutineUser(const Affordances& affordances, const SimulationConfig&, SeededRandom& random)
      : TastefulUser(affordances, random) {
    const auto pairs = AllTastes(affordances);
    const int slots = 4 + random.Below(4);
    for (int i = 0; i < slots; ++i) {
      const double hour = 7 + (i + random.Between(0.2, 0.8)) * 15 / slots;  // 7:00 to 22:00
      day_.push_back({hour, pairs[random.Below(static_cast<int>(pairs.size()))]});
    }
  }
  Utime NextTime(SeededRandom& random) override {
    const size_t slots = day_.size();
    const double hour = day_[lived_ % slots].hour + random.Between(-0.4, 0.4);
    const Utime day = static_cast<Utime>(lived_ / slots) * kDay;
    return kFirstDay + day + static_cast<Utime>(hour * 3'600) * kSecond;
  }
  int Choose(const Situation& table, SeededRandom& random) override {
    const auto [category, action] = day_[lived_++ % day_.size()].taste;
    const int usual = table.Find(category, 1, action);
    return usual >= 0 && !random.Chance(kSlip) ? usual : tastes_.Draw(table, random);
  }

 private:
  struct Slot {
    double hour;
    Taste taste;
  };
  std::vector<Slot> day_;
  size_t lived_ = 0;
};

/// Wants each of a few things about its time on some days, and now and then something in between.
class TimetableUser : public TastefulUser {
 public:
  TimetableUser(const Affordances& affordances, const SimulationConfig&, SeededRandom& random)
      : TastefulUser(affordances, random) {
    const auto pairs = AllTastes(affordances);
    const int customs = 4 + random.Below(5);
    for (int i = 0; i < customs; ++i) {
      Custom& custom = customs_.emplace_back();
      custom.hour = random.Between(7, 22);
      custom.spread_h = random.Between(0.2, 0.8);
      custom.often = random.Between(0.4, 0.9);
      custom.taste = pairs[random.Below(static_cast<int>(pairs.size()))];
    }
  }
  Utime NextTime(SeededRandom& random) override {
    while (today_.empty()) BeginDay(random);
    now_ = today_.back();
    today_.pop_back();
    return kFirstDay + days_ * kDay + static_cast<Utime>(now_.hour * 3'600) * kSecond;
  }
  int Choose(const Situation& table, SeededRandom& random) override {
    if (now_.custom < 0) return tastes_.Draw(table, random);
    const auto [category, action] = customs_[now_.custom].taste;
    const int usual = table.Find(category, 1, action);
    return usual >= 0 && !random.Chance(kSlip) ? usual : tastes_.Draw(table, random);
  }

 private:
  struct Custom {
    double hour = 0;
    double spread_h = 0;  // at most earlier or later
    double often = 0;     // P(on a day)
    Taste taste;
  };
  struct Moment {
    double hour = 0;
    int custom = -1;  // index in customs_; -1: anything
  };
  void BeginDay(SeededRandom& random) {
    ++days_;
    for (int i = 0; i < static_cast<int>(customs_.size()); ++i) {
      const auto& [hour, spread_h, often, taste] = customs_[i];
      if (random.Chance(often)) today_.push_back({hour + random.Between(-spread_h, spread_h), i});
    }
    for (int others = random.Below(3); others > 0; --others) {
      today_.push_back({random.Between(7, 22), -1});
    }
    std::sort(today_.begin(), today_.end(),
              [](const Moment& a, const Moment& b) { return a.hour > b.hour; });
  }

  std::vector<Custom> customs_;
  std::vector<Moment> today_;  // still to come, the last one first
  Moment now_;
  int days_ = 0;
};

/// Does things in two or three steps with one and the same object: grasp, open, pour.
class SequenceUser : public TastefulUser {
 public:
  SequenceUser(const Affordances& affordances, const SimulationConfig&, SeededRandom& random)
      : TastefulUser(affordances, random) {
    while (scripts_.size() < 4) {
      const auto& categories = affordances.categories();
      const int category = random.Below(static_cast<int>(categories.size()));
      std::vector<int> steps = categories[category].actions;
      for (size_t i = steps.size(); i > 1; --i) {
        std::swap(steps[i - 1], steps[random.Below(static_cast<int>(i))]);
      }
      if (steps.size() > 3) steps.resize(3);
      scripts_.push_back({category, steps});
    }
  }
  /// The table stays as it is while a script goes on.
  std::vector<Thing> NextTable(const std::vector<Thing>& last, SeededRandom& random) override {
    if (step_ > 0 && !random.Chance(kSlip)) return last;
    step_ = 0;
    return DrawTable(affordances_, random);
  }
  int Choose(const Situation& table, SeededRandom& random) override {
    if (step_ == 0) {
      std::vector<double> weights;  // 1, 1/2, 1/3, 1/4
      for (size_t i = 0; i < scripts_.size(); ++i) {
        const bool possible = table.Find(scripts_[i].category, 1, scripts_[i].actions[0]) >= 0;
        weights.push_back(possible ? 1.0 / static_cast<double>(i + 1) : 0);
      }
      running_ = random.Weighted(weights);
      if (running_ < 0 || random.Chance(kSlip)) return tastes_.Draw(table, random);
    }
    const Script& script = scripts_[running_];
    const int want = table.Find(script.category, 1, script.actions[step_]);
    step_ = (step_ + 1) % script.actions.size();
    return want;
  }

 private:
  struct Script {
    int category;
    std::vector<int> actions;
  };
  std::vector<Script> scripts_;
  int running_ = -1;
  size_t step_ = 0;  // of the running script; 0: none is running
};

/// Shares half of the tastes with the others of the house.
class HouseholdUser : public TastefulUser {
 public:
  HouseholdUser(const Affordances& affordances, const SimulationConfig& config,
                SeededRandom& random)
      : TastefulUser(affordances, random) {
    SeededRandom house(config.seed);
    tastes_ = Tastes::Blend(tastes_, Tastes::Sparse(affordances, house), 0.5);
  }
};

class NewEveryTimeUser : public TastefulUser {
 public:
  NewEveryTimeUser(const Affordances& affordances, const SimulationConfig&, SeededRandom& random)
      : TastefulUser(affordances, random) {}
  int Choose(const Situation& table, SeededRandom& random) override {
    return random.Below(table.pair_count());
  }
};

template <typename User>
std::unique_ptr<SimulatedUser> Make(const Affordances& affordances, const SimulationConfig& config,
                                    SeededRandom& random) {
  return std::make_unique<User>(affordances, config, random);
}

}  // namespace

const std::vector<SimulatedKind>& SimulatedKinds() {
  using To = DevotedUser::To;
  static const std::vector<SimulatedKind> kinds = {
      {"sparse", "a few wants, others from the middle of the sessions on", false, Make<SparseUser>},
      {"routine", "the same wants at the same times of each day, with slips", false,
       Make<RoutineUser>},
      {"timetable", "a want at about its time on some days, others at any time", false,
       Make<TimetableUser>},
      {"object-first", "one category for a while, several actions", false,
       DevotedUser::Make<To::kCategory>},
      {"action-first", "one action for a while, several categories", false,
       DevotedUser::Make<To::kAction>},
      {"sequence", "two or three steps with one object on one table", false, Make<SequenceUser>},
      {"drift", "a few wants that turn into others little by little", false, Make<DriftingUser>},
      {"sudden", "a few wants, others all at once, every 50 sessions on average", false,
       Make<SuddenUser>},
      {"favourite-instance", "of one category the second nearest", false,
       Make<FavouriteInstanceUser>},
      {"household", "several users in turn who share half of their wants", true,
       Make<HouseholdUser>},
      {"new-every-time", "anything on the table, any instance: nothing can be learnt", false,
       Make<NewEveryTimeUser>},
  };
  return kinds;
}

}  // namespace beckon::intention
