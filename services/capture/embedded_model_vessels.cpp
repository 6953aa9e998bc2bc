// Closed round containers: bottles, drink cans, spray cans, tubes.
#include <algorithm>

#include "services/capture/embedded_model_makers.h"

namespace beckon::capture {
namespace {

constexpr double kMm = 1e-3;

double Mm(Random& random, double low, double high) { return random.Uniform(low, high) * kMm; }

/// Depth lost on bare metal: mostly little, now and then much.
float ShinyShare(Random& random) {
  return static_cast<float>(random.Chance(0.1) ? random.Uniform(0.1, 0.5)
                                               : random.Uniform(0, 0.02));
}

Rgb MetalColour(Random& random) {
  const auto grey = static_cast<uint8_t>(random.Int(150, 215));
  return {grey, grey, static_cast<uint8_t>(std::min(255, grey + 6))};
}

Texture Wrap(Random& random, double radius, double height) {
  return PackagingTexture(random, PackagingColour(random), 6283 * radius, 1000 * height);
}

}  // namespace

namespace {

/// What the kinds of bottles differ in; m, and shares of the height.
struct BottleShape {
  double height = 0, radius = 0;
  double neck = 0;        // radius
  double shoulder = 0;    // height where the body ends
  double neck_start = 0;  // and where the neck begins
  double cap = 0, cap_height = 0;
  double flatness = 1;  // depth over width of the body
  double exponent = 2;  // of its cross-section
  double taper = 1;     // radius at the shoulder over that at the base
  double neck_flatness = 1;
};

/// Water, juice, wine, sauce, medicine.
BottleShape SlenderBottle(Random& random) {
  BottleShape b;
  b.height = Mm(random, 130, 310);
  b.radius = std::min(Mm(random, 22, 50), b.height * random.Uniform(0.12, 0.3));
  b.neck = std::min(Mm(random, 10, 20), b.radius * 0.75);
  b.cap_height = Mm(random, 10, 32);
  b.shoulder = b.height * random.Uniform(0.42, 0.78);
  b.neck_start = std::min(b.height - b.cap_height - 4 * kMm,
                          b.shoulder + std::max(b.radius * random.Uniform(0.4, 1.4), 10 * kMm));
  b.cap = b.neck * random.Uniform(1.02, 1.25);
  b.taper = random.Chance(0.25) ? random.Uniform(0.8, 1.1) : 1;
  return b;
}

/// Detergent, shampoo, ketchup: flattened plastic, the body nearly up to a wide cap.
BottleShape FlatBottle(Random& random) {
  BottleShape b;
  b.height = Mm(random, 120, 280);
  b.radius = std::min(Mm(random, 28, 62), b.height * 0.3);
  b.flatness = random.Uniform(0.42, 0.85);
  b.exponent = random.Chance(0.5) ? random.Uniform(2.2, 4) : 2;
  const double depth = b.radius * b.flatness;
  b.cap = std::min(Mm(random, 12, 30), depth * 1.05);
  b.neck = b.cap * random.Uniform(0.8, 0.98);
  b.cap_height = Mm(random, 15, 50);
  b.shoulder = b.height * random.Uniform(0.5, 0.72);
  b.neck_start =
      std::min(b.height - b.cap_height - 2 * kMm, b.shoulder + b.radius * random.Uniform(0.3, 1.2));
  b.taper = random.Uniform(0.85, 1.12);
  b.neck_flatness = random.Uniform(0.8, 1);
  return b;
}

/// Shampoo, lotion: no neck, the cap as wide as the body or nearly.
BottleShape NecklessBottle(Random& random) {
  BottleShape b;
  b.height = Mm(random, 110, 250);
  b.radius = std::min(Mm(random, 20, 45), b.height * 0.27);
  b.flatness = random.Uniform(0.5, 1);
  b.exponent = random.Chance(0.4) ? random.Uniform(2.2, 3.5) : 2;
  b.cap_height = b.height * random.Uniform(0.08, 0.28);
  b.cap = b.radius * random.Uniform(0.6, 1);
  b.neck = b.cap * random.Uniform(0.9, 1);
  b.neck_start = b.height - b.cap_height - 1 * kMm;
  b.shoulder = b.neck_start - b.radius * random.Uniform(0.1, 1.5);
  b.taper = random.Uniform(0.8, 1.15);
  b.neck_flatness = b.flatness * random.Uniform(1, 1.2);
  return b;
}

/// Dressing, honey, flasks: a belly, then a long neck or a wide cap.
BottleShape BelliedBottle(Random& random) {
  BottleShape b;
  b.height = Mm(random, 110, 240);
  b.radius = std::min(Mm(random, 25, 58), b.height * 0.3);
  b.cap = b.radius * random.Uniform(0.35, 0.7);
  b.neck = b.cap * random.Uniform(0.75, 0.98);
  b.cap_height = Mm(random, 12, 40);
  b.shoulder = b.height * random.Uniform(0.15, 0.4);
  b.neck_start = std::min(b.height - b.cap_height - 2 * kMm, b.height * random.Uniform(0.55, 0.8));
  b.flatness = random.Chance(0.5) ? random.Uniform(0.6, 1) : 1;
  b.taper = random.Uniform(0.95, 1.25);
  b.neck_flatness = random.Uniform(0.9, 1);
  return b;
}

/// Jugs, milk and bleach: squarish, with a short neck.
BottleShape SquareBottle(Random& random) {
  BottleShape b;
  b.height = Mm(random, 90, 300);
  b.radius = std::clamp(b.height * random.Uniform(0.16, 0.3), 20 * kMm, 75 * kMm);
  b.flatness = random.Uniform(0.6, 1);
  b.exponent = random.Uniform(3, 9);
  b.neck = std::min(Mm(random, 10, 24), b.radius * 0.6 * b.flatness);
  b.cap_height = Mm(random, 10, 26);
  b.shoulder = b.height * random.Uniform(0.6, 0.82);
  b.neck_start =
      std::min(b.height - b.cap_height - 2 * kMm, b.shoulder + b.radius * random.Uniform(0.3, 1));
  b.cap = b.neck * random.Uniform(1.05, 1.3);
  return b;
}

void AddDispenser(Model& model, Random& random, const BottleShape& b) {
  const uint32_t pump = model.AddMaterial(PlainTexture(CrockeryColour(random)), 0.3f);
  const double top = b.height + Mm(random, 12, 30), reach = b.radius * 0.8 + 10 * kMm;
  model.mesh.Append(Sweep({{0, 0, b.height}, {0, 0, top}}, {1, 0, 0}, 4 * kMm, 4 * kMm, pump));
  model.mesh.Append(Sweep({{0, 0, top}, {reach * 0.7, 0, top + 2 * kMm}, {reach, 0, top - 4 * kMm}},
                          {0, 1, 0}, 7 * kMm, 5 * kMm, pump));
}

/// A grip through the body's side, as jugs have.
void AddGrip(Model& model, Random& random, const BottleShape& b) {
  const uint32_t plastic = model.AddMaterial(PlainTexture(CrockeryColour(random)), 0.3f);
  const double low = b.height * random.Uniform(0.4, 0.55),
               high = b.height * random.Uniform(0.75, 0.86);
  const double reach = b.radius + Mm(random, 12, 26);
  model.mesh.Append(Sweep({{b.radius * 0.8, 0, low},
                           {reach, 0, low + (high - low) * 0.3},
                           {reach * 0.95, 0, low + (high - low) * 0.8},
                           {b.neck * 0.8, 0, high}},
                          {0, 1, 0}, 9 * kMm, 7 * kMm, plastic));
}

}  // namespace

Model MakeBottle(Random& random) {
  Model model;
  const double kind = random.Unit();
  const BottleShape b = kind < 0.34   ? SlenderBottle(random)
                        : kind < 0.58 ? FlatBottle(random)
                        : kind < 0.72 ? NecklessBottle(random)
                        : kind < 0.84 ? BelliedBottle(random)
                                      : SquareBottle(random);
  const uint32_t body =
      model.AddMaterial(random.Chance(0.75) ? Wrap(random, b.radius, b.height)
                                            : PlainTexture(PackagingColour(random)),
                        0.4f);
  const uint32_t lid = model.AddMaterial(PlainTexture(PackagingColour(random)), 0.3f);
  const double base = b.radius * std::min(1.0, 1 / b.taper);
  const double top = b.radius * std::min(1.0, b.taper);
  std::vector<OutlinePoint> outline = {{0, 0, body}, {base * 0.9, 0, body}};
  AddCurve(outline, base, 6 * kMm, false, 3, body);
  if (random.Chance(0.25)) {  // a waist
    outline.push_back({base, b.shoulder * 0.25, body});
    outline.push_back(
        {base * random.Uniform(0.82, 0.95), b.shoulder * random.Uniform(0.45, 0.65), body});
  }
  outline.push_back({top, b.shoulder, body});
  AddCurve(outline, b.neck, b.neck_start, random.Chance(0.7), 8, body);
  outline.push_back({b.neck, b.height - b.cap_height, lid});
  outline.push_back({b.cap, b.height - b.cap_height, lid});
  const double tip = random.Chance(0.2) ? random.Uniform(0.2, 0.7) : 0.95;  // a spout
  outline.push_back(
      {b.cap * std::max(tip, 0.92), b.height - b.cap_height * (tip < 0.9 ? 0.6 : 0.1), lid});
  outline.push_back({b.cap * tip * 0.95, b.height, lid});
  outline.push_back({0, b.height, lid});
  model.mesh = Turn(outline, 1, b.exponent);
  for (auto& p : model.mesh.positions) {  // the body is flattened, the neck stays rounder
    const double t =
        std::clamp((p.z() - b.shoulder) / std::max(1e-3, b.neck_start - b.shoulder), 0.0, 1.0);
    p.y() *=
        static_cast<float>(b.flatness + (std::max(b.flatness, b.neck_flatness) - b.flatness) * t);
  }
  if (kind >= 0.34 && random.Chance(0.12)) AddDispenser(model, random, b);
  if (kind >= 0.84 && random.Chance(0.4)) AddGrip(model, random, b);
  model.lying = 0.22;
  model.upside_down = kind >= 0.34 && kind < 0.72 && b.cap > b.radius * 0.45 ? 0.25 : 0;
  return model;
}

Model MakeCan(Random& random) {
  Model model;
  constexpr double kSizes[5][4] = {{32, 33.5, 112, 125},
                                   {32, 33.5, 112, 125},
                                   {25.5, 29.5, 125, 160},
                                   {32, 34.5, 145, 175},
                                   {26, 30, 85, 110}};
  const auto& size = kSizes[random.Int(0, 4)];
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
