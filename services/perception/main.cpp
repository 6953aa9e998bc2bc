// beckon-perception: sees the table and what stands on it, on the bus or in a file.
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <opencv2/core/utility.hpp>

#include "services/base/app.h"
#include "services/perception/offline.h"
#include "services/perception/options.h"
#include "services/perception/service.h"

namespace {

using namespace beckon;
using namespace beckon::perception;

Status Serve(const PerceptionConfig& config, const AppOptions& app) {
  auto categoriser = LoadCategoriser(config);
  if (!categoriser) return categoriser.error();
  RunLoop loop(true);  // before threads start: it blocks signals for all of them
  auto bus = OpenBus(app, "perception");
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
  perception::Options options;
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
    return Serve(*config, options.app);
  });
}
