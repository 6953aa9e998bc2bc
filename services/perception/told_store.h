// Views of objects that the user named, in a folder as beckon-train reads it:
// <Category>/told-<id>__<n>.pcd with siblings _rgb.png _depth.png _mask.png, and a row of
// manifest.csv. What a crash leaves half-written is no view.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "services/perception/told_examples.h"

namespace beckon::perception {

struct ToldStoreConfig {
  std::string folder;     // made with the first view
  int most_views = 2000;  // of all objects; further ones are refused
};

class ToldStore {
 public:
  /// Reads what is there. A view that cannot be read is left out, and named in warnings(). Fails
  /// where the folder cannot be made, written or listed, or its manifest is none of ours.
  static Result<ToldStore> Open(const ToldStoreConfig& config);

  /// What was read: looks, with the objects' names for their label.
  const std::vector<ToldExample>& loaded() const { return loaded_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  int n_views() const { return static_cast<int>(files_.size()); }

  /// On disk when this returns. Fails (full disk, no permission, too many) without a trace.
  Status Add(const std::string& label_id, const std::string& category, const ObjectView& view);
  /// All views of an object.
  Status Remove(const std::string& label_id);

  /// The name by which files call the object of a label; the same for that name.
  static std::string NameOf(const std::string& label_id);

 private:
  explicit ToldStore(ToldStoreConfig config) : config_(std::move(config)) {}
  Status Load();
  Status WriteManifest(const std::vector<std::string>& lines) const;

  ToldStoreConfig config_;
  std::vector<ToldExample> loaded_;
  std::vector<std::string> warnings_;
  std::vector<std::string> lines_;            // of the manifest, the header first
  std::map<std::string, std::string> files_;  // "Mug/told-12ab__0.pcd" to the object's name
};

}  // namespace beckon::perception
