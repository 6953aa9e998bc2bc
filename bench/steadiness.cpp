// How steadily objects are shown: fresh tables in front of a noisy camera, which stand still and on
// which then an object moves, is taken away and put back. Prints a table; writes JSON.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "services/base/app.h"
#include "tests/perception/steady_watch.h"

namespace beckon::perception {
namespace {

struct Options {
  std::vector<uint64_t> seeds = {101, 102, 103, 104, 105, 106, 107, 108, 109, 110, 111, 112};
  int frames = 100;
  int settle = 15;
  std::string json;
};

struct Figures {
  uint64_t seed = 0;
  int objects = 0;  // that there are,
  int shown = 0;    // shown in the last frame,
  int ids = 0;      // and in all
  int final_from = 0;
  double first_accuracy = 0, last_accuracy = 0;  // mean IoU with the truth
  Steadiness all, settled;
  Notice move, removal, comeback;
};

double MeanAccuracy(const SteadyTable& table, const Perception& now) {
  double sum = 0;
  for (int k = 0; k < table.n_objects(); ++k) sum += Accuracy(now, table.labels(), k);
  return sum / table.n_objects();
}

Figures Watch(uint64_t seed, const Options& options) {
  Figures f{.seed = seed, .objects = 5 + static_cast<int>(seed % 5)};
  SteadyTable table(seed, f.objects);
  Perceiver perceiver({}, nullptr);
  SteadyWatch watch;
  Perception now;
  for (int frame = 0; frame < options.frames; ++frame) {
    const RgbdImage image = table.Next();
    now = perceiver.Perceive(image);
    watch.Add(image, now);
    if (frame == 0) f.first_accuracy = MeanAccuracy(table, now);
  }
  f.last_accuracy = MeanAccuracy(table, now);
  f.shown = static_cast<int>(now.objects.size());
  f.ids = static_cast<int>(watch.Ids().size());
  f.final_from = watch.FinalFrom();
  f.all = watch.From(0);
  f.settled = watch.From(options.settle);
  const int removed = 1, id = IdOf(now, table.labels(), removed);
  f.removal = WatchRemoval(table, perceiver, removed);
  f.comeback = WatchReturn(table, perceiver, removed, id);
  f.move = WatchMove(table, perceiver, 0, -0.04, -0.08);
  return f;
}

void PrintHead() {
  std::printf(
      "seed obj shown ids | id chg final | outline min  p5   silh  labels | centr mm table mm mrad "
      "|"
      " settled: chg outl silh labels centr | removed back moved | accuracy\n");
}

void Print(const Figures& f) {
  const auto told = [](const Notice& n) {
    return (n.after_frames == Notice::kNever ? "-" : std::to_string(n.after_frames)) +
           (n.right_id ? "" : "!");
  };
  std::printf(
      "%4d %3d %5d %3d | %6d %5d |  %.3f  %.3f  %.3f  %.3f | %5.2f  %5.2f  %5.2f |  "
      "%6d  %.3f  %.3f  %.3f  %5.2f | %7s %4s %5s | %.3f %.3f\n",
      static_cast<int>(f.seed), f.objects, f.shown, f.ids, f.all.id_changes, f.final_from,
      f.all.least_outline, f.all.low_outline, f.all.least_silhouette, f.all.least_labels,
      1e3 * f.all.most_centroid_m, 1e3 * f.all.table_m, 1e3 * f.all.table_rad, f.settled.id_changes,
      f.settled.least_outline, f.settled.least_silhouette, f.settled.least_labels,
      1e3 * f.settled.most_centroid_m, told(f.removal).c_str(), told(f.comeback).c_str(),
      told(f.move).c_str(), f.first_accuracy, f.last_accuracy);
  std::fflush(stdout);
}

nlohmann::ordered_json ToJson(const Steadiness& s) {
  return {{"id_changes", s.id_changes},
          {"least_outline_iou", s.least_outline},
          {"low_outline_iou", s.low_outline},
          {"least_silhouette_iou", s.least_silhouette},
          {"least_labels_iou", s.least_labels},
          {"centroid_m", s.most_centroid_m},
          {"table_m", s.table_m},
          {"table_rad", s.table_rad}};
}

nlohmann::ordered_json ToJson(const Notice& n) {
  nlohmann::ordered_json told = {{"frames", nullptr}, {"right_id", n.right_id}};
  if (n.after_frames != Notice::kNever) told["frames"] = n.after_frames;
  return told;
}

nlohmann::ordered_json ToJson(const Figures& f) {
  return {{"seed", f.seed},
          {"objects", f.objects},
          {"shown", f.shown},
          {"ids", f.ids},
          {"final_from", f.final_from},
          {"first_accuracy", f.first_accuracy},
          {"last_accuracy", f.last_accuracy},
          {"all", ToJson(f.all)},
          {"settled", ToJson(f.settled)},
          {"removed", ToJson(f.removal)},
          {"put_back", ToJson(f.comeback)},
          {"moved", ToJson(f.move)}};
}

Status Run(const Options& options) {
  nlohmann::ordered_json tables = nlohmann::ordered_json::array();
  PrintHead();
  for (uint64_t seed : options.seeds) {
    const Figures figures = Watch(seed, options);
    Print(figures);
    tables.push_back(ToJson(figures));
  }
  if (options.json.empty()) return {};
  const nlohmann::ordered_json out = {{"version", VersionString()},
                                      {"frames", options.frames},
                                      {"settle", options.settle},
                                      {"tables", tables}};
  std::ofstream(options.json) << out.dump(1) << '\n';
  return {};
}

}  // namespace
}  // namespace beckon::perception

int main(int argc, char** argv) {
  CLI::App app("Tells how steadily objects on fresh tables are shown", "beckon-bench-steadiness");
  beckon::AppOptions common;
  beckon::AddAppOptions(app, common);
  beckon::perception::Options options;
  app.add_option("--seeds", options.seeds, "Tables")->capture_default_str();
  app.add_option("--frames", options.frames, "Of each table")->capture_default_str();
  app.add_option("--settle", options.settle, "Frames before it is judged anew")
      ->capture_default_str();
  app.add_option("--json", options.json, "Write the figures here as well");
  return beckon::RunApp(app, argc, argv, common, [&] { return beckon::perception::Run(options); });
}
