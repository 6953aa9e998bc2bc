// A lab's own object meshes, to render training views of: whatever Assimp reads.
#pragma once

#include <string>
#include <vector>

#include "services/base/result.h"
#include "services/capture/embedded_model.h"

namespace beckon::capture {

/// A mesh file as it is listed, not yet read.
struct MeshRecord {
  std::string path;
  std::string category;  // the folder it lies in
  std::string instance;  // its name without the ending
};

/// All of <Category>/*.{obj,ply,stl,dae,glb,gltf} in `folder`, sorted by name. Fails where the
/// folder cannot be read or holds none.
Result<std::vector<MeshRecord>> ListMeshes(const std::string& folder);

/// Reads a mesh in metres, z up, 1 cm to 1.5 m large, of at most kMostTriangles, with its textures;
/// one without colours is painted at random. It rests as things of its category do.
Result<Model> ReadMesh(const MeshRecord& record, Random& random);

inline constexpr size_t kMostTriangles = 500'000;

}  // namespace beckon::capture
