// Between what was perceived and the SCENE message.
#pragma once

#include "lcmtypes/messages.h"
#include "services/perception/perceiver.h"

namespace beckon::perception {

/// Most points an object's thinned cloud has in a SCENE.
inline constexpr int kMaxSamples = 600;

/// The scene of a frame, with the rims of its objects; `seq` and what comes of the frame are left
/// to the caller. Objects share what one datagram has room for, so that the encoded message never
/// passes msg::kMaxDatagram. An object that spans more than 3 m, which the message cannot say, is
/// left out.
msg::Scene MakeScene(const RgbdImage& image, const Perception& perception);

}  // namespace beckon::perception
