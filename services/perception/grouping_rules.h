// What speaks for and against two neighbouring patches being of one object: one function a rule.
#pragma once

#include <vector>

#include "services/perception/patch_graph.h"
#include "services/perception/region_clustering.h"

namespace beckon::perception {

/// How the surfaces of two patches meet: the angle between their normals, positive where the edge
/// is convex, negative where it is concave, rad (Stein et al., "Object Partitioning using Local
/// Convexity", 2014, eq. 1).
float CreaseAngle(const Patch& a, const Patch& b);

/// Whether patches meet only at a corner, so that their crease tells nothing: the line between
/// their centres runs along the line their planes cut in (the sanity criterion of Stein et al.
/// 2014, eq. 4-5).
bool MeetAtCorner(const Patch& a, const Patch& b);

/// 1 on one smooth surface and over a convex edge, negative over a concave one, down to -1. What
/// noise does to the angle is allowed for.
float ConvexityEvidence(const Patch& a, const Patch& b);

/// The patches that each patch touches.
using Neighbours = std::vector<std::vector<int>>;
Neighbours FindNeighbours(const SurfacePatches& patches, const std::vector<PatchEdge>& edges);

/// Whether the surface bends on both sides of the edge between a and b as it does across it: then
/// it is the smooth inside of something round, and no crease.
bool BendsThroughout(const SurfacePatches& patches, const Neighbours& neighbours, int a, int b);

/// The evidence of an edge of the graph by all local rules.
SignedEdge LocalEvidence(const SurfacePatches& patches, const Neighbours& neighbours,
                         const PatchEdge& edge);

}  // namespace beckon::perception
