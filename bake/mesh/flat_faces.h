// SPDX-License-Identifier: Apache-2.0
// Finds the flat faces of a mesh, independent of their tessellation.
#pragma once

#include <vector>

#include "bake/mesh/mesh.h"

namespace relief {

/// A set of connected triangles whose normals differ from the first triangle's by at most 1e-4 radians, or by the
/// effect of rounded vertices (up to 0.01 radians) if that is larger. Vertices are assumed to be rounded to a millionth
/// of the mesh's longest side, or to floats.
struct FlatFace {
    double area = 0.0;
    double length =
        0.0;  ///< the longest triangle edge, or the side of a square of equal area if that is longer
};

/// Returns the face of each triangle; a triangle without area is a face of its own.
[[nodiscard]] std::vector<FlatFace> flatFacesOf(const TriangleMesh& mesh);

}  // namespace relief
