// SPDX-License-Identifier: Apache-2.0
// The flat faces of a mesh, however finely they are divided.
#pragma once

#include <vector>

#include "bake/mesh/mesh.h"

namespace relief {

/// Connected triangles whose normals are within 1e-4 of the first one's, or as far from it as rounding may turn them: vertices to a
/// millionth of the mesh's longest side, or to floats.
struct FlatFace {
    double area = 0.0;
    double length =
        0.0;  ///< the longest edge of a triangle, or the side of a square of that area if that is longer
};

/// \return per triangle, the face that it is part of; one without area is a face of its own.
[[nodiscard]] std::vector<FlatFace> flatFacesOf(const TriangleMesh& mesh);

}  // namespace relief
