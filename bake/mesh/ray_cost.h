// What a ray through a mesh costs.
#pragma once

#include "bake/mesh/mesh.h"

namespace relief {

/// How many boxes of triangles a straight line through the mesh's box meets in the mean: about so many triangles are asked
/// whether a ray meets them. Of meshes as artists make them it is 2 to 15, of forty layers of walls 70; where triangles are
/// long and thin and their boxes lie in each other, as in a fan of 20,000, it is 4,000, in whatever tree they are.
[[nodiscard]] double boxesOnLine(const TriangleMesh& mesh);

/// Of the rays that a stage asks of an ordinary mesh, the share that is affordable here: 1 up to 32 boxes on a line, and
/// then so little that all rays together cost the same.
[[nodiscard]] double affordableRays(const TriangleMesh& mesh);

}  // namespace relief
