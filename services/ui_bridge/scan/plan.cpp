#include "services/ui_bridge/scan/plan.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "services/ui_bridge/scan/pace.h"

namespace beckon::ui_bridge::scan {
namespace {

/// What a plan is made of: an option, or all controls together (option -1).
struct Item {
  int option = -1;
  double weight = 0;
};

constexpr double kLeastWeight = 1e-3;  // nothing is so unlikely that it may lie as deep as it likes

std::vector<double> Weights(const Page& page) {
  const auto n = static_cast<size_t>(page.n_options);
  std::vector<double> weights(n, 1.0);
  const bool usable =
      page.probabilities.size() == n &&
      std::ranges::all_of(page.probabilities, [](double p) { return p >= 0; }) &&
      std::accumulate(page.probabilities.begin(), page.probabilities.end(), 0.0) > 0;
  if (usable) weights = page.probabilities;
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= sum;
  return weights;
}

std::vector<Item> OrderedOptions(const Config& config, const Page& page) {
  const std::vector<double> weights = Weights(page);
  std::vector<Item> items;
  for (int i = 0; i < page.n_options; ++i) items.push_back({i, weights[static_cast<size_t>(i)]});
  if (config.order == Order::kLikeliest) {
    const auto end = items.end() - (page.none_last && !items.empty() ? 1 : 0);
    std::stable_sort(items.begin(), end,
                     [](const Item& a, const Item& b) { return a.weight > b.weight; });
  }
  for (Item& item : items) item.weight = std::max(item.weight, kLeastWeight);
  return items;
}

/// Builds the levels of one page.
class Planner {
 public:
  Planner(const Config& config, const Page& page)
      : config_(config), page_(page), items_(OrderedOptions(config, page)) {}

  Plan Linear() { return Rows(std::max<size_t>(1, items_.size())); }

  /// Rows of `columns` options; where there is but one row, its options themselves.
  Plan Rows(size_t columns) {
    Begin();
    for (size_t first = 0; first < items_.size(); first += columns) {
      const size_t last = std::min(first + columns, items_.size());
      const bool single = last - first == 1 || columns >= items_.size();
      const int level = single ? 0 : Open(0);
      for (size_t i = first; i < last; ++i) Add(level, items_[i]);
      if (!single) Close(level);
    }
    if (!page_.controls.empty()) Add(0, Item{});
    return std::move(plan_);
  }

  Plan QuickestRows() {
    Plan best;
    double least = std::numeric_limits<double>::infinity();
    for (size_t columns = 1; columns <= items_.size(); ++columns) {
      Plan plan = Rows(columns);
      const double seconds = ExpectedSeconds(plan, config_, page_);
      if (seconds < least) {
        least = seconds;
        best = std::move(plan);
      }
    }
    return best;
  }

  Plan Binary() {
    if (!page_.controls.empty()) {
      items_.push_back({-1, std::max(config_.control_share, kLeastWeight)});
    }
    Begin();
    if (items_.size() == 1) {
      Add(0, items_[0]);
    } else {
      FindCuts();
      Cut(0, 0, items_.size());
    }
    return std::move(plan_);
  }

 private:
  void Begin() {
    plan_ = {};
    plan_.levels.emplace_back();
  }

  Level& At(int level) { return plan_.levels[static_cast<size_t>(level)]; }

  int Open(int parent) {
    const int level = static_cast<int>(plan_.levels.size());
    plan_.levels.push_back({.parent = parent, .entries = {}});
    At(parent).entries.push_back({.kind = Entry::Kind::kGroup, .level = level});
    return level;
  }

  void Close(int level) {
    if (config_.back == Back::kEntry) At(level).entries.push_back({.kind = Entry::Kind::kBack});
  }

  void Add(int level, const Item& item) {
    if (item.option >= 0) {
      At(level).entries.push_back({.kind = Entry::Kind::kOption, .option = item.option});
      return;
    }
    const bool group = page_.controls.size() > 1 && page_.n_options > 0;
    const int inner = group ? Open(level) : level;
    for (const Control control : page_.controls) {
      At(inner).entries.push_back({.kind = Entry::Kind::kControl, .control = control});
    }
    if (group) Close(inner);
  }

  /// cut_[i][j]: where items i .. j-1 are best cut in two, by dynamic programming over intervals.
  void FindCuts() {
    const size_t n = items_.size();
    const Pace pace(config_);
    const double first = static_cast<double>(pace.Choose_us(0, 1));
    const double second = static_cast<double>(pace.Choose_us(1, 1));
    std::vector<double> sum(n + 1, 0);
    for (size_t i = 0; i < n; ++i) sum[i + 1] = sum[i] + items_[i].weight;
    std::vector<std::vector<double>> cost(n + 1, std::vector<double>(n + 1, 0));
    cut_.assign(n + 1, std::vector<size_t>(n + 1, 0));
    for (size_t length = 2; length <= n; ++length) {
      for (size_t i = 0; i + length <= n; ++i) {
        const size_t j = i + length;
        cost[i][j] = std::numeric_limits<double>::infinity();
        for (size_t cut = i + 1; cut < j; ++cut) {
          const double here = cost[i][cut] + cost[cut][j] + first * (sum[cut] - sum[i]) +
                              second * (sum[j] - sum[cut]);
          if (here >= cost[i][j]) continue;
          cost[i][j] = here;
          cut_[i][j] = cut;
        }
      }
    }
  }

