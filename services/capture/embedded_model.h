// Procedural objects of the eleven categories: shape, looks, and the poses they rest in.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "services/capture/embedded_mesh.h"
#include "services/capture/embedded_random.h"
#include "services/capture/embedded_texture.h"

namespace beckon::capture {

/// How a surface looks and what the depth camera makes of it.
struct Material {
  Texture texture;
  float gloss = 0.1f;  // strength of the highlight, 0 .. 1
  float metal = 0.0f;  // share of the depth that is lost to mirror reflection, 0 .. 1
};

/// An object in its own frame O: z is its axis, up when it stands; the origin is the centre of its
/// bounding box.
struct Model {
  std::string category;
  Mesh mesh;
  std::vector<Material> materials;
  double lying = 0;        // probability that it lies on its side
  double upside_down = 0;  // probability that it stands on its head
  bool any_face = false;   // a box: rests on any of its faces

  uint32_t AddMaterial(Texture texture, float gloss = 0.1f, float metal = 0.0f);
};

inline constexpr std::array<const char*, 11> kCategories = {
    "Bottle", "Bowl", "Box", "Can", "Carton", "Cup", "Mug", "SprayCan", "Tin", "Tube", "Tub"};

/// The category of things that are of none of those.
inline constexpr const char* kUnknown = "Unknown";

/// A fresh object of the category `kCategories[category]`.
Model MakeModel(size_t category, Random& random);

/// A fresh thing of no category: a book, a tool, a hand, crockery, fruit, a gadget.
Model MakeUnknownModel(Random& random);

/// Gives a model that was not made here the habits of its category; one of no category stands.
void RestLike(const std::string& category, Model& model);

/// One way the object rests on the plane z = 0: rotation, and height of O's origin; x = y = 0.
Pose RestingPose(const Model& model, Random& random);

}  // namespace beckon::capture
