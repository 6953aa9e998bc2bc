// What remembering objects costs a frame: `ObjectMemory::Update` on frames of a table with noise of
// their own, in CPU time of the thread. Prints the figures; writes JSON.
#include <time.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "services/base/app.h"
#include "services/perception/object_memory.h"
#include "tests/perception/steady_table.h"

namespace beckon::perception {
namespace {

struct Options {
  uint64_t seed = 3;
  int objects = 8;
  int frames = 20;
  int repeat = 20;
  std::string json;
};

/// CPU time of this thread: other programs on the machine do not count.
double CpuMilliseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

Status Run(const Options& options) {
  const SegmentationConfig config;
  SteadyTable table(options.seed, options.objects);
  std::vector<RgbdImage> images;
  std::vector<Segmentation> segmentations;
  for (int frame = 0; frame < options.frames; ++frame) {
    images.push_back(table.Next());
    segmentations.push_back(Segment(images.back(), config));
  }
  ObjectMemory memory({}, config.sensor);
  std::vector<double> times_ms;
  size_t n_objects = 0;
  for (int i = 0; i < options.repeat * options.frames; ++i) {
    const size_t frame = static_cast<size_t>(i) % images.size();
    Segmentation segmentation = segmentations[frame];
    const double before_ms = CpuMilliseconds();
    n_objects = memory.Update(images[frame], config.max_objects, segmentation).ids.size();
    times_ms.push_back(CpuMilliseconds() - before_ms);
  }
  std::ranges::sort(times_ms);
  const double median_ms = times_ms[times_ms.size() / 2];
  const double p95_ms = times_ms[times_ms.size() * 95 / 100];
  std::printf(
      "ObjectMemory::Update, %zu objects: CPU ms a frame: median %.3f, p95 %.3f, min %.3f\n",
      n_objects, median_ms, p95_ms, times_ms.front());
  if (options.json.empty()) return {};
  const nlohmann::ordered_json out = {{"version", VersionString()},
                                      {"objects", n_objects},
                                      {"median_ms", median_ms},
                                      {"p95_ms", p95_ms},
                                      {"min_ms", times_ms.front()}};
  std::ofstream(options.json) << out.dump(1) << '\n';
  return {};
}

}  // namespace
}  // namespace beckon::perception

int main(int argc, char** argv) {
  CLI::App app("Times what remembering objects costs a frame", "beckon-bench-memory");
  beckon::AppOptions common;
  beckon::AddAppOptions(app, common);
  beckon::perception::Options options;
  app.add_option("--seed", options.seed, "Of the table")->capture_default_str();
  app.add_option("--objects", options.objects, "On it")->capture_default_str();
  app.add_option("--frames", options.frames, "Different ones")->capture_default_str();
  app.add_option("--repeat", options.repeat, "Times each is seen")->capture_default_str();
  app.add_option("--json", options.json, "Write the figures here as well");
  return beckon::RunApp(app, argc, argv, common, [&] { return beckon::perception::Run(options); });
}
