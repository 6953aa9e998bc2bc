// beckon-capture: publishes images of a camera, a file or the embedded scene; renders the latter
// offline.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "services/base/app.h"
#include "services/base/bus.h"
#include "services/base/progress.h"
#include "services/base/run_loop.h"
#include "services/capture/description_json.h"
#include "services/capture/frame_set_writer.h"
#include "services/capture/image_files.h"
#include "services/capture/object_set_writer.h"
#include "services/capture/options.h"
#include "services/capture/service.h"
#include "services/capture/source_choice.h"

namespace {

using namespace beckon;           // NOLINT: the program's own names
using namespace beckon::capture;  // NOLINT

Status WriteTruth(const capture::Options& options) {
  const auto description = DescribeInput(options);
  if (!description) return description.error();
  return WriteText(options.truth, ToJson(*description));
}

Status RenderObjects(const capture::Options& options) {
  Progress progress(isatty(STDERR_FILENO) != 0, {});
  return WriteObjectSet(
      options.out,
      {options.seed, options.per_category, options.views, options.sensor == "any", options.meshes},
      [&](size_t done, size_t all) { progress.Tell("rendering objects", done, all); });
}

Status Serve(const capture::Options& options, const AppOptions& app_options) {
  auto source = OpenSource(options);
  if (!source) return source.error();
  RunLoop loop(/*handle_signals=*/true);
  auto bus = OpenBus(app_options, "capture");
  if (!bus) return bus.error();
  loop.AddFd((*bus)->fd(), [&] { (*bus)->HandleReadable(); });
  const SystemClock clock;
  capture::Service service(*std::move(source), options.rate_hz, **bus, loop, clock);
  service.PublishNext();
  loop.Run();
  return service.status();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Publishes RGB-D images as BECKON_FRAME", "beckon-capture"};
  AppOptions app_options;
  capture::Options options;
  AddAppOptions(app, app_options);
  AddOptions(app, options);
  return RunApp(app, argc, argv, app_options, [&]() -> Status {
    auto config = LoadConfig(app_options);
    if (!config) return config.error();
    if (auto status = ReadConfig(app, *config, options); !status) return status;
    if (auto status = Check(app, options); !status) return status;
    if (app_options.check_config) return {};
    if (options.render) return WriteFrameSet(options.out, options.seed, options.frames);
    if (options.render_objects) return RenderObjects(options);
    if (!options.truth.empty()) return WriteTruth(options);
    return Serve(options, app_options);
  });
}
