// Whether an input shows what a conversation needs: a table with objects on it.
#pragma once

#include <set>
#include <string>

#include "lcmtypes/messages.h"

namespace beckon::tool {

/// Feed it every SCENE until something usable was seen, or all of the input was.
class SceneCheck {
 public:
  /// `images`: how many different ones the input has; 1 for a still image.
  explicit SceneCheck(size_t images) : images_(images) {}

  void OnScene(const msg::Scene& scene);

  bool saw_scene() const { return scenes_ > 0; }
  bool saw_table() const { return table_; }
  /// Objects on a table were seen at least once.
  bool usable() const { return objects_; }
  /// Every image was seen, and more than one SCENE: nothing new is to be expected.
  bool complete() const { return scenes_ >= 2 && sources_.size() >= images_; }

  /// What is missing, why, and what to do. `input`: as named by the user, e.g. "--input wall.pcd";
  /// `perception`: what perception says of itself.
  std::string Complaint(const std::string& input, const std::string& perception) const;

 private:
  size_t images_;
  size_t scenes_ = 0;
  std::set<std::string> sources_;
  bool table_ = false;
  bool objects_ = false;
};

/// How many images capture shows of a file or folder; 1 for anything but a folder.
size_t CountImages(const std::string& input);

}  // namespace beckon::tool