  void Cut(int level, size_t i, size_t j) {
    const size_t cut = cut_[i][j];
    for (const auto& [from, to] : std::array{std::pair{i, cut}, std::pair{cut, j}}) {
      if (to - from == 1) {
        Add(level, items_[from]);
        continue;
      }
      const int inner = Open(level);
      Cut(inner, from, to);
      Close(inner);
    }
  }

  const Config& config_;
  const Page& page_;
  std::vector<Item> items_;
  std::vector<std::vector<size_t>> cut_;
  Plan plan_;
};

/// Time to the first entry for which `is_it` holds, by the way down from levels[0].
template <typename IsIt>
std::optional<Utime> TimeTo(const Plan& plan, const Config& config, const IsIt& is_it) {
  if (plan.empty()) return {};
  const Pace pace(config);
  struct Stop {
    int level;
    int depth;
    Utime begun;
  };
  std::vector<Stop> stack{{0, 0, 0}};
  while (!stack.empty()) {
    const auto [level, depth, begun] = stack.back();
    stack.pop_back();
    const auto& entries = plan.levels[static_cast<size_t>(level)].entries;
    for (int k = 0; k < static_cast<int>(entries.size()); ++k) {
      const Entry& entry = entries[static_cast<size_t>(k)];
      if (is_it(entry)) return begun + pace.ChooseLast_us(k, depth);
      if (entry.kind == Entry::Kind::kGroup) {
        stack.push_back({entry.level, depth + 1, begun + pace.Choose_us(k, depth)});
      }
    }
  }
  return {};
}

template <typename Take>
void ForEachLeaf(const Plan& plan, const Entry& entry, const Take& take) {
  if (entry.kind != Entry::Kind::kGroup) return take(entry);
  for (const Entry& inner : plan.levels[static_cast<size_t>(entry.level)].entries) {
    ForEachLeaf(plan, inner, take);
  }
}

}  // namespace

const char* Name(Control control) {
  switch (control) {
    case Control::kUndo:
      return "undo";
    case Control::kNone:
      return "none";
    case Control::kPause:
      return "pause";
    case Control::kStop:
      return "stop";
    case Control::kResume:
      return "resume";
    case Control::kStay:
      return "stay";
    case Control::kStart:
      return "start";
  }
  return "";
}

Plan MakePlan(const Config& config, const Page& page) {
  if (page.n_options <= 0 && page.controls.empty()) return {};
  Planner planner(config, page);
  if (page.n_options <= 0 || config.grouping == Grouping::kLinear) return planner.Linear();
  if (config.grouping == Grouping::kBinary) return planner.Binary();
  return config.columns > 0 ? planner.Rows(static_cast<size_t>(config.columns))
                            : planner.QuickestRows();
}

std::vector<int> OptionsOf(const Plan& plan, const Entry& entry) {
  std::vector<int> options;
  ForEachLeaf(plan, entry, [&](const Entry& leaf) {
    if (leaf.kind == Entry::Kind::kOption) options.push_back(leaf.option);
  });
  return options;
}

std::vector<Control> ControlsOf(const Plan& plan, const Entry& entry) {
  std::vector<Control> controls;
  ForEachLeaf(plan, entry, [&](const Entry& leaf) {
    if (leaf.kind == Entry::Kind::kControl) controls.push_back(leaf.control);
  });
  return controls;
}

std::optional<Utime> TimeToOption(const Plan& plan, const Config& config, int option) {
  return TimeTo(plan, config, [option](const Entry& entry) {
    return entry.kind == Entry::Kind::kOption && entry.option == option;
  });
}

std::optional<Utime> TimeToControl(const Plan& plan, const Config& config, Control control) {
  return TimeTo(plan, config, [control](const Entry& entry) {
    return entry.kind == Entry::Kind::kControl && entry.control == control;
  });
}

double ExpectedSeconds(const Plan& plan, const Config& config, const Page& page) {
  const std::vector<double> weights = Weights(page);
  double seconds = 0;
  for (int i = 0; i < page.n_options; ++i) {
    const auto time = TimeToOption(plan, config, i);
    if (time) seconds += weights[static_cast<size_t>(i)] * static_cast<double>(*time) / kSecond;
  }
  return seconds;
}

Utime StopWithin_us(const Plan& plan, const Config& config) {
  if (config.stop_hold_us == 0) return 0;
  if (config.method != Method::kInverse) return config.stop_hold_us;
  Utime pass = 0;
  for (const Level& level : plan.levels) {
    pass = std::max(pass, std::max(config.hold_us, config.debounce_us) + config.first_us +
                              config.scan_us * static_cast<Utime>(level.entries.size()));
  }
  return pass + config.stop_hold_us;
}

}  // namespace beckon::ui_bridge::scan
