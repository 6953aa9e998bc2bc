// The cues there are.
#include "services/perception/cue_fpfh.h"
#include "services/perception/cue_hog.h"
#include "services/perception/cue_interface.h"
#include "services/perception/cue_own_frame.h"
#include "services/perception/cue_shape_statistics.h"
#include "services/perception/cue_sift.h"

namespace beckon::perception {

std::vector<std::unique_ptr<const Cue>> MakeCues() {
  std::vector<std::unique_ptr<const Cue>> cues;
  cues.push_back(std::make_unique<SiftCue>());
  cues.push_back(std::make_unique<HogCue>());
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

}  // namespace beckon::perception
