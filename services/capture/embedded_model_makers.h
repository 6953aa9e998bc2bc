// The makers of each category's objects; sizes are in metres. Used by embedded_model.cpp alone.
#pragma once

#include "services/capture/embedded_model.h"

namespace beckon::capture {

Model MakeBottle(Random& random);
Model MakeCan(Random& random);
Model MakeSprayCan(Random& random);
Model MakeTube(Random& random);
Model MakeBowl(Random& random);
Model MakeCup(Random& random);
Model MakeMug(Random& random);
Model MakeTin(Random& random);
Model MakeTub(Random& random);
Model MakeBox(Random& random);
Model MakeCarton(Random& random);

/// A point of an outline that is turned around the z axis.
struct OutlinePoint {
  double radius;
  double z;
  uint32_t material = 0;  // of the surface from here on
};

/// Turns an outline; `flatness` shrinks y, `exponent` squares the cross-section. v runs over the
/// height.
Mesh Turn(const std::vector<OutlinePoint>& outline, double flatness = 1, double exponent = 2);

/// `n` points of a quarter of a superellipse from (r0, z0), leaving along z where `along_z_first`,
/// to (r1, z1); the start is left out.
void AddCurve(std::vector<OutlinePoint>& outline, double r1, double z1, bool along_z_first, int n,
              uint32_t material);

}  // namespace beckon::capture
