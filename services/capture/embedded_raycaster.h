// Casts the rays of a pinhole camera into a scene of models (Embree) and shades what they hit.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "services/base/geometry.h"
#include "services/capture/embedded_model.h"

namespace beckon::capture {

/// A part of the image: columns u0 .. u0 + width - 1, rows v0 .. v0 + height - 1.
struct Window {
  int u0 = 0;
  int v0 = 0;
  int width = 640;
  int height = 480;

  size_t Size() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
};

/// A model put into the scene. The model must outlive the raycaster.
struct Instance {
  const Model* model = nullptr;
  Pose X_WO = Pose::Identity();
  uint16_t label = 0;  // 0 = table and room
};

struct Lighting {
  Eigen::Vector3d lamp_W{0, 0, 2};
  float ambient = 0.55f;
  float lamp = 0.5f;
  Eigen::Vector3f tint{1, 1, 1};
};

/// What the rays found, one entry a pixel of the window, row-major.
struct Rendering {
  Window window;
  std::vector<float> depth_m;           // along z; 0 = nothing hit
  std::vector<uint16_t> labels;         // of the instance hit
  std::vector<float> incidence;         // cosine between ray and surface normal
  std::vector<float> metal;             // Material::metal
  std::vector<uint8_t> unlit;           // 1 = hidden from the depth camera's projector
  std::vector<Eigen::Vector3f> colour;  // r g b, about 0 .. 255, not clipped
};

class Raycaster {
 public:
  /// `X_WC`: the camera in W.
  Raycaster(const std::vector<Instance>& instances, const Pose& X_WC);
  ~Raycaster();
  Raycaster(const Raycaster&) = delete;
  Raycaster& operator=(const Raycaster&) = delete;

  /// `random` softens the edges of the lamp's shadows.
  Rendering Render(const Intrinsics& intrinsics, const Window& window, const Lighting& lighting,
                   Random& random) const;

  /// Pixels of the window at which `label` is the nearest.
  int CountVisible(const Intrinsics& intrinsics, const Window& window, uint16_t label) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace beckon::capture
