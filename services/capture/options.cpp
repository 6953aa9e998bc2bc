#include "services/capture/options.h"

#include <CLI/CLI.hpp>

namespace beckon::capture {
namespace {

constexpr double kSlowest_hz = 0.01, kFastest_hz = 60;
constexpr int kMostFrames = 100'000;

bool Given(const CLI::App& app, const char* flag) { return app.count(flag) > 0; }

}  // namespace

void AddOptions(CLI::App& app, Options& options) {
  app.add_option("--input", options.input,
                 "A PCD, PLY or XYZ file, or a folder of them (default: the embedded scene)")
      ->type_name("FILE|FOLDER");
  app.add_option("--embedded-seed", options.embedded_seed, "Which embedded scene (default 1)")
      ->type_name("N");
  app.add_option("--rate", options.rate_hz, "Frames a second (default 2)")->type_name("HZ");
  app.add_flag("--once", options.once,
               "A folder: leave after its last file instead of starting over");
  app.add_option("--intrinsics", options.intrinsics,
                 "The camera of the input, px (default: told from the file)")
      ->delimiter(',')
      ->expected(4)
      ->type_name("fx,fy,cx,cy");
  app.add_option("--truth", options.truth,
                 "Write what is known of the input's ground truth as JSON, and leave")
      ->type_name("FILE");
  app.add_flag("--render", options.render,
               "Write frames of the embedded scene with ground truth to --out, and leave");
  app.add_flag("--render-objects", options.render_objects,
               "Write single objects to train a categoriser with to --out, and leave");
  app.add_option("--seed", options.seed, "Of what is rendered (default 1)")->type_name("N");
  app.add_option("--frames", options.frames, "How many frames --render writes (default 1)")
      ->type_name("N");
  app.add_option("--per-category", options.per_category,
                 "How many objects --render-objects makes of each category (default 90)")
      ->type_name("N");
  app.add_option(
         "--sensor", options.sensor,
         "Render as a Kinect would see it, or as any of several depth cameras (default any)")
      ->check(CLI::IsMember({"kinect", "any"}));
  app.add_option("--views", options.views, "How many views of each object (default 2)")
      ->type_name("N");
  app.add_option(
         "--meshes", options.meshes,
         "--render-objects renders these too: <Category>/*.obj (ply, stl, dae, glb), in metres, "
         "z up")
      ->type_name("FOLDER");
  app.add_option("--out", options.out, "Folder for what is rendered")->type_name("FOLDER");
}

Status ReadConfig(const CLI::App& app, ConfigTable& config, Options& options) {
  Options from_file = options;
  int seed = static_cast<int>(options.embedded_seed);
  config.Get("input", from_file.input);
  config.Get("embedded_seed", seed, 0);
  config.Get("rate_hz", from_file.rate_hz, kSlowest_hz, kFastest_hz);
  config.Get("once", from_file.once);
  config.Get("intrinsics", from_file.intrinsics);
  if (!from_file.intrinsics.empty() && from_file.intrinsics.size() != 4) {
    config.Fail("intrinsics", "expected four numbers, [fx, fy, cx, cy] in px");
  }
  if (auto status = config.Finish(); !status) return status;
  // Flags win over the file.
  if (!Given(app, "--input")) options.input = from_file.input;
  if (!Given(app, "--embedded-seed") && config.Has("embedded_seed"))
    options.embedded_seed = static_cast<uint64_t>(seed);
  if (!Given(app, "--rate")) options.rate_hz = from_file.rate_hz;
  if (!Given(app, "--once")) options.once = from_file.once;
  if (!Given(app, "--intrinsics")) options.intrinsics = from_file.intrinsics;
  return {};
}

Status Check(const CLI::App& app, const Options& options) {
  if (!(options.rate_hz >= kSlowest_hz && options.rate_hz <= kFastest_hz)) {
    return Error{"--rate: expected 0.01 .. 60 Hz, found " + std::to_string(options.rate_hz)};
  }
  if (const auto camera = GivenIntrinsics(options)) {
    if (auto status = Validate(*camera); !status)
      return Error{"--intrinsics: " + status.error().message};
  }
  const bool offline = options.render || options.render_objects;
  if (options.render && options.render_objects)
    return Error{"--render and --render-objects: expected one of them"};
  if (offline && options.out.empty()) return Error{"--out: expected the folder to write to"};
  if (offline && (!options.input.empty() || !options.truth.empty())) {
    return Error{"--render and --render-objects take neither --input nor --truth"};
  }
  if (!offline && !options.out.empty())
    return Error{"--out goes with --render or --render-objects"};
  if (options.frames < 1 || options.frames > kMostFrames)
    return Error{"--frames: expected 1 .. 100000"};
  const int fewest = options.meshes.empty() ? 1 : 0;
  if (options.per_category < fewest || options.per_category > kMostFrames) {
    return Error{"--per-category: expected 1 .. 100000, or 0 with --meshes"};
  }
  if (options.views < 1 || options.views > kMostFrames)
    return Error{"--views: expected 1 .. 100000"};
  if (!options.render_objects &&
      (!options.meshes.empty() || Given(app, "--views") || Given(app, "--sensor")))
    return Error{"--meshes, --views and --sensor go with --render-objects"};
  if (!options.input.empty() && Given(app, "--embedded-seed")) {
    return Error{"--embedded-seed goes without --input"};
  }
  return {};
}

std::optional<Intrinsics> GivenIntrinsics(const Options& options) {
  const auto& k = options.intrinsics;
  if (k.size() != 4) return std::nullopt;
  return Intrinsics{k[0], k[1], k[2], k[3]};
}

}  // namespace beckon::capture
