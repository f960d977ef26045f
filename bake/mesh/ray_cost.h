// SPDX-License-Identifier: Apache-2.0
// The cost of a ray through a mesh.
#pragma once

#include "bake/mesh/mesh.h"

namespace relief {

/// Mean number of triangles' boxes on a line through the mesh's box: about as many triangles are tested per ray. Artists'
/// meshes have 2 to 15, forty layers of walls 70, and a fan of 20,000 long thin triangles 4,000, whatever the tree.
[[nodiscard]] double boxesOnLine(const TriangleMesh& mesh);

/// The affordable share of the rays that an ordinary mesh gets: 1 up to 32 boxes on a line, then inversely proportional, so
/// that the total cost stays the same.
[[nodiscard]] double affordableRays(const TriangleMesh& mesh);

}  // namespace relief
