// beckon-pose: a superquadric and grasps for every object of a scene, or for clouds in files.
#include <CLI/CLI.hpp>

#include "services/base/app.h"
#include "services/base/bus.h"
#include "services/base/run_loop.h"
#include "services/pose/offline.h"
#include "services/pose/pose_config.h"
#include "services/pose/service.h"

namespace {

using namespace beckon;

Status Serve(const AppOptions& app, const pose::PoseConfig& config) {
  RunLoop loop(/*handle_signals=*/true);
  auto bus = OpenBus(app, "pose");
  if (!bus) return bus.error();
  loop.AddFd((*bus)->fd(), [&bus] { (*bus)->HandleReadable(); });
  pose::PoseService service(**bus, loop, config);
  loop.Run();
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Estimates pose and shape of every object as a superquadric, and grasps for it.",
               "beckon-pose");
  AppOptions options;
  AddAppOptions(app, options);
  pose::OfflineOptions offline;
  std::string method;
  app.add_option("--input", offline.inputs,
                 "Clouds to fit instead of serving (.pcd .ply .xyz, metres)")
      ->type_name("CLOUD");
  app.add_option("--labels", offline.labels,
                 "16-bit PNG that labels the objects of one organised input; a result for each")
      ->type_name("LABELS.png");
  app.add_option("--plane", offline.plane, "The inputs' table, n.p + d = 0")
      ->type_name("nx,ny,nz,d");
  app.add_option("--list", offline.list, "A line {\"file\": .., \"plane\": [..]} for each cloud")
      ->type_name("LIST.jsonl");
  app.add_option("--method", method,
                 "One of " + pose::MethodNames() + " (default: the configuration's)");
  app.add_option("--json", offline.json, "Where the poses go")->type_name("OUT.json");
  app.add_option("--picture", offline.picture, "Where a picture of them goes")
      ->type_name("OUT.png");
  app.add_option("--mesh", offline.mesh, "Where the converged shapes and parts go as triangles")
      ->type_name("OUT.ply");
  app.add_option("--repeat", offline.repeat, "Fits of each cloud; the median time is told")
      ->check(CLI::Range(1, 1000000));

  return RunApp(app, argc, argv, options, [&]() -> Status {
    const auto table = LoadConfig(options);
    if (!table) return table.error();
    auto config = pose::ReadPoseConfig(*table);
    if (!config) return config.error();
    if (!method.empty()) {
      const auto parsed = pose::ParseMethod(method);
      if (!parsed) return Error{"--method: " + parsed.error().message};
      config->fit.method = *parsed;
    }
    if (options.check_config) return {};
    const bool outputs = !offline.json.empty() || !offline.picture.empty() ||
                         !offline.mesh.empty() || !offline.labels.empty();
    if (offline.inputs.empty() && offline.list.empty() && !outputs) return Serve(options, *config);
    if (offline.json.empty()) return Error{"expected --json OUT.json with --input or --list"};
    return pose::RunOffline(offline, *config);
  });
}
