// Crockery, tins and tubs: open or lidded, mostly squat.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "services/capture/embedded_model_makers.h"

namespace beckon::capture {
namespace {

constexpr double kMm = 1e-3;

double Mm(Random& random, double low, double high) { return random.Uniform(low, high) * kMm; }

/// Outside from the base to the rim, then down the inside: walls of `thickness`.
std::vector<OutlinePoint> OpenVessel(double base, double rim, double height, double thickness,
                                     uint32_t outside, uint32_t inside) {
  return {{0, 2 * kMm, outside},
          {base * 0.85, 0, outside},
          {base, 2 * kMm, outside},
          {rim, height, inside},
          {rim - thickness, height, inside},
          {std::max(base - thickness, 5 * kMm), 6 * kMm, inside},
          {0, 5 * kMm, inside}};
}

/// How much wider a bulging wall is at a share of its height.
double Swell(double bulge, double share) {
  return 1 + bulge * std::sin(std::numbers::pi * std::clamp(share, 0.0, 1.0));
}

/// Widens a vessel of the given height towards its middle.
void Bulge(Mesh& mesh, double bulge, double height) {
  for (auto& p : mesh.positions) {
    p.head<2>() *= static_cast<float>(Swell(bulge, static_cast<double>(p.z()) / height));
  }
}

}  // namespace

Model MakeBowl(Random& random) {
  Model model;
  const bool steep = random.Chance(0.25);  // a ramekin, a salad bowl
  const double radius = Mm(random, steep ? 42 : 55, 105);
  const double height = 2 * radius * random.Uniform(steep ? 0.35 : 0.2, 0.58);
  const double foot = radius * (steep ? random.Uniform(0.6, 0.92) : random.Uniform(0.3, 0.65));
  const double thickness = Mm(random, 2.5, 6);
  const Rgb colour = CrockeryColour(random);
  const uint32_t outside = model.AddMaterial(CrockeryTexture(random, colour), 0.5f);
  const uint32_t inside =
      model.AddMaterial(PlainTexture(random.Chance(0.7) ? colour : CrockeryColour(random)), 0.5f);
  const double foot_height = random.Chance(0.5) ? Mm(random, 3, 10) : 0;
  const double roundness = random.Uniform(0.3, 1.0);
  std::vector<OutlinePoint> outline = {{0, foot_height, outside},
                                       {foot * 0.9, foot_height, outside},
                                       {foot * 0.95, 0, outside},
                                       {foot, 0, outside},
                                       {foot, foot_height, outside}};
  constexpr int kSteps = 10;
  const auto wall = [&](double t) { return foot + (radius - foot) * std::pow(t, roundness); };
  for (int i = 1; i <= kSteps; ++i) {
    const double t = static_cast<double>(i) / kSteps;
    outline.push_back({wall(t), foot_height + (height - foot_height) * t, outside});
  }
  outline.back().material = inside;
  for (int i = kSteps; i >= 1; --i) {
    const double t = static_cast<double>(i) / kSteps;
    outline.push_back(
        {wall(t) - thickness,
         std::min(height, foot_height + thickness + (height - foot_height - thickness) * t),
         inside});
  }
  outline.push_back({foot * 0.8, foot_height + thickness, inside});
  outline.push_back({0, foot_height + thickness, inside});
  model.mesh = Turn(outline);
  model.upside_down = 0.12;
  return model;
}

Model MakeCup(Random& random) {
  Model model;
  const double rim = Mm(random, 30, 48), height = 2 * rim * random.Uniform(0.95, 1.9);
  const double base = rim * random.Uniform(0.58, 0.95), thickness = Mm(random, 1, 3.5);
  const Rgb colour = CrockeryColour(random);
  const bool printed = random.Chance(0.35);
  const uint32_t outside =
      model.AddMaterial(printed ? PackagingTexture(random, colour, 6283 * rim, 1000 * height)
                                : CrockeryTexture(random, colour),
                        0.35f);
  const uint32_t inside =
      model.AddMaterial(PlainTexture(random.Chance(0.6) ? colour : Rgb{235, 232, 225}), 0.3f);
  auto outline = OpenVessel(base, rim, height, thickness, outside, inside);
  if (random.Chance(0.4)) {  // a rolled lip
    const double lip = Mm(random, 1, 2.5);
    outline.insert(outline.begin() + 3,
                   {{rim, height - 3 * kMm, outside}, {rim + lip, height - 2 * kMm, outside}});
    outline[5] = {rim + lip, height, inside};
  }
  if (random.Chance(0.15)) {  // coffee to go: a lid on it
    const uint32_t lid = model.AddMaterial(PlainTexture(CrockeryColour(random)), 0.3f);
    const double over = Mm(random, 1, 3), lid_height = Mm(random, 8, 18);
    outline = {{0, 2 * kMm, outside},
               {base * 0.95, 0, outside},
               {rim, height, lid},
               {rim + over, height, lid},
               {rim + over, height + 3 * kMm, lid},
               {rim * 0.9, height + lid_height, lid},
               {rim * 0.82, height + lid_height, lid},
               {rim * 0.8, height + lid_height - 4 * kMm, lid},
               {0, height + lid_height - 4 * kMm, lid}};
  }
  model.mesh = Turn(outline);
  if (random.Chance(0.2)) Bulge(model.mesh, random.Uniform(-0.12, 0.18), height);
  model.lying = 0.1;
  model.upside_down = 0.2;
  return model;
}

Model MakeMug(Random& random) {
  Model model;
  const bool wide = random.Chance(0.2);  // a tea or soup cup with a handle
  const double radius = wide ? Mm(random, 40, 60) : Mm(random, 35, 50);
  const double height = wide ? radius * random.Uniform(1.1, 1.6) : Mm(random, 75, 135);
  const double thickness = Mm(random, 2.5, 5);
  const double base = radius * (wide                 ? random.Uniform(0.55, 0.95)
                                : random.Chance(0.6) ? random.Uniform(0.95, 1.03)
                                                     : random.Uniform(0.7, 0.95));
  const double bulge = random.Chance(0.35) ? random.Uniform(-0.08, 0.2) : 0;
  const Rgb colour = CrockeryColour(random);
  const uint32_t outside = model.AddMaterial(CrockeryTexture(random, colour), 0.5f);
  const uint32_t inside =
      model.AddMaterial(PlainTexture(random.Chance(0.7) ? colour : CrockeryColour(random)), 0.5f);
  const uint32_t plain = model.AddMaterial(PlainTexture(colour), 0.5f);
  model.mesh = Turn(OpenVessel(base, radius, height, thickness, outside, inside));
  Bulge(model.mesh, bulge, height);
  const double reach = Mm(random, 20, 42), low = height * random.Uniform(0.08, 0.4),
               high = height * random.Uniform(0.72, 0.95);
  const double squareness = random.Uniform(0.5, 1);
  std::vector<Eigen::Vector3d> path;
  constexpr int kSteps = 14;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = std::numbers::pi * i / kSteps;
    const double out = std::pow(std::sin(angle), squareness);
    const double up =
        std::copysign(std::pow(std::abs(std::cos(angle)), squareness), std::cos(angle));
    const double z = (low + high) / 2 - (high - low) / 2 * up;
    const double wall =
        (base + (radius - base) * z / height) * Swell(bulge, z / height) - thickness / 2;
    path.push_back({wall + reach * out, 0, z});
  }
  model.mesh.Append(Sweep(path, {0, 1, 0}, Mm(random, 4.5, 10), Mm(random, 3, 5.5), plain));
  model.lying = 0.05;
  model.upside_down = 0.08;
  return model;
}

