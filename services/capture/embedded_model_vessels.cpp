// Closed round containers: bottles, drink cans, spray cans, tubes.
#include <algorithm>

#include "services/capture/embedded_model_makers.h"

namespace beckon::capture {
namespace {

constexpr double kMm = 1e-3;

double Mm(Random& random, double low, double high) { return random.Uniform(low, high) * kMm; }

/// Depth lost on bare metal: mostly little, now and then much.
float ShinyShare(Random& random) {
  return static_cast<float>(random.Chance(0.2) ? random.Uniform(0.1, 0.5)
                                               : random.Uniform(0, 0.04));
}

Rgb MetalColour(Random& random) {
  const auto grey = static_cast<uint8_t>(random.Int(150, 215));
  return {grey, grey, static_cast<uint8_t>(std::min(255, grey + 6))};
}

Texture Wrap(Random& random, double radius, double height) {
  return PackagingTexture(random, PackagingColour(random), 6283 * radius, 1000 * height);
}

}  // namespace

Model MakeBottle(Random& random) {
  Model model;
  const bool elliptic = random.Chance(0.5);
  const double height = Mm(random, 130, 290);
  const double radius = std::min(Mm(random, 22, 58), height * 0.32);
  const double neck = std::min(Mm(random, 11, 20), radius * 0.7);
  const double cap_height = Mm(random, 10, 32);
  const double shoulder = height * random.Uniform(0.5, 0.78);
  const double neck_start =
      std::min(height - cap_height - 4 * kMm, shoulder + radius * random.Uniform(0.5, 1.4));
  const double cap = neck * random.Uniform(1.02, 1.25);
  const uint32_t body = model.AddMaterial(
      random.Chance(0.75) ? Wrap(random, radius, height) : PlainTexture(PackagingColour(random)),
      0.4f);
  const uint32_t lid = model.AddMaterial(PlainTexture(PackagingColour(random)), 0.3f);
  std::vector<OutlinePoint> outline = {{0, 0, body}, {radius * 0.9, 0, body}};
  AddCurve(outline, radius, 6 * kMm, false, 3, body);
  if (random.Chance(0.25)) {  // a waist
    outline.push_back({radius, shoulder * 0.25, body});
    outline.push_back(
        {radius * random.Uniform(0.82, 0.95), shoulder * random.Uniform(0.45, 0.65), body});
  }
  outline.push_back({radius, shoulder, body});
  AddCurve(outline, neck, neck_start, random.Chance(0.7), 8, body);
  outline.push_back({neck, height - cap_height, lid});
  outline.push_back({cap, height - cap_height, lid});
  outline.push_back({cap, height - 2 * kMm, lid});
  outline.push_back({cap * 0.92, height, lid});
  outline.push_back({0, height, lid});
  model.mesh = Turn(outline, 1, elliptic && random.Chance(0.4) ? random.Uniform(2.2, 4) : 2);
  if (elliptic) {  // the body is flattened, the neck stays round
    const double flatness = random.Uniform(0.5, 0.88);
    for (auto& p : model.mesh.positions) {
      const double t =
          std::clamp((p.z() - shoulder) / std::max(1e-3, neck_start - shoulder), 0.0, 1.0);
      p.y() *= static_cast<float>(flatness + (std::max(flatness, 0.9) - flatness) * t);
    }
  }
  if (random.Chance(0.12)) {  // a dispenser
    const uint32_t pump = model.AddMaterial(PlainTexture(CrockeryColour(random)), 0.3f);
    model.mesh.Append(
        Sweep({{0, 0, height}, {0, 0, height + 22 * kMm}}, {1, 0, 0}, 4 * kMm, 4 * kMm, pump));
    model.mesh.Append(Sweep({{0, 0, height + 22 * kMm},
                             {radius * 0.6, 0, height + 24 * kMm},
                             {radius * 0.8 + 10 * kMm, 0, height + 18 * kMm}},
                            {0, 1, 0}, 7 * kMm, 5 * kMm, pump));
  }
  model.lying = 0.22;
  return model;
}

Model MakeCan(Random& random) {
  Model model;
  constexpr double kSizes[4][4] = {
      {32, 33.5, 112, 125}, {25.5, 29.5, 125, 160}, {32, 34.5, 145, 175}, {26, 30, 85, 110}};
  const auto& size = kSizes[random.Int(0, 3)];
  const double radius = Mm(random, size[0], size[1]), height = Mm(random, size[2], size[3]);
  const uint32_t print = model.AddMaterial(Wrap(random, radius, height), 0.5f, 0.005f);
  const uint32_t metal =
      model.AddMaterial(PlainTexture(MetalColour(random)), 0.7f, ShinyShare(random));
  const double inset = Mm(random, 4, 7), rim = Mm(random, 2, 4);
  std::vector<OutlinePoint> outline = {
      {0, 4 * kMm, metal}, {radius - 9 * kMm, 0, metal}, {radius - 6 * kMm, 0, print}};
  AddCurve(outline, radius, Mm(random, 8, 13), false, 4, print);
  outline.push_back({radius, height - 13 * kMm, print});
  AddCurve(outline, radius - inset, height - rim, true, 4, metal);
  outline.push_back({radius - inset, height, metal});
  outline.push_back({radius - inset - 1.5 * kMm, height, metal});
  outline.push_back({radius - inset - 3 * kMm, height - 4 * kMm, metal});
  outline.push_back({0, height - 3.5 * kMm, metal});
  model.mesh = Turn(outline);
  model.lying = 0.25;
  return model;
}

Model MakeSprayCan(Random& random) {
  Model model;
  const double radius = Mm(random, 21, 34), height = std::max(Mm(random, 130, 260), radius * 4.2);
  const uint32_t print = model.AddMaterial(Wrap(random, radius, height), 0.5f, 0.005f);
  const uint32_t metal =
      model.AddMaterial(PlainTexture(MetalColour(random)), 0.7f, ShinyShare(random));
  const uint32_t plastic = model.AddMaterial(PlainTexture(PackagingColour(random)), 0.3f);
  std::vector<OutlinePoint> outline = {
      {0, 3 * kMm, metal}, {radius * 0.9, 0, metal}, {radius, 2 * kMm, print}};
  if (random.Chance(0.5)) {  // a cap as wide as the body, or nearly
    const double cap_height = Mm(random, 28, 60), cap = radius * random.Uniform(0.84, 1.0);
    outline.push_back({radius, height - cap_height - 4 * kMm, metal});
    outline.push_back({cap, height - cap_height, plastic});
    outline.push_back({cap * random.Uniform(0.88, 1), height - 8 * kMm, plastic});
    AddCurve(outline, cap * random.Uniform(0.3, 0.8), height, random.Chance(0.5), 4, plastic);
    outline.push_back({0, height, plastic});
  } else {  // a dome, its collar, and the nozzle
    const double nozzle_height = Mm(random, 12, 26), dome = radius * random.Uniform(0.35, 0.7);
    const double collar = radius * random.Uniform(0.42, 0.55), nozzle = Mm(random, 6, 11);
    const double body_end = height - nozzle_height - dome;
    outline.push_back({radius, body_end, metal});
    AddCurve(outline, collar, body_end + dome, true, 6, metal);
    outline.push_back({collar, body_end + dome + 3 * kMm, metal});
    outline.push_back({collar - 4 * kMm, body_end + dome, plastic});
    outline.push_back({nozzle, body_end + dome, plastic});
    outline.push_back({nozzle, height - 2 * kMm, plastic});
    outline.push_back({nozzle * 0.8, height, plastic});
    outline.push_back({0, height, plastic});
  }
  model.mesh = Turn(outline);
  model.lying = 0.25;
  return model;
}

Model MakeTube(Random& random) {
  Model model;
  const double length = Mm(random, 100, 190), radius = std::min(Mm(random, 13, 26), length * 0.19);
  const double cap_length = Mm(random, 10, 28), cap = radius * random.Uniform(0.45, 1.0);
  const uint32_t print = model.AddMaterial(
      PackagingTexture(random, PackagingColour(random), 6283 * radius, 1000 * length), 0.35f);
  const uint32_t plastic = model.AddMaterial(PlainTexture(CrockeryColour(random)), 0.3f);
  // From the cap (bottom, z = 0) to the crimped end; its outline keeps its length while it
  // flattens.
  const double crimp = 1.5 * kMm, used = random.Chance(0.4) ? random.Uniform(0.2, 0.6) : 0;
  std::vector<Ring> rings = {{0, 0, 0, 2, 0, plastic},
                             {0, cap * 0.95, cap * 0.95, 2, 0, plastic},
                             {cap_length, cap, cap, 2, 0.02, plastic},
                             {cap_length, cap * 0.8, cap * 0.8, 2, 0.04, print},
                             {cap_length + 6 * kMm, radius, radius, 2, 0.06, print}};
  const double start = cap_length + 6 * kMm, end = length - 8 * kMm;
  for (int i = 1; i <= 10; ++i) {
    const double t = i / 10.0, flat = std::clamp(t + used * t * (1 - t) * 2, 0.0, 1.0);
    const double ry = radius * (1 - flat) + crimp * flat;
    const double rx = std::min(radius * 1.5, radius + (radius - ry) * 0.5);
    rings.push_back({start + (end - start) * t, rx, ry, 2, 0.06 + 0.9 * t, print});
  }
  rings.push_back({length, rings.back().rx, crimp, 4, 1, print});
  rings.push_back({length, 0, 0, 2, 1, print});
  model.mesh = Loft(rings);
  model.lying = 0.87;
  return model;
}

}  // namespace beckon::capture
