// beckon-perception: sees the table and what stands on it, on the bus or in a file.
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <opencv2/core/utility.hpp>

#include "services/base/app.h"
#include "services/perception/offline.h"
#include "services/perception/service.h"

namespace {

using namespace beckon;
using namespace beckon::perception;

struct Options {
  AppOptions app;
  OfflineOptions offline;
  Overrides overrides;
  bool list_categories = false;
};

void AddOptions(CLI::App& app, Options& o) {
  AddAppOptions(app, o.app);
  auto* input = app.add_option("--input", o.offline.input,
                               "Perceive this cloud (.pcd, .ply) and leave; no bus");
  app.add_option("--segmentation", o.overrides.segmentation, "How to segment: fast or reference");
  app.add_flag("--no-categories", o.overrides.no_categories, "Do not categorise objects");
  app.add_option("--model", o.overrides.model, "Categories, as beckon-train wrote them");
  app.add_option("--cues", o.overrides.cues,
                 "Cues that have a say: all, dissertation, or names parted by commas");
  app.add_option(
      "--examples", o.overrides.examples,
      "Folder for views of objects that the user named; auto: ~/.local/share/beckon/examples");
  app.add_flag("--list-categories", o.list_categories, "Print the model's categories and leave");
  app.add_option("--threads", o.overrides.threads, "Objects categorised at a time (default 1)")
      ->check(CLI::Range(1, 64));
  app.add_option("--json", o.offline.json_file, "The result (default: standard output)");
  app.add_option("--labels", o.offline.labels_file, "16-bit PNG of the objects' pixels");
  auto* picture = app.add_option("--picture", o.offline.picture_file,
                                 "The image with named objects and the time of each step");
  app.add_option("--stage", o.offline.stage,
                 "What this step made, as the picture: grid, table, surface, patches, grouping, "
                 "labels (fast); range_voxels, normals, plane, hull, prism, clusters, labels")
      ->needs(picture);
  app.add_option("--repeat", o.offline.repeat, "Compute this often, tell the median times")
      ->check(CLI::Range(1, 100000));
  for (const char* name : {"--json", "--labels", "--picture", "--repeat"}) {
    app.get_option(name)->needs(input);
  }
}

Status Serve(const PerceptionConfig& config, const std::string& lcm_url) {
  auto categoriser = LoadCategoriser(config);
  if (!categoriser) return categoriser.error();
  RunLoop loop(true);  // before threads start: it blocks signals for all of them
  auto bus = Bus::Open(lcm_url);
  if (!bus) return bus.error();
  Service service(**bus, loop, config.perceiver, *std::move(categoriser), config.learning);
  loop.AddFd((*bus)->fd(), [&bus] { (*bus)->HandleReadable(); });
  loop.Run();
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  // Every frame takes the same few megabytes; faulting them in anew costs as much as segmenting.
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  CLI::App app("Sees the table and the objects on it", "beckon-perception");
  Options options;
  AddOptions(app, options);
  return RunApp(app, argc, argv, options.app, [&]() -> Status {
    auto table = LoadConfig(options.app);
    if (!table) return table.error();
    auto config = ReadPerceptionConfig(*table, options.overrides);
    if (!config) return config.error();
    cv::setNumThreads(config->perceiver.threads);
    if (options.app.check_config) return {};
    if (options.list_categories) return ListCategories(*config);
    if (!options.offline.input.empty()) return PerceiveFile(options.offline, *config);
    return Serve(*config, options.app.lcm_url);
  });
}
