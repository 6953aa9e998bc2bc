#include "services/capture/embedded_raycaster.h"

#include <embree3/rtcore.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace beckon::capture {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// The infrared projector stands this far right of the camera.
constexpr float kProjector_m = 0.075f;
constexpr float kSurfaceGap_m = 0.0015f;

/// One device for the process. A fixed instruction set, so that every machine finds the same hits.
RTCDevice Device() {
  static RTCDevice device = rtcNewDevice("threads=1,isa=sse4.2");
  if (device == nullptr) throw std::runtime_error("Embree could not be started");
  return device;
}

/// A model's mesh in C, with normals averaged at its vertices.
struct Body {
  const Model* model;
  uint16_t label;
  std::vector<Eigen::Vector3f> positions_C;
  std::vector<Eigen::Vector3f> normals_C;
};

Body MakeBody(const Instance& instance, const Pose& X_CW) {
  const Mesh& mesh = instance.model->mesh;
  const Pose X_CO = X_CW * instance.X_WO;
  Body body{instance.model, instance.label, {}, {}};
  body.positions_C.reserve(mesh.positions.size());
  for (const auto& p : mesh.positions) {
    body.positions_C.push_back((X_CO * p.cast<double>()).cast<float>());
  }
  body.normals_C.assign(mesh.positions.size(), Eigen::Vector3f::Zero());
  for (const auto& triangle : mesh.triangles) {
    const auto& [a, b, c] = triangle.corners;
    const Eigen::Vector3f normal = (body.positions_C[b] - body.positions_C[a])
                                       .cross(body.positions_C[c] - body.positions_C[a]);
    for (uint32_t corner : triangle.corners) body.normals_C[corner] += normal;
  }
  return body;
}

void Attach(RTCScene scene, const Body& body) {
  RTCGeometry geometry = rtcNewGeometry(Device(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, body.positions_C.size()));
  for (size_t i = 0; i < body.positions_C.size(); ++i) {
    for (int k = 0; k < 3; ++k) positions[3 * i + k] = body.positions_C[i][k];
  }
  const auto& triangles = body.model->mesh.triangles;
  auto* corners = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, triangles.size()));
  for (size_t i = 0; i < triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) corners[3 * i + k] = triangles[i].corners[k];
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

RTCRay MakeRay(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float near,
               float far) {
  RTCRay ray{};
  ray.org_x = origin.x();
  ray.org_y = origin.y();
  ray.org_z = origin.z();
  ray.dir_x = direction.x();
  ray.dir_y = direction.y();
  ray.dir_z = direction.z();
  ray.tnear = near;
  ray.tfar = far;
  ray.mask = ~0u;
  return ray;
}

Eigen::Vector3f Direction(const Intrinsics& intrinsics, int u, int v) {
  return intrinsics.Unproject(u, v, 1.0).cast<float>();
}

}  // namespace

struct Raycaster::State {
  RTCScene scene = nullptr;
  Pose X_CW = Pose::Identity();
  std::vector<Body> bodies;

  RTCRayHit Hit(const Eigen::Vector3f& direction) const {
    RTCRayHit hit{};
    hit.ray = MakeRay(Eigen::Vector3f::Zero(), direction, 0.05f, kInfinity);
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect1(scene, &context, &hit);
    return hit;
  }

  bool Occluded(const Eigen::Vector3f& from, const Eigen::Vector3f& to) const {
    RTCRay ray = MakeRay(from, to - from, 0.0f, 0.999f);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &ray);
    return ray.tfar < 0;
  }

  /// Light of the lamp that a point returns: scattered, and mirrored as a highlight (Blinn).
  std::pair<float, float> LampLight(const Eigen::Vector3f& point, const Eigen::Vector3f& normal,
                                    const Eigen::Vector3f& to_eye, const Eigen::Vector3f& lamp,
                                    const Material& material, Random& random) const;
  void Shade(const RTCRayHit& hit, size_t pixel, const Lighting& lighting, Random& random,
             Rendering& out) const;
};

std::pair<float, float> Raycaster::State::LampLight(
    const Eigen::Vector3f& point, const Eigen::Vector3f& normal, const Eigen::Vector3f& to_eye,
    const Eigen::Vector3f& lamp, const Material& material, Random& random) const {
  constexpr int kSamples = 3;
  constexpr float kLampRadius_m = 0.1f;
  constexpr float kInShadow = 0.15f;
  float diffuse = 0, highlight = 0;
  for (int i = 0; i < kSamples; ++i) {
    const float x = random.Normal(), y = random.Normal(), z = random.Normal();
    const Eigen::Vector3f spot = lamp + Eigen::Vector3f(x, y, z) * kLampRadius_m;
    const Eigen::Vector3f to_lamp = (spot - point).normalized();
    const float facing = normal.dot(to_lamp);
    if (facing <= 0) continue;
    if (Occluded(point, spot)) {
      diffuse += kInShadow * facing;
      continue;
    }
    diffuse += facing;
    const float half = normal.dot((to_lamp + to_eye).normalized());
    if (material.gloss > 0.05f && half > 0.8f) {
      highlight += 180.0f * material.gloss * std::pow(half, 40.0f);
    }
  }
  return {diffuse / kSamples, highlight / kSamples};
}

