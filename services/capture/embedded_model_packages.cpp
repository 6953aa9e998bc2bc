// Boxes and drink cartons.
#include <algorithm>
#include <cmath>

#include "services/capture/embedded_model_makers.h"

namespace beckon::capture {
namespace {

constexpr double kMm = 1e-3;

double Mm(Random& random, double low, double high) { return random.Uniform(low, high) * kMm; }

/// Materials of a printed cuboid: two fronts, two sides, bottom and top.
std::array<uint32_t, 6> PrintedFaces(Model& model, Random& random, const Eigen::Vector3d& size) {
  const Rgb base = PackagingColour(random);
  const Eigen::Vector3d mm = size * 1000;
  const uint32_t front = model.AddMaterial(PackagingTexture(random, base, mm.x(), mm.z()), 0.2f);
  const uint32_t back = model.AddMaterial(PackagingTexture(random, base, mm.x(), mm.z()), 0.2f);
  const uint32_t side = model.AddMaterial(PackagingTexture(random, base, mm.y(), mm.z()), 0.2f);
  const uint32_t end = model.AddMaterial(
      random.Chance(0.5) ? PlainTexture(base) : PackagingTexture(random, base, mm.x(), mm.y()),
      0.2f);
  return {front, random.Chance(0.5) ? front : back, side, side, end, end};
}

void AddScrewCap(Model& model, Random& random, const Eigen::Vector3d& at, double tilt) {
  const uint32_t plastic = model.AddMaterial(PlainTexture(PackagingColour(random)), 0.3f);
  const double radius = Mm(random, 9, 17), height = Mm(random, 6, 20);
  Mesh cap = Turn({{radius, 0, plastic}, {radius, height, plastic}, {0, height, plastic}});
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX()).toRotationMatrix();
  pose.translation() = at;
  cap.Transform(pose);
  model.mesh.Append(cap);
}

/// The lid's flaps of a box that was opened.
void AddFlaps(Model& model, Random& random, const Eigen::Vector3d& size, uint32_t print) {
  const double x = size.x() / 2, y = size.y() / 2, z = size.z();
  for (int s : {-1, 1}) {
    const double open = random.Uniform(0.2, 2.2), length = size.y() * random.Uniform(0.6, 0.95);
    const double out = s * (y + length * std::cos(open) * -1), up = z + length * std::sin(open);
    AddQuad(model.mesh, {{{-x, s * y, z}, {x, s * y, z}, {x, out, up}, {-x, out, up}}}, print);
  }
}

void MakeGable(Model& model, Random& random) {
  const double side = Mm(random, 55, 100), body = Mm(random, 80, 200),
               roof = side * random.Uniform(0.35, 0.6);
  const double fin = Mm(random, 10, 22), h = side / 2, top = body + roof;
  const auto faces = PrintedFaces(model, random, {side, side, body});
  const uint32_t plain = model.AddMaterial(PlainTexture(PackagingColour(random)), 0.2f);
  model.mesh = BoxMesh({side, side, body}, faces);
  AddQuad(model.mesh, {{{-h, -h, body}, {h, -h, body}, {h, 0, top}, {-h, 0, top}}}, plain);
  AddQuad(model.mesh, {{{h, h, body}, {-h, h, body}, {-h, 0, top}, {h, 0, top}}}, plain);
  const double fold = random.Uniform(0.1, 0.5) * h;  // the ends are folded inwards
  for (int s : {-1, 1}) {
    AddQuad(
        model.mesh,
        {{{s * h, -h, body}, {s * h, h, body}, {s * (h - fold), 0, top}, {s * (h - fold), 0, top}}},
        plain);
  }
  const double t = 2 * kMm;
  Mesh ridge = BoxMesh({side, 2 * t, fin}, {plain, plain, plain, plain, plain, plain});
  Pose up = Pose::Identity();
  up.translation().z() = top - t;
  ridge.Transform(up);
  model.mesh.Append(ridge);
  if (random.Chance(0.4)) AddScrewCap(model, random, {0, -h * 0.5, body + roof * 0.5}, 0.8);
}

void MakeBrick(Model& model, Random& random) {
  const double width = Mm(random, 45, 105), depth = width * random.Uniform(0.6, 1),
               height = std::max(Mm(random, 95, 245), width * 1.35);
  model.mesh = BoxMesh({width, depth, height}, PrintedFaces(model, random, {width, depth, height}));
  const double kind = random.Unit();
  if (kind < 0.35) {  // a slanted top with a cap
    const double slant = depth * random.Uniform(0.2, 0.6);
    for (auto& p : model.mesh.positions) {
      if (p.z() > height * 0.9 && p.y() < 0) p.z() -= static_cast<float>(slant);
    }
    AddScrewCap(model, random, {0, -depth * 0.15, height - slant * 0.65}, std::atan2(slant, depth));
  } else if (kind < 0.75) {
    AddScrewCap(model, random, {random.Uniform(-0.2, 0.2) * width, -depth * 0.2, height}, 0);
  } else if (kind < 0.9) {  // a straw
    const uint32_t straw = model.AddMaterial(PlainTexture({240, 240, 235}), 0.2f);
    const double x = width * 0.25, bend = height + Mm(random, 25, 45);
    model.mesh.Append(
        Sweep({{x, 0, height - 5 * kMm}, {x, 0, bend}, {x - 18 * kMm, 0, bend + 22 * kMm}},
              {0, 1, 0}, 3 * kMm, 3 * kMm, straw));
  }
}

}  // namespace

Model MakeBox(Random& random) {
  Model model;
  Eigen::Vector3d size;
  switch (random.Int(0, 4)) {
    case 0:  // cereals, tea
      size = {Mm(random, 100, 200), Mm(random, 30, 80), Mm(random, 150, 290)};
      break;
    case 1:  // medicine, light bulbs
      size = {Mm(random, 50, 80), Mm(random, 50, 80), Mm(random, 120, 180)};
      break;
    case 2:  // small: butter, jelly, soap, cards
      size = {Mm(random, 80, 150), Mm(random, 22, 50), Mm(random, 45, 110)};
      break;
    case 3:  // flat: games, sweets
      size = {Mm(random, 80, 200), Mm(random, 40, 130), Mm(random, 20, 50)};
      break;
    default:  // gift, tissue
      size = {Mm(random, 90, 180), Mm(random, 90, 180), Mm(random, 80, 180)};
  }
  const auto faces = PrintedFaces(model, random, size);
  model.mesh = BoxMesh(size, faces);
  if (random.Chance(0.12)) AddFlaps(model, random, size, faces[2]);
  model.any_face = true;
  return model;
}

Model MakeCarton(Random& random) {
  Model model;
  if (random.Chance(0.5)) {
    MakeGable(model, random);
  } else {
    MakeBrick(model, random);
  }
  model.lying = 0.1;
  return model;
}

}  // namespace beckon::capture
