// Assimp's scenes to models of the embedded scene.
#include "services/capture/mesh_files.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <set>

namespace beckon::capture {
namespace {

namespace fs = std::filesystem;

Texture FromImage(const cv::Mat& bgr) {
  Texture texture;
  texture.width = bgr.cols;
  texture.height = bgr.rows;
  texture.pixels.reserve(bgr.total());
  for (int y = 0; y < bgr.rows; ++y) {
    for (int x = 0; x < bgr.cols; ++x) {
      const auto& p = bgr.at<cv::Vec3b>(y, x);
      texture.pixels.push_back({p[2], p[1], p[0]});
    }
  }
  return texture;
}

/// The material's picture, else its colour, else `paint` where it has none (or is plain white).
Texture ReadTexture(const aiMaterial& material, const fs::path& folder, const Texture& paint) {
  aiString name;
  if (material.GetTexture(aiTextureType_DIFFUSE, 0, &name) == AI_SUCCESS) {
    const cv::Mat image = cv::imread((folder / name.C_Str()).string(), cv::IMREAD_COLOR);
    if (!image.empty()) return FromImage(image);
  }
  aiColor3D colour(1, 1, 1);
  material.Get(AI_MATKEY_COLOR_DIFFUSE, colour);
  if (colour.r > 0.99f && colour.g > 0.99f && colour.b > 0.99f) return paint;
  const auto byte = [](float c) { return static_cast<uint8_t>(std::clamp(c, 0.0f, 1.0f) * 255); };
  return PlainTexture({byte(colour.r), byte(colour.g), byte(colour.b)});
}

void Append(const aiMesh& from, Mesh& to) {
  const auto first = static_cast<uint32_t>(to.positions.size());
  for (unsigned i = 0; i < from.mNumVertices; ++i) {
    const aiVector3D& p = from.mVertices[i];
    to.positions.emplace_back(p.x, p.y, p.z);
    const aiVector3D uv = from.HasTextureCoords(0) ? from.mTextureCoords[0][i] : aiVector3D();
    to.uv.emplace_back(uv.x, uv.y);
  }
  for (unsigned i = 0; i < from.mNumFaces; ++i) {
    const aiFace& face = from.mFaces[i];
    if (face.mNumIndices != 3) continue;
    to.triangles.push_back(
        {{first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]},
         from.mMaterialIndex});
  }
}

/// Puts the middle of the bounding box into the origin.
Status Centre(Mesh& mesh, const std::string& path) {
  Eigen::AlignedBox3f box;
  for (const auto& p : mesh.positions) {
    if (!p.allFinite()) return Error{path + ": holds a position that is not a number"};
    box.extend(p);
  }
  const float size = mesh.positions.empty() ? 0 : box.sizes().maxCoeff();
  if (size < 0.01f || size > 1.5f) {
    return Error{path + ": expected an object of 0.01 .. 1.5 m, found " + std::to_string(size) +
                 "; meshes are in metres with z up"};
  }
  for (auto& p : mesh.positions) p -= box.center();
  return {};
}

}  // namespace

Result<std::vector<MeshRecord>> ListMeshes(const std::string& folder) {
  static const std::set<std::string> kEndings = {".obj", ".ply", ".stl", ".dae", ".glb", ".gltf"};
  std::vector<MeshRecord> meshes;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    if (!kEndings.contains(it->path().extension().string())) continue;
    const fs::path relative = it->path().lexically_relative(folder);
    if (std::distance(relative.begin(), relative.end()) != 2) continue;
    meshes.push_back({it->path().string(), relative.begin()->string(), it->path().stem().string()});
  }
  if (error) return Error{folder + ": cannot be listed (" + error.message() + ")"};
  if (meshes.empty()) {
    return Error{folder + ": expected meshes as <Category>/*.obj (ply, stl, dae, glb), found none"};
  }
  std::sort(meshes.begin(), meshes.end(),
            [](const MeshRecord& a, const MeshRecord& b) { return a.path < b.path; });
  return meshes;
}

Result<Model> ReadMesh(const MeshRecord& record, Random& random) {
  Assimp::Importer importer;
  const aiScene* scene =
      importer.ReadFile(record.path, aiProcess_Triangulate | aiProcess_JoinIdenticalVertices |
                                         aiProcess_PreTransformVertices | aiProcess_SortByPType);
  if (scene == nullptr || scene->mNumMeshes == 0) {
    return Error{record.path + ": cannot be read as a mesh (" + importer.GetErrorString() + ")"};
  }
  Model model;
  model.category = record.category;
  RestLike(record.category, model);
  const Texture paint = PlainTexture(PackagingColour(random));
  for (unsigned i = 0; i < scene->mNumMaterials; ++i) {
    model.AddMaterial(
        ReadTexture(*scene->mMaterials[i], fs::path(record.path).parent_path(), paint), 0.3f);
  }
  if (model.materials.empty()) model.AddMaterial(paint, 0.3f);
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) Append(*scene->mMeshes[i], model.mesh);
  for (auto& triangle : model.mesh.triangles) {
    triangle.material =
        std::min(triangle.material, static_cast<uint32_t>(model.materials.size() - 1));
  }
  if (model.mesh.triangles.empty()) {
    return Error{record.path + ": expected a surface of triangles, found none"};
  }
  if (model.mesh.triangles.size() > kMostTriangles) {
    return Error{record.path + ": expected at most " + std::to_string(kMostTriangles) +
                 " triangles, found " + std::to_string(model.mesh.triangles.size()) +
                 "; simplify the mesh"};
  }
  if (auto status = Centre(model.mesh, record.path); !status) return status.error();
  return model;
}

}  // namespace beckon::capture
