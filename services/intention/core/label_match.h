// Recognising an object that the user has named before.
#pragma once

#include <string>
#include <vector>

#include "services/intention/core/memory.h"

namespace beckon::intention {

struct LabelMatchConfig {
  double place_m = 0.03;   // most that the centroid may have moved
  double extent_m = 0.03;  // most that each edge may have changed
  double likeness = 0.35;  // most total variation between perception's opinions then and now, 0..1
};

/// The category that the newest label for this object gives, nullptr where there is none. Same
/// source, same place, same looks.
const LabelRecord* FindLabel(const std::vector<LabelRecord>& labels, const std::string& source,
                             const msg::SceneObject& object, const LabelMatchConfig& config = {});

/// Edges of similar lengths, similar opinions of perception. What is not known of one of them (no
/// extent, no opinion) may be as the other's.
bool LooksAlike(const msg::SceneObject& a, const msg::SceneObject& b,
                const LabelMatchConfig& config = {});

}  // namespace beckon::intention
