#include "services/capture/object_set_writer.h"

#include <array>
#include <atomic>
#include <cstdio>
#include <mutex>
#include <optional>
#include <thread>

#include "services/base/cloud_file.h"
#include "services/capture/embedded_object_view.h"
#include "services/capture/image_files.h"
#include "services/capture/mesh_files.h"

namespace beckon::capture {
namespace {

constexpr char kColumns[] =
    "file,category,instance,view,points,kind,units,frame,fx,fy,cx,cy,crop_x,crop_y,crop_w,crop_h,"
    "rgb_crop,depth_crop_mm,mask_crop,visible_share,product,up_x,up_y,up_z\n";

Cloud ObjectCloud(const ObjectView& view) {
  Cloud cloud;
  for (int v = 0; v < view.crop.height; ++v) {
    for (int u = 0; u < view.crop.width; ++u) {
      const size_t i = static_cast<size_t>(v) * view.crop.width + u;
      if (view.mask[i] == 0) continue;
      cloud.points.push_back(
          view.intrinsics.Unproject(view.crop.u0 + u, view.crop.v0 + v, view.depth_m[i])
              .cast<float>());
      cloud.colours.push_back(view.colour[i]);
    }
  }
  cloud.width = static_cast<int>(cloud.points.size());
  return cloud;
}

std::string ManifestLine(const ObjectView& view, const std::string& stem,
                         const std::string& category, const std::string& instance, int view_number,
                         size_t points) {
  std::array<char, 160> numbers{};
  const auto& k = view.intrinsics;
  std::snprintf(numbers.data(), numbers.size(), "%.1f,%.1f,%.1f,%.1f,%d,%d,%d,%d", k.fx, k.fy, k.cx,
                k.cy, view.crop.u0, view.crop.v0, view.crop.width, view.crop.height);
  std::array<char, 96> last{};
  std::snprintf(last.data(), last.size(), ",%.3f,", view.visible_share);
  std::array<char, 64> up{};
  if (view.up_C) {
    std::snprintf(up.data(), up.size(), "%.5f,%.5f,%.5f", view.up_C->x(), view.up_C->y(),
                  view.up_C->z());
  } else {
    std::snprintf(up.data(), up.size(), ",,");
  }
  return stem + ".pcd," + category + "," + instance + ",view" + std::to_string(view_number) + "," +
         std::to_string(points) + ",rendered,m,\"camera optical (x right, y down, z forward)\"," +
         numbers.data() + "," + stem + "_rgb.png," + stem + "_depth.png," + stem + "_mask.png" +
         last.data() + instance + "," + up.data() + "\n";
}

Status WriteView(const std::string& path, const ObjectView& view, const Cloud& cloud) {
  const int w = view.crop.width, h = view.crop.height;
  if (auto status = WritePcdFile(path + ".pcd", cloud); !status) return status;
  if (auto status = WriteColourPng(path + "_rgb.png", w, h, view.colour); !status) return status;
  if (auto status = WriteGreyPng(path + "_mask.png", w, h, view.mask); !status) return status;
  return Write16BitPng(path + "_depth.png", w, h, Millimetres(view.depth_m));
}

/// An object to render.
struct Job {
  std::string category;
  std::string instance;
  uint64_t seed = 0;
  std::function<Result<Model>(Random&)> make;
};

std::string Numbered(const std::string& category, int number) {
  std::array<char, 16> digits{};
  std::snprintf(digits.data(), digits.size(), "_%04d", number);
  return category + digits.data();
}

Result<std::vector<Job>> PlanJobs(const ObjectSetPlan& plan) {
  std::vector<Job> jobs;
  for (size_t c = 0; c <= kCategories.size(); ++c) {
    const bool known = c < kCategories.size();
    const std::string category = known ? kCategories[c] : kUnknown;
    const int count = known ? plan.per_category : 2 * plan.per_category;
    for (int i = 0; i < count; ++i) {
      jobs.push_back({category, Numbered(category, i),
                      Random::Mix(plan.seed, c * 1'000'000 + static_cast<uint64_t>(i)),
                      [c, known](Random& random) -> Result<Model> {
                        return known ? MakeModel(c, random) : MakeUnknownModel(random);
                      }});
    }
  }
  if (plan.meshes.empty()) return jobs;
  const auto meshes = ListMeshes(plan.meshes);
  if (!meshes) return meshes.error();
  for (size_t i = 0; i < meshes->size(); ++i) {
    const MeshRecord& mesh = (*meshes)[i];
    jobs.push_back({mesh.category, mesh.instance, Random::Mix(plan.seed, 100'000'000 + i),
                    [mesh](Random& random) { return ReadMesh(mesh, random); }});
  }
  return jobs;
}

/// Renders and writes all views of one object; its lines of the manifest.
Result<std::string> WriteObject(const std::string& folder, const Job& job,
                                const ObjectSetPlan& plan) {
  Random random(job.seed);
  const Result<Model> model = job.make(random);
  if (!model) return model.error();
  std::string lines;
  for (int v = 0; v < plan.views; ++v) {
    const auto view = RenderObjectView(*model, plan.any_camera, random);
    if (!view) {
      return Error{
          job.category + "/" + job.instance +
          ": fits no view of a table; expected an object of 2 to 40 cm or so, leave it out"};
    }
    const Cloud cloud = ObjectCloud(*view);
    const std::string stem = job.category + "/" + job.instance + "_view" + std::to_string(v);
    if (auto status = WriteView(folder + "/" + stem, *view, cloud); !status) return status.error();
    lines += ManifestLine(*view, stem, job.category, job.instance, v, cloud.points.size());
  }
  return lines;
}

}  // namespace

Status WriteObjectSet(const std::string& folder, const ObjectSetPlan& plan,
                      const std::function<void(size_t, size_t)>& progress) {
  const auto jobs = PlanJobs(plan);
  if (!jobs) return jobs.error();
  for (const Job& job : *jobs) {
    if (auto status = MakeFolder(folder + "/" + job.category); !status) return status;
  }
  std::vector<std::string> lines(jobs->size());
  std::atomic<size_t> next = 0;
  std::mutex mutex;
  std::optional<Error> failure;
  size_t done = 0;
  const auto work = [&] {
    for (size_t i = next++; i < jobs->size(); i = next++) {
      Result<std::string> written = WriteObject(folder, (*jobs)[i], plan);
      const std::lock_guard lock(mutex);
      if (!written) failure = written.error();
      if (failure) return;
      lines[i] = std::move(*written);
      if (progress) progress(++done, jobs->size());
    }
  };
  {
    std::vector<std::jthread> threads;
    for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i) threads.emplace_back(work);
    work();
  }
  if (failure) return *failure;
  std::string manifest = kColumns;
  for (const std::string& line : lines) manifest += line;
  return WriteText(folder + "/manifest.csv", manifest);
}

}  // namespace beckon::capture
