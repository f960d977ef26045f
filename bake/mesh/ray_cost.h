// SPDX-License-Identifier: Apache-2.0
// Estimates the cost of a ray through a mesh.
#pragma once

#include "bake/mesh/mesh.h"

namespace relief {

/// Mean number of triangle boxes on a line through the mesh's box: about the number of triangles tested per ray.
/// Typical models have 2 to 15, forty layers of walls 70, and a fan of 20,000 long thin triangles 4,000, regardless of
/// the BVH.
[[nodiscard]] double boxesOnLine(const TriangleMesh& mesh);

/// Returns the fraction of an ordinary mesh's ray count that is affordable: 1 up to 32 boxes per line, then inversely
/// proportional, so that the total cost stays constant.
[[nodiscard]] double affordableRays(const TriangleMesh& mesh);

}  // namespace relief
