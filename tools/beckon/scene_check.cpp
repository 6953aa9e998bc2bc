#include "tools/beckon/scene_check.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace beckon::tool {
namespace {

constexpr char kAdvice[] =
    "; expected a camera that looks down at a table with objects on it (see it with "
    "'beckon-perception --input FILE --picture seen.png'; perception.toml [segmentation] has the "
    "limits)";

}  // namespace

void SceneCheck::OnScene(const msg::Scene& scene) {
  ++scenes_;
  sources_.insert(scene.source);
  table_ = table_ || scene.has_table;
  objects_ = objects_ || (scene.has_table && !scene.objects.empty());
}

std::string SceneCheck::Complaint(const std::string& input, const std::string& perception) const {
  const size_t n = sources_.size();
  const std::string images = std::to_string(n) + " images";
  if (table_) {
    return input + ": a table was found" + (n == 1 ? "" : " (" + images + " seen)") +
           ", but no object on it" + kAdvice;
  }
  // "no table in view: why"
  const size_t colon = perception.find(": ");
  const std::string why = colon == std::string::npos ? ""
                                                     : (n == 1 ? " (" : " (the latest: ") +
                                                           perception.substr(colon + 2) + ")";
  return input + ": no table was found" + (n == 1 ? "" : " in any of " + images) + why + kAdvice;
}

size_t CountImages(const std::string& input) {
  namespace fs = std::filesystem;
  std::error_code none;
  size_t n = 0;
  for (const auto& entry : fs::directory_iterator(input, none)) {
    std::string type = entry.path().extension();
    std::ranges::transform(type, type.begin(), [](unsigned char c) { return std::tolower(c); });
    n += type == ".pcd" || type == ".ply" || type == ".xyz";
  }
  return std::max<size_t>(1, n);
}

}  // namespace beckon::tool
