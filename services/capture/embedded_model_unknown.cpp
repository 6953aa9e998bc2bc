// Things that stand and lie about on tables and are of no category: books, tools, hands, crockery
// without a category, fruit, gadgets, toys, cloth.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "services/capture/embedded_model_makers.h"

namespace beckon::capture {
namespace {

constexpr double kMm = 1e-3;

double Mm(Random& random, double low, double high) { return random.Uniform(low, high) * kMm; }

uint32_t Plain(Model& model, const Rgb& colour, float gloss = 0.3f, float metal = 0) {
  return model.AddMaterial(PlainTexture(colour), gloss, metal);
}

Rgb Skin(Random& random) {
  const double light = random.Uniform(0.35, 1.0);
  return {static_cast<uint8_t>(235 * light), static_cast<uint8_t>(190 * light),
          static_cast<uint8_t>(160 * light)};
}

/// A mesh put somewhere: turned about the axis, then moved.
Mesh Put(Mesh mesh, double angle, const Eigen::Vector3d& axis, const Eigen::Vector3d& at) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  pose.translation() = at;
  mesh.Transform(pose);
  return mesh;
}

Mesh Block(const Eigen::Vector3d& size, uint32_t material) {
  return BoxMesh(size, {material, material, material, material, material, material});
}

Mesh Ball(const Eigen::Vector3d& half, uint32_t material) {
  constexpr int kRings = 12;
  std::vector<Ring> rings;
  for (int i = 0; i <= kRings; ++i) {
    const double angle = std::numbers::pi * i / kRings;
    rings.push_back({-half.z() * std::cos(angle), half.x() * std::sin(angle),
                     half.y() * std::sin(angle), 2, static_cast<double>(i) / kRings, material});
  }
  return Loft(rings);
}

/// One book, or a few; shut or open on its face.
void MakeBooks(Model& model, Random& random) {
  double z = 0;
  for (int i = random.Chance(0.7) ? 1 : random.Int(2, 4); i > 0; --i) {
    const double thick = Mm(random, 6, 45), w = Mm(random, 105, 220),
                 h = w * random.Uniform(1.2, 1.5);
    const Rgb base = PackagingColour(random);
    const uint32_t cover =
        model.AddMaterial(PackagingTexture(random, base, w * 1e3, h * 1e3), 0.2f);
    const uint32_t pages = Plain(model, {235, 230, 215}, 0);
    const uint32_t spine =
        model.AddMaterial(PackagingTexture(random, base, h * 1e3, thick * 1e3), 0.2f);
    const double hard = random.Chance(0.4) ? 3 * kMm : 0;  // boards stand over the pages
    Mesh book =
        BoxMesh({w - hard, h - 2 * hard, thick}, {pages, pages, spine, pages, cover, cover});
    if (hard > 0) {
      book.Append(Put(Block({w, h, 2.5 * kMm}, cover), 0, {0, 0, 1}, {0, 0, -1 * kMm}));
      book.Append(Put(BoxMesh({w, h, 2.5 * kMm}, {cover, cover, cover, cover, cover, cover}), 0,
                      {0, 0, 1}, {0, 0, thick - 1.5 * kMm}));
    }
    model.mesh.Append(Put(book, random.Uniform(-0.3, 0.3), {0, 0, 1}, {0, 0, z}));
    z += thick;
  }
  if (random.Chance(0.15)) {  // stands
    model.mesh = Put(model.mesh, std::numbers::pi / 2, {1, 0, 0}, {0, 0, 0});
  }
}

/// Screwdriver, hammer, spanner, pliers, brush, pen: long things that lie.
void MakeTool(Model& model, Random& random) {
  const uint32_t grip = Plain(model, PackagingColour(random));
  const auto grey = static_cast<uint8_t>(random.Int(90, 200));
  const uint32_t steel = Plain(model, {grey, grey, grey}, 0.6f, random.Chance(0.5) ? 0.2f : 0.02f);
  const double handle = Mm(random, 80, 150), thick = Mm(random, 8, 18), z = thick;
  const double shaft = Mm(random, 50, 160), thin = Mm(random, 2.5, 7);
  model.mesh.Append(
      Sweep({{-handle, 0, z}, {-handle * 0.9, 0, z}, {-handle * 0.5, 0, z}, {0, 0, z}}, {0, 1, 0},
            thick, thick * random.Uniform(0.5, 1), grip));
  const int kind = random.Int(0, 4);
  if (kind == 1) {  // a hammer
    const double head = Mm(random, 70, 120);
    model.mesh.Append(Sweep({{0, 0, z}, {shaft, 0, z}}, {0, 1, 0}, thick * 0.7, thick * 0.6, grip));
    model.mesh.Append(
        Put(Block({2 * thick, head, 1.8 * thick}, steel), 0, {0, 0, 1}, {shaft, 0, 0}));
    return;
  }
  if (kind == 2) {  // pliers, scissors: two of everything
    const double spread = random.Uniform(0.1, 0.35);
    Model one;
    one.mesh = model.mesh;
    model.mesh = Put(one.mesh, spread, {0, 0, 1}, {0, 0, 0});
    model.mesh.Append(Put(one.mesh, -spread, {0, 0, 1}, {0, 0, 0}));
    for (int s : {-1, 1}) {
      model.mesh.Append(Sweep({{0, s * 2 * kMm, z}, {shaft * 0.7, s * 9 * kMm, z}}, {0, 1, 0},
                              6 * kMm, thin, steel));
    }
    return;
  }
  model.mesh.Append(Sweep({{0, 0, z}, {shaft, 0, z}}, {0, 1, 0}, thin, thin, steel));
  if (kind == 3) {  // a spanner, a spatula, a brush
    const double wide = Mm(random, 12, 40);
    model.mesh.Append(
        Put(Block({2 * wide, 1.6 * wide, thin * 2}, random.Chance(0.5) ? steel : grip), 0,
            {0, 0, 1}, {shaft + wide * 0.6, 0, z - thin}));
  }
}

/// A hand that lies, reaches or makes a fist, with some of its arm.
void MakeHand(Model& model, Random& random) {
  const uint32_t skin = Plain(model, Skin(random), 0.1f);
  const uint32_t sleeve = random.Chance(0.5) ? Plain(model, PackagingColour(random), 0) : skin;
  const double palm = Mm(random, 36, 48), thick = Mm(random, 11, 17);
  const double lift = random.Chance(0.5) ? 0 : Mm(random, 10, 90), z = thick + lift;
  const double arm = Mm(random, 60, 260), rise = random.Uniform(-0.1, 0.5) * arm;
  model.mesh.Append(Ball({palm * 1.2, palm, thick * 1.1}, skin));
  model.mesh = Put(model.mesh, 0, {0, 0, 1}, {0, 0, z});
  model.mesh.Append(Sweep({{-palm * 0.9, 0, z},
                           {-palm - 40 * kMm, 0, z + rise * 0.2},
                           {-palm - arm, 0, std::max(25 * kMm, z + rise)}},
                          {0, 1, 0}, Mm(random, 26, 40), Mm(random, 20, 32), sleeve));
  const double curl = random.Chance(0.3) ? random.Uniform(0.8, 1.0) : random.Uniform(0, 0.8);
  for (int finger = 0; finger < 5; ++finger) {
    const bool thumb = finger == 4;
    const double y = thumb ? palm * 0.9 : palm * (0.72 - 0.48 * finger);
    const double length = Mm(random, 60, 85) * (thumb ? 0.7 : 1), half = Mm(random, 7.5, 10);
    const double out =
        thumb ? random.Uniform(0.1, 0.9) : random.Uniform(-0.1, 0.1) - 0.1 * (finger - 1.5);
    std::vector<Eigen::Vector3d> path;
    Eigen::Vector3d at(thumb ? palm * 0.2 : palm * 0.95, y, z);
    double bend = random.Uniform(-0.2, 0.2);
    for (int i = 0; i < 5; ++i) {
      path.push_back(at);
      at += length / 4 *
            Eigen::Vector3d(std::cos(bend) * std::cos(out), std::cos(bend) * std::sin(out),
                            -std::sin(bend));
      bend += curl * 0.75;
      at.z() = std::max(at.z(), half * 0.8);
    }
    model.mesh.Append(Sweep(path, {0, 1, 0}, half, half * 0.85, skin));
  }
}

/// Telephone, remote control, keyboard, laptop, calculator, charger, camera.
void MakeGadget(Model& model, Random& random) {
  const auto grey =
      static_cast<uint8_t>(random.Chance(0.6) ? random.Int(15, 70) : random.Int(170, 240));
  const uint32_t body = Plain(model, {grey, grey, grey}, 0.4f);
  const uint32_t keys = Plain(model, CrockeryColour(random), 0.1f);
  const int kind = random.Int(0, 4);
  Eigen::Vector3d size(Mm(random, 40, 80), Mm(random, 100, 220), Mm(random, 7, 28));
  if (kind == 0) size = {Mm(random, 280, 380), Mm(random, 110, 160), Mm(random, 15, 35)};
  if (kind == 1) size = {Mm(random, 60, 160), Mm(random, 60, 120), Mm(random, 30, 80)};
  model.mesh = Block(size, body);
  if (kind == 0 || kind == 2) {
    const double step = Mm(random, 13, 20);
    for (double x = -size.x() / 2 + step; x < size.x() / 2 - step / 2; x += step) {
      for (double y = -size.y() / 2 + step; y < size.y() / 2 - step / 2; y += step) {
        model.mesh.Append(
            Put(Block({step * 0.7, step * 0.7, 3 * kMm}, keys), 0, {0, 0, 1}, {x, y, size.z()}));
      }
    }
  } else if (kind == 1) {  // a camera's or a speaker's round front
    const double r = std::min(size.x(), size.z()) * random.Uniform(0.25, 0.5);
    model.mesh.Append(Put(Turn({{r, 0, body},
                                {r, Mm(random, 8, 50), body},
                                {r * 0.8, 40 * kMm, keys},
                                {0, 38 * kMm, keys}}),
                          std::numbers::pi / 2, {1, 0, 0}, {0, -size.y() / 2, size.z() / 2}));
  } else if (kind == 3) {  // a laptop, a frame: a lid that leans
    const Eigen::Vector3d lid(Mm(random, 180, 340), Mm(random, 4, 20), Mm(random, 130, 230));
    model.mesh = Block({lid.x(), lid.z(), 12 * kMm}, body);
    model.mesh.Append(
        Put(Block(lid, body), -random.Uniform(0, 0.6), {1, 0, 0}, {0, lid.z() / 2, 5 * kMm}));
  }
}

/// Fruit, balls, eggs: one or a heap.
void MakeFruit(Model& model, Random& random) {
  for (int i = random.Chance(0.6) ? 1 : random.Int(2, 5); i > 0; --i) {
    const uint32_t skin = Plain(model, PackagingColour(random), 0.3f);
    const double r = Mm(random, 22, 60);
    Mesh ball = Ball({r, r * random.Uniform(0.85, 1), r * random.Uniform(0.8, 1.15)}, skin);
    if (random.Chance(0.2)) {  // a banana, a cucumber
      const double length = Mm(random, 120, 220), bow = random.Uniform(0, 0.25);
      std::vector<Eigen::Vector3d> path;
      for (int k = 0; k <= 8; ++k) {
        const double t = k / 4.0 - 1;
        path.emplace_back(t * length / 2, bow * length * t * t, r * 0.4);
      }
      ball = Sweep(path, {0, 0, 1}, r * 0.4, r * 0.4, skin);
      ball = Put(ball, 0, {0, 0, 1}, {0, 0, -r});
    }
    model.mesh.Append(Put(ball, random.Uniform(0, 3), {0, 0, 1},
                          {random.Uniform(-0.07, 0.07), random.Uniform(-0.07, 0.07), r}));
    if (i == 1 && model.mesh.triangles.size() < 4000) return;
  }
}

/// Plates, pans, trays, lamps, candlesticks, vases, funnels: turned things of no category.
void MakeTurned(Model& model, Random& random) {
  const uint32_t body = model.AddMaterial(CrockeryTexture(random, CrockeryColour(random)), 0.5f);
  const int kind = random.Int(0, 3);
  if (kind == 0) {  // a plate, a pan
    const double r = Mm(random, 75, 150), rim = Mm(random, 8, 35), t = Mm(random, 2, 5);
    model.mesh = Turn({{0, 0, body},
                       {r * random.Uniform(0.5, 0.9), 0, body},
                       {r, rim, body},
                       {r - t, rim, body},
                       {r * 0.5, t, body},
                       {0, t, body}});
    if (random.Chance(0.4)) {
      model.mesh.Append(
          Sweep({{r - t, 0, rim}, {r + Mm(random, 90, 180), 0, rim + Mm(random, 0, 40)}}, {0, 1, 0},
                11 * kMm, 6 * kMm, body));
    }
    return;
  }
  // Beads of any radius over a foot: lamps, candlesticks, figures, plants.
  const double foot = Mm(random, 30, 70);
  std::vector<OutlinePoint> outline = {
      {0, 0, body}, {foot, 0, body}, {foot, Mm(random, 4, 15), body}};
  double z = outline.back().z;
  for (int i = random.Int(3, 6); i > 0; --i) {
    z += Mm(random, 12, 60);
    outline.push_back({Mm(random, 6, 75), z, body});
  }
  outline.push_back({0, z, body});
  model.mesh = Turn(outline, random.Chance(0.3) ? random.Uniform(0.5, 1) : 1);
}

/// Toys, blocks, figures: a few parts anyhow.
void MakeToy(Model& model, Random& random) {
  double z = 0;
  for (int i = random.Int(2, 5); i > 0; --i) {
    const uint32_t paint = Plain(model, PackagingColour(random));
    const Eigen::Vector3d half(Mm(random, 10, 60), Mm(random, 10, 60), Mm(random, 10, 50));
    const Eigen::Vector3d at(random.Uniform(-0.04, 0.04), random.Uniform(-0.04, 0.04), z);
    model.mesh.Append(
        random.Chance(0.5)
            ? Put(Block(2 * half, paint), random.Uniform(0, 3), {0, 0, 1}, at)
            : Put(Ball(half, paint), 0, {0, 0, 1}, at + Eigen::Vector3d(0, 0, half.z())));
    if (random.Chance(0.6)) z += half.z();
  }
}

/// A cloth, a bag, a plush thing: a heap without edges.
void MakeHeap(Model& model, Random& random) {
  const uint32_t cloth = model.AddMaterial(CrockeryTexture(random, PackagingColour(random)), 0);
  const double rx = Mm(random, 45, 130), ry = Mm(random, 45, 130), height = Mm(random, 18, 110);
  const double waves = random.Uniform(0.05, 0.3), turns = random.Int(2, 5),
               phase = random.Uniform(0, 6);
  model.mesh = Ball({rx, ry, height / 2}, cloth);
  for (auto& p : model.mesh.positions) {
    const double angle = std::atan2(p.y(), p.x());
    const double swell = 1 + waves * std::sin(turns * angle + phase + 40 * p.z()) +
                         0.5 * waves * std::sin(2 * turns * angle + 90 * p.x());
    p *= static_cast<float>(swell);
    p.z() = std::max(p.z(), static_cast<float>(-height * 0.3));
  }
}

}  // namespace

Model MakeUnknownModel(Random& random) {
  static constexpr void (*kKinds[])(Model&, Random&) = {MakeBooks, MakeTool,   MakeHand, MakeGadget,
                                                        MakeFruit, MakeTurned, MakeToy,  MakeHeap};
  static constexpr double kShares[] = {0.22, 0.17, 0.17, 0.12, 0.08, 0.09, 0.08, 0.07};
  Model model;
  model.category = kUnknown;
  double choice = random.Unit();
  size_t kind = 0;
  while (kind + 1 < std::size(kShares) && (choice -= kShares[kind]) > 0) ++kind;
  kKinds[kind](model, random);
  Eigen::AlignedBox3f box;
  for (const auto& p : model.mesh.positions) box.extend(p);
  for (auto& p : model.mesh.positions) p -= box.center();
  return model;
}

}  // namespace beckon::capture
