// `beckon demo --picture`: the camera's image with what was recognised in it, beside the
// conversation.
#pragma once

#include <string>

#include "services/base/result.h"
#include "tools/beckon/demo_story.h"

namespace beckon::tool {

/// Refuses a file that could not be written, before anything is run.
Status CheckPicturePath(const std::string& path);

/// Draws objects with outlines, numbers from left to right, names and superquadrics, the grasp of
/// the first session's task, and that session's questions and answers. Fails where nothing was seen
/// or the file cannot be written.
Status WriteDemoPicture(const std::string& path, const DemoStory& story);

}  // namespace beckon::tool