void Raycaster::State::Shade(const RTCRayHit& hit, size_t pixel, const Lighting& lighting,
                             Random& random, Rendering& out) const {
  const Body& body = bodies[hit.hit.geomID];
  const Mesh& mesh = body.model->mesh;
  const auto& triangle = mesh.triangles[hit.hit.primID];
  const auto& [a, b, c] = triangle.corners;
  const float wb = hit.hit.u, wc = hit.hit.v, wa = 1 - wb - wc;
  const Eigen::Vector3f ray(hit.ray.dir_x, hit.ray.dir_y, hit.ray.dir_z);
  const Eigen::Vector3f point = ray * hit.ray.tfar, to_eye = -ray.normalized();
  Eigen::Vector3f flat = Eigen::Vector3f(hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z).normalized();
  Eigen::Vector3f normal =
      (body.normals_C[a] * wa + body.normals_C[b] * wb + body.normals_C[c] * wc).normalized();
  if (normal.dot(flat) < 0) normal = -normal;
  if (!(normal.dot(flat) > 0.9f)) normal = flat;  // across an edge: do not round it
  if (flat.dot(to_eye) < 0) flat = -flat, normal = -normal;
  const Eigen::Vector2f uv = mesh.uv[a] * wa + mesh.uv[b] * wb + mesh.uv[c] * wc;
  const Material& material = body.model->materials[triangle.material];

  const Eigen::Vector3f outside = point + flat * kSurfaceGap_m;
  const auto [diffuse, highlight] =
      LampLight(outside, normal, to_eye, (X_CW * lighting.lamp_W).cast<float>(), material, random);
  const Eigen::Vector3f up_C = X_CW.linear().col(2).cast<float>();
  const float sky = 0.75f + 0.25f * normal.dot(up_C);
  const float light = lighting.ambient * sky + lighting.lamp * diffuse;
  out.colour[pixel] = (material.texture.Sample(uv.x(), uv.y()) * light +
                       Eigen::Vector3f::Constant(highlight * lighting.lamp))
                          .cwiseProduct(lighting.tint);
  out.depth_m[pixel] = hit.ray.tfar;
  out.labels[pixel] = body.label;
  out.incidence[pixel] = flat.dot(to_eye);
  out.metal[pixel] = material.metal;
  out.unlit[pixel] = Occluded(outside, {kProjector_m, 0, 0});
}

Raycaster::Raycaster(const std::vector<Instance>& instances, const Pose& X_WC)
    : state_(std::make_unique<State>()) {
  state_->X_CW = X_WC.inverse();
  state_->scene = rtcNewScene(Device());
  rtcSetSceneBuildQuality(state_->scene, RTC_BUILD_QUALITY_LOW);
  rtcSetSceneFlags(state_->scene, RTC_SCENE_FLAG_ROBUST);
  for (const Instance& instance : instances) {
    state_->bodies.push_back(MakeBody(instance, state_->X_CW));
    Attach(state_->scene, state_->bodies.back());
  }
  rtcCommitScene(state_->scene);
}

Raycaster::~Raycaster() { rtcReleaseScene(state_->scene); }

Rendering Raycaster::Render(const Intrinsics& intrinsics, const Window& window,
                            const Lighting& lighting, Random& random) const {
  Rendering out;
  out.window = window;
  const size_t n = window.Size();
  out.depth_m.assign(n, 0.0f);
  out.labels.assign(n, 0);
  out.incidence.assign(n, 0.0f);
  out.metal.assign(n, 0.0f);
  out.unlit.assign(n, 0);
  out.colour.assign(n, Eigen::Vector3f::Zero());
  for (int y = 0; y < window.height; ++y) {
    for (int x = 0; x < window.width; ++x) {
      const RTCRayHit hit = state_->Hit(Direction(intrinsics, window.u0 + x, window.v0 + y));
      if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
      state_->Shade(hit, static_cast<size_t>(y) * window.width + x, lighting, random, out);
    }
  }
  return out;
}

int Raycaster::CountVisible(const Intrinsics& intrinsics, const Window& window,
                            uint16_t label) const {
  int count = 0;
  for (int y = 0; y < window.height; ++y) {
    for (int x = 0; x < window.width; ++x) {
      const RTCRayHit hit = state_->Hit(Direction(intrinsics, window.u0 + x, window.v0 + y));
      if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
      count += state_->bodies[hit.hit.geomID].label == label;
    }
  }
  return count;
}

}  // namespace beckon::capture