Model MakeTin(Random& random) {
  Model model;
  const double kind = random.Unit();
  const bool rectangular = kind < 0.25;
  double radius = 0, height = 0, flatness = 1, exponent = 2;
  if (rectangular) {
    radius = Mm(random, 42, 115);
    flatness = random.Uniform(0.55, 1);
    height = Mm(random, 35, 150);
    exponent = random.Uniform(3.5, 14);
  } else if (kind < 0.45) {  // food tin, squat to tall
    radius = Mm(random, 31, 52);
    height = radius * random.Uniform(1.0, 2.9);
  } else if (kind < 0.78) {  // flat: biscuits, fish, polish
    radius = random.Chance(0.5) ? Mm(random, 38, 70) : Mm(random, 70, 110);
    height = std::max(18 * kMm, radius * random.Uniform(0.35, 0.9));
    flatness = random.Chance(0.2) ? random.Uniform(0.6, 0.9) : 1;
  } else {  // tall with a press-in lid: coffee, cocoa
    radius = Mm(random, 34, 52);
    height = radius * random.Uniform(2.2, 3.6);
  }
  const bool flat = !rectangular && kind >= 0.45 && kind < 0.78;
  // Fish and meat are sealed, biscuits and polish have a lid.
  const bool lidded = rectangular ? random.Chance(0.8)
                      : flat      ? random.Chance(radius > 70 * kMm ? 0.95 : 0.5)
                                  : kind >= 0.45;
  const bool emptied = random.Chance(lidded ? 0.08 : 0.15);
  const uint32_t print = model.AddMaterial(
      PackagingTexture(random, PackagingColour(random), 6283 * radius, 1000 * height), 0.5f,
      0.005f);
  const Rgb metal_colour = random.Chance(0.5) ? Rgb{190, 190, 195} : PackagingColour(random);
  const uint32_t metal =
      model.AddMaterial(PlainTexture(metal_colour), 0.7f, random.Chance(0.05) ? 0.2f : 0.0f);
  const double bead = Mm(random, 1, 2.2);
  std::vector<OutlinePoint> outline = {
      {0, 2 * kMm, metal},       {radius - 2 * kMm, 2 * kMm, metal}, {radius - 2 * kMm, 0, metal},
      {radius + bead, 0, metal}, {radius + bead, 3 * kMm, metal},    {radius, 3 * kMm, print}};
  if (lidded) {
    const double lid = std::min(height * random.Uniform(0.12, 0.45), 35 * kMm);
    outline.push_back({radius, height - lid, print});
    outline.push_back({radius + bead, height - lid, print});
    outline.push_back({radius + bead, height - 2 * kMm, metal});
    AddCurve(outline, radius - 2 * kMm, height, true, 3, metal);
    if (random.Chance(0.35)) {  // embossed, or a shallow dome
      const double edge = radius * random.Uniform(0.6, 0.92), rise = Mm(random, -2.5, 5);
      outline.push_back({edge, height, metal});
      outline.push_back({edge - 2 * kMm, height + rise, metal});
      outline.push_back({0, height + rise, metal});
    } else {
      outline.push_back({0, height + (random.Chance(0.4) ? 2 * kMm : 0), metal});
    }
  } else {
    if (random.Chance(0.4)) {  // ribs
      for (double z = height * 0.3; z < height * 0.7; z += 8 * kMm) {
        outline.push_back({radius, z, print});
        outline.push_back({radius - 1.2 * kMm, z + 4 * kMm, print});
      }
    }
    outline.push_back({radius, height - 3 * kMm, metal});
    outline.push_back({radius + bead, height - 3 * kMm, metal});
    outline.push_back({radius + bead, height, metal});
    outline.push_back({radius - 2 * kMm, height, metal});
    outline.push_back({radius - 2 * kMm, height - 3.5 * kMm, metal});
    outline.push_back({0, height - 3.5 * kMm, metal});
  }
  if (emptied) {  // the lid is off: one looks inside
    outline.resize(6);
    outline.push_back({radius, height - 3 * kMm, metal});
    outline.push_back({radius + bead, height - 3 * kMm, metal});
    outline.push_back({radius + bead, height, metal});
    outline.push_back({radius - 1.5 * kMm, height, metal});
    const double filled = random.Chance(0.4) ? height * random.Uniform(0.3, 0.85) : 3 * kMm;
    outline.push_back({radius - 1.5 * kMm, filled, metal});
    outline.push_back({0, filled, metal});
  }
  model.mesh = Turn(outline, flatness, exponent);
  model.lying = height > 1.6 * radius ? 0.12 : 0;
  model.upside_down = 0.08;
  return model;
}

