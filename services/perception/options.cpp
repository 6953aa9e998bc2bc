// Flags and their help.
#include "services/perception/options.h"

#include <CLI/CLI.hpp>

namespace beckon::perception {

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

}  // namespace beckon::perception
