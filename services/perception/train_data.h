// Views of single objects in folders: <Category>/*.pcd with siblings *_rgb.png *_depth.png
// *_mask.png and a manifest.csv, or <Category>/<instance>/*.pcd, or either without the manifest.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "services/perception/object_view.h"

namespace beckon::perception {

/// One view as it is listed, not yet read.
struct ViewRecord {
  std::string file;                            // relative to the folder, "Mug/a_0.pcd"
  std::string path;                            // to open
  std::string category;                        // "Mug"
  std::string instance;                        // the physical object; views of one never part
  std::optional<Eigen::Vector3d> up_C;         // the table's normal
  std::optional<Intrinsics> intrinsics;        // of the whole image
  std::optional<std::pair<int, int>> crop_px;  // u, v of the sibling images' corner in it
};

/// A view in memory.
struct LoadedView {
  RgbdImage image;
  std::vector<uint32_t> pixels;
  std::optional<Plane> table_C;

  ObjectView view() const { return {image, pixels, table_C}; }
};

/// All .pcd files of the folder, sorted by name. The instance is the manifest's `product`, else its
/// `instance`, else the sub-folder, else the name up to its last "__" or "_". Fails where the
/// folder cannot be read, holds no view, or its manifest is garbled.
Result<std::vector<ViewRecord>> ListViews(const std::string& folder);

/// From the sibling images where they and their crop are known, else from the cloud.
Result<LoadedView> LoadView(const ViewRecord& record);

/// A CSV file with a header line and quoted fields: one map a row, by column name.
Result<std::vector<std::map<std::string, std::string>>> ReadCsv(const std::string& path);

}  // namespace beckon::perception