Model MakeTub(Random& random) {
  Model model;
  const bool canister = random.Chance(0.15);  // sweets, chewing gum, spreads
  const double radius = canister ? Mm(random, 30, 50) : Mm(random, 42, 125);
  const double height = canister ? radius * random.Uniform(1.6, 2.9)
                                 : std::min(Mm(random, 40, 140), radius * random.Uniform(0.7, 1.9));
  const bool round = random.Chance(0.6), lidded = canister || random.Chance(0.75);
  const double exponent = round ? 2 : random.Uniform(4, 9);
  const double flatness = round ? 1 : random.Uniform(0.6, 1);
  const double base = radius * random.Uniform(0.72, 0.95);
  const Rgb colour = random.Chance(0.5) ? CrockeryColour(random) : PackagingColour(random);
  const uint32_t outside = model.AddMaterial(
      random.Chance(0.6) ? PackagingTexture(random, colour, 6283 * radius, 1000 * height)
                         : PlainTexture(colour),
      0.3f);
  const Rgb lid_colour = random.Chance(0.5) ? colour : CrockeryColour(random);
  const uint32_t lid = model.AddMaterial(PlainTexture(lid_colour), 0.3f);
  const uint32_t top = model.AddMaterial(
      random.Chance(0.4) ? PackagingTexture(random, lid_colour, 2000 * radius, 400 * radius)
                         : PlainTexture(lid_colour),
      0.3f);
  const double lip = Mm(random, 1.5, 6), thickness = Mm(random, 1, 2.5);
  std::vector<OutlinePoint> outline;
  if (lidded) {
    const double lid_height = Mm(random, 6, 18), recess = random.Chance(0.5) ? Mm(random, 1, 6) : 0;
    outline = {{0, 2 * kMm, outside},
               {base * 0.93, 0, outside},
               {base, 4 * kMm, outside},
               {radius - lip, height - lid_height, lid},
               {radius, height - lid_height, lid},
               {radius, height - 2 * kMm, lid},
               {radius - 2 * kMm, height, lid},
               {radius - 6 * kMm, height, lid},
               {radius - 9 * kMm, height - recess, top}};
    const double plateau = recess > 0 || random.Chance(0.6) ? 0 : Mm(random, 2, 8);
    outline.push_back({radius * 0.75, height - recess, top});
    outline.push_back({radius * 0.72, height - recess + plateau, top});
    outline.push_back({0, height - recess + plateau, top});
  } else {
    outline = {{0, 2 * kMm, outside},
               {base * 0.93, 0, outside},
               {base, 4 * kMm, outside},
               {radius - lip, height - 4 * kMm, outside},
               {radius, height - 4 * kMm, outside},
               {radius, height, lid},
               {radius - lip - thickness, height, lid},
               {base - thickness, 5 * kMm, lid},
               {0, 4 * kMm, lid}};
  }
  model.mesh = Turn(outline, flatness, exponent);
  if (canister && random.Chance(0.5)) Bulge(model.mesh, random.Uniform(-0.2, 0.12), height);
  if (random.Chance(0.15)) {  // two grips
    for (int side : {-1, 1}) {
      const double r = radius - 4 * kMm, z = height - 6 * kMm;
      model.mesh.Append(Sweep({{side * r, 0, z}, {side * (r + Mm(random, 14, 22)), 0, z}},
                              {0, 1, 0}, 15 * kMm, 3 * kMm, lid));
    }
  }
  model.upside_down = lidded ? 0.08 : 0.3;
  return model;
}

}  // namespace beckon::capture
