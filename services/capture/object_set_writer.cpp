#include "services/capture/object_set_writer.h"

#include <array>
#include <cstdio>

#include "services/base/cloud_file.h"
#include "services/capture/embedded_object_view.h"
#include "services/capture/image_files.h"

namespace beckon::capture {
namespace {

constexpr int kViews = 2;
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
  std::snprintf(last.data(), last.size(), ",%.3f,%s,%.5f,%.5f,%.5f\n", view.visible_share,
                instance.c_str(), view.up_C.x(), view.up_C.y(), view.up_C.z());
  return stem + ".pcd," + category + "," + instance + ",view" + std::to_string(view_number) + "," +
         std::to_string(points) + ",rendered,m,\"camera optical (x right, y down, z forward)\"," +
         numbers.data() + "," + stem + "_rgb.png," + stem + "_depth.png," + stem + "_mask.png" +
         last.data();
}

Status WriteView(const std::string& path, const ObjectView& view, const Cloud& cloud) {
  const int w = view.crop.width, h = view.crop.height;
  if (auto status = WritePcdFile(path + ".pcd", cloud); !status) return status;
  if (auto status = WriteColourPng(path + "_rgb.png", w, h, view.colour); !status) return status;
  if (auto status = WriteGreyPng(path + "_mask.png", w, h, view.mask); !status) return status;
  return Write16BitPng(path + "_depth.png", w, h, Millimetres(view.depth_m));
}

}  // namespace

Status WriteObjectSet(const std::string& folder, uint64_t seed, int per_category) {
  std::string manifest = kColumns;
  for (size_t c = 0; c < kCategories.size(); ++c) {
    const std::string category = kCategories[c];
    if (auto status = MakeFolder(folder + "/" + category); !status) return status;
    for (int i = 0; i < per_category; ++i) {
      Random random(Random::Mix(seed, c * 1'000'000 + static_cast<uint64_t>(i)));
      const Model model = MakeModel(c, random);
      std::array<char, 16> number{};
      std::snprintf(number.data(), number.size(), "%04d", i);
      const std::string instance = category + "_" + number.data();
      for (int v = 0; v < kViews; ++v) {
        const ObjectView view = RenderObjectView(model, random);
        const Cloud cloud = ObjectCloud(view);
        const std::string stem = category + "/" + instance + "_view" + std::to_string(v);
        if (auto status = WriteView(folder + "/" + stem, view, cloud); !status) return status;
        manifest += ManifestLine(view, stem, category, instance, v, cloud.points.size());
      }
    }
  }
  return WriteText(folder + "/manifest.csv", manifest);
}

}  // namespace beckon::capture
