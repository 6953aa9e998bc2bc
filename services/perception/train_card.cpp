// Markdown out of a training's outcome.
#include "services/perception/train_card.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>

#include "services/perception/train_figures.h"

namespace beckon::perception {
namespace {

void WriteData(std::ostream& out, const CardSubject& subject) {
  std::map<std::string, std::pair<size_t, std::set<std::string>>> by_category;
  for (const ViewRecord& record : subject.records) {
    auto& [views, instances] = by_category[record.category];
    ++views;
    instances.insert(record.instance);
  }
  out << "## Trained on\n`" << subject.data << "`: " << subject.records.size() << " views, "
      << subject.skipped.size()
      << " more left out\n\n| category | objects | views |\n|---|---|---|\n";
  for (const auto& [category, counts] : by_category) {
    out << "| " << category << " | " << counts.second.size() << " | " << counts.first << " |\n";
  }
  constexpr size_t kMostNamed = 20;
  size_t named = 0;
  for (const auto& [file, why] : subject.skipped) {
    if (named++ == 0) out << "\nLeft out:\n";
    if (named <= kMostNamed) out << "- `" << file << "`: " << why << "\n";
  }
  if (named > kMostNamed) out << "- and " << named - kMostNamed << " more\n";
}

void WriteConfig(std::ostream& out, const TrainConfig& c) {
  out << "\n## Settings\nseed " << c.seed << ", cues " << c.cues << ", folds " << c.folds
      << ", words " << c.sift_words << " / " << c.hog_words << " / " << c.fpfh_words
      << " (sift / hog / fpfh) from " << c.vocabulary_views << " views, cost " << c.cost
      << ", gamma_scale " << c.gamma_scale << ", decider " << c.decider_cost << " / "
      << c.decider_gamma_scale << ", caution " << c.caution << ", unknown_prior " << c.unknown_prior
      << ", target_accuracy " << c.target_accuracy << "\n";
}

/// The most frequent pairs of a category and what its views were taken for.
void WriteConfusions(std::ostream& out, const std::vector<Judgement>& judgements,
                     const std::vector<std::string>& categories) {
  const auto counts = Confusions(judgements, categories.size());
  struct Pair {
    int count;
    size_t is, taken;
  };
  std::vector<Pair> pairs;
  for (size_t is = 0; is < counts.size(); ++is) {
    for (size_t taken = 0; taken < counts.size(); ++taken) {
      if (is != taken && counts[is][taken] > 0) pairs.push_back({counts[is][taken], is, taken});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.count > b.count; });
  constexpr size_t kMostPairs = 10;
  pairs.resize(std::min(pairs.size(), kMostPairs));
  out << "\nCommonest confusions (views):";
  if (pairs.empty()) out << " none";
  for (const Pair& p : pairs) {
    out << (&p == pairs.data() ? " " : ", ") << categories[p.is] << " taken for "
        << categories[p.taken] << " " << p.count;
  }
  out << "\n\n```\n" << ConfusionTable(judgements, categories) << "```\n";
}

void WriteLimits(std::ostream& out, const std::vector<std::string>& categories) {
  const bool knows_unknown =
      std::find(categories.begin(), categories.end(), kUnknown) != categories.end();
  out << "\n## Not good for\n"
      << "- "
      << (knows_unknown ? "Strange things unlike those it saw as Unknown"
                        : "Strange things: it knows no Unknown")
      << "; they are named as what they resemble most.\n"
      << "- Objects that differ from those above in size, sensor, pose or wear. The figures are "
         "for "
         "objects like those it was trained on, each held out whole; on others they are lower.\n"
      << "- Views with few points, hidden parts or no table plane: more of them are asked about, "
         "and more are wrong.\n"
      << "- Deciding anything that may hurt somebody: what it is not sure of is asked, and a sure "
         "answer can be wrong.\n";
}

}  // namespace

std::string ModelCard(const CardSubject& subject, const TrainConfig& config,
                      const TrainOutcome& outcome) {
  const Model& model = outcome.model;
  const std::vector<Judgement> judgements = Judge(outcome.held_out.front());
  std::ostringstream out;
  out << "# " << std::filesystem::path(subject.model_file).filename().string()
      << "\nA model of categories for beckon-perception, made by beckon-train " << subject.version
      << ".\n\n";
  if (!subject.base.empty()) out << "It improves `" << subject.base << "`.\n\n";
  WriteData(out, subject);
  WriteConfig(out, config);
  for (const std::string& note : outcome.notes) out << "\nNote: " << note << ".\n";
  out << "\n## Worth\nIn cross-validation over objects (no object in training and test): "
      << Text(FiguresOf(judgements, model.categories, model.deciders.front().threshold))
      << ".\n\n```\n"
      << CueTable(outcome) << "```\n";
  WriteConfusions(out, judgements, model.categories);
  WriteLimits(out, model.categories);
  return out.str();
}

}  // namespace beckon::perception
