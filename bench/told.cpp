// beckon-bench-told DIR..: how well objects that the user named are recognised by their looks, and
// what several views of an object say together, over folders as beckon-train reads them.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <map>

#include "services/base/app.h"
#include "services/perception/category_evidence.h"
#include "services/perception/train_data.h"
#include "tests/perception/view_score.h"

namespace {

using namespace beckon;
using namespace beckon::perception;

struct Measured {
  std::string category, instance;
  InstanceLook look;
  SeenAt at;
  Categorisation said;
};

Result<std::vector<Measured>> Measure(const std::string& folder, const Categoriser& categoriser) {
  auto records = ListViews(folder);
  if (!records) return records.error();
  std::vector<Measured> all;
  for (const ViewRecord& record : *records) {
    const auto loaded = LoadView(record);
    if (!loaded) return loaded.error();
    Measured m{record.category, record.category + "/" + record.instance, {}, {}, {}};
    m.look = LookAtInstance(loaded->view());
    for (const uint32_t pixel : loaded->pixels) {
      const int width = loaded->image.width, u = static_cast<int>(pixel) % width;
      m.at.centroid_C += loaded->image.Point(u, static_cast<int>(pixel) / width);
    }
    m.at.n_points = loaded->pixels.size();
    m.at.centroid_C /= static_cast<double>(std::max<size_t>(1, m.at.n_points));
    m.said = categoriser.Categorise(loaded->view());
    all.push_back(std::move(m));
  }
  return all;
}

void PrintMatches(const std::vector<Measured>& views) {
  std::vector<double> same, other, other_category;
  for (size_t i = 0; i < views.size(); ++i) {
    for (size_t j = i + 1; j < views.size(); ++j) {
      const double d = Difference(views[i].look, views[j].look);
      const bool equal = views[i].instance == views[j].instance;
      (equal ? same : other).push_back(d);
      if (views[i].category != views[j].category) other_category.push_back(d);
    }
  }
  const auto below = [](const std::vector<double>& all, double limit) {
    return 100.0 *
           static_cast<double>(std::ranges::count_if(all, [&](double d) { return d < limit; })) /
           static_cast<double>(std::max<size_t>(1, all.size()));
  };
  std::printf("pairs of views: %zu of one product, %zu of two\n", same.size(), other.size());
  std::printf("  %-18s %8s %8s %16s\n", "difference below", "same", "other", "other category");
  for (const double limit :
       {0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 2.25, 2.5, 2.75, 3.0, 3.5, 4.0, 5.0}) {
    std::printf("  %-18.2f %7.1f%% %7.2f%% %15.2f%%%s\n", limit, below(same, limit),
                below(other, limit), below(other_category, limit),
                limit == kRecognisedBelow ? "  <- recognised" : "");
  }
}

/// What an example changes: one view is named, perception sees another.
void PrintNaming(const std::vector<Measured>& views, float ask_at_or_below) {
  struct Count {
    int n = 0, renamed = 0, unasked = 0;
  };
  Count doubtful, same, other;
  const EvidenceConfig config{.ask_at_or_below = ask_at_or_below};
  for (const Measured& named : views) {
    ToldExamples examples;
    examples.Add({named.instance, named.category, named.look});
    for (const Measured& seen : views) {
      if (&seen == &named || seen.said.probabilities.empty()) continue;
      CategoryEvidence evidence;
      evidence.Add(seen.at, seen.look, seen.said, examples, config);
      const Categorisation& now = evidence.Decide(examples, config);
      const std::string& before = seen.said.probabilities.front().first;
      const std::string& after = now.probabilities.front().first;
      if (named.instance == seen.instance) {
        ++same.n;
        same.renamed += before != seen.category && after == seen.category ? 1 : 0;
        if (!seen.said.ask_user) continue;
        ++doubtful.n;
        doubtful.unasked += now.ask_user ? 0 : 1;
      } else {
        ++other.n;
        other.renamed += before != after && after != seen.category ? 1 : 0;
      }
    }
  }
  const auto percent = [](int part, int n) { return 100.0 * part / std::max(1, n); };
  std::printf("of one product, %d in doubt: %.1f%% not any more; of all, %.1f%% put right\n",
              doubtful.n, percent(doubtful.unasked, doubtful.n), percent(same.renamed, same.n));
  std::printf("of two products, %d: %.3f%% got a wrong name from the example\n", other.n,
              percent(other.renamed, other.n));
}

void Print(const char* what, const ViewScore& score) {
  std::printf("  %-34s %6.1f%% right, log loss %.3f\n", what, 100.0 * score.right / score.n,
              score.log_loss / score.n);
}

void PrintEvidence(const std::vector<Measured>& views) {
  std::map<std::string, std::vector<const Measured*>> by_instance;
  for (const auto& view : views) {
    if (!view.said.probabilities.empty()) by_instance[view.instance].push_back(&view);
  }
  ViewScore single;
  std::map<double, ViewScore> pairs;
  for (const auto& [instance, seen] : by_instance) {
    for (size_t i = 0; i < seen.size(); ++i) {
      for (size_t j = i + 1; j < seen.size(); ++j) {
        single.Add(seen[i]->said, seen[i]->category);
        single.Add(seen[j]->said, seen[j]->category);
        for (const double dependence : {0.0, 0.25, 0.5, 0.75, 1.0}) {
          const EvidenceConfig config{.dependence = dependence};
          pairs[dependence].Add(
              Combine({seen[i]->said, seen[j]->said}, {seen[i]->at, seen[j]->at}, {1, 1}, config),
              seen[i]->category);
        }
      }
    }
  }
  if (single.n == 0) return;
  std::printf("categories, %d pairs of views of one product:\n", single.n / 2);
  Print("one view", single);
  for (const auto& [dependence, score] : pairs) {
    char what[64];
    std::snprintf(what, sizeof what, "both, dependence %.2f", dependence);
    Print(what, score);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || std::strcmp(argv[1], "--help") == 0) {
    std::fprintf(stderr, "beckon-bench-told DIR..: folders as beckon-train reads them\n");
    return argc < 2 ? 2 : 0;
  }
  const auto categoriser = Categoriser::Load(SharedFile("categories.model"));
  if (!categoriser) return std::fprintf(stderr, "%s\n", categoriser.error().message.c_str()), 1;
  for (int i = 1; i < argc; ++i) {
    const auto views = Measure(argv[i], *categoriser);
    if (!views) return std::fprintf(stderr, "%s\n", views.error().message.c_str()), 1;
    std::printf("%s: %zu views\n", argv[i], views->size());
    PrintMatches(*views);
    PrintNaming(*views, categoriser->threshold());
    PrintEvidence(*views);
  }
  return 0;
}
