// The cues there are, and the names for sets of them.
#include <algorithm>
#include <sstream>

#include "services/perception/cue_fpfh.h"
#include "services/perception/cue_hog.h"
#include "services/perception/cue_interface.h"
#include "services/perception/cue_own_frame.h"
#include "services/perception/cue_shape_statistics.h"
#include "services/perception/cue_sift.h"

namespace beckon::perception {
namespace {

/// A cloud that was taken without colour comes with none, or with all of it black.
bool HasColour(const ObjectView& view) {
  const auto& colour = view.image.colour;
  if (colour.size() != view.image.depth_m.size()) return false;
  return std::any_of(view.pixels.begin(), view.pixels.end(), [&](uint32_t pixel) {
    return pixel < colour.size() && colour[pixel] != Rgb{};
  });
}

/// A cue that looks at brightness.
template <typename SomeCue>
class OfColour : public SomeCue {
  bool CanSee(const CueView& view) const override { return HasColour(view.object); }
};

std::string Listed(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

}  // namespace

std::vector<std::unique_ptr<const Cue>> MakeCues() {
  std::vector<std::unique_ptr<const Cue>> cues;
  cues.push_back(std::make_unique<OfColour<SiftCue>>());
  cues.push_back(std::make_unique<OfColour<HogCue>>());
  cues.push_back(std::make_unique<FpfhCue>());
  cues.push_back(std::make_unique<ShapeStatisticsCue>());
  cues.push_back(std::make_unique<OwnFrameCue>());
  cues.push_back(std::make_unique<DepthHogCue>());
  return cues;
}

std::unique_ptr<const Cue> MakeCue(const std::string& name) {
  for (auto& cue : MakeCues()) {
    if (cue->name() == name) return std::move(cue);
  }
  return nullptr;
}

const std::vector<std::string>& DissertationCues() {
  static const std::vector<std::string> names = {"sift", "hog", "fpfh"};
  return names;
}

Result<std::vector<std::string>> ParseCueNames(const std::string& text,
                                               const std::vector<std::string>& known) {
  if (text == "all") return known;
  std::vector<std::string> wanted;
  if (text == "dissertation") {
    wanted = DissertationCues();
  } else {
    std::istringstream list(text);
    for (std::string name; std::getline(list, name, ',');) wanted.push_back(name);
  }
  for (const std::string& name : wanted) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    return Error{"no cue \"" + name + "\" here; expected all, dissertation, or some of " +
                 Listed(known) + " parted by commas"};
  }
  std::vector<std::string> out;
  for (const std::string& name : known) {
    if (std::find(wanted.begin(), wanted.end(), name) != wanted.end()) out.push_back(name);
  }
  if (out.empty())
    return Error{"no cue named; expected all, dissertation, or some of " + Listed(known)};
  return out;
}

}  // namespace beckon::perception
