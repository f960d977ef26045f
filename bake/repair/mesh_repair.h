// SPDX-License-Identifier: Apache-2.0
// Wraps meshes with CGAL, and converts its exceptions to errors.
#pragma once

#include "bake/mesh/mesh.h"
#include "formats/base/result.h"

namespace relief {

inline constexpr double kWrapAlphaMin = 0.001;
inline constexpr double kWrapAlphaMax = 0.5;

/// Shrinks a surface around the mesh that does not enter holes smaller than alpha. The result is closed, manifold,
/// wound outwards and free of self-intersections. It contains the whole mesh, at an offset of alpha/30. Keeps name,
/// hash and unit; the bounds grow by the offset. Single-threaded and deterministic. Source: Portaneri, Rouxel-Labbe,
/// Hemmer, Cohen-Steiner and Alliez, "Alpha wrapping with an offset" (2022).
/// Time and triangles are proportional to area / alpha²: 60,000 triangles and 15 s for a bunny at 0.01.
/// \param alpha  in units of the mesh's longest side, in [kWrapAlphaMin, kWrapAlphaMax].
/// Errors: kUsage (alpha), kLimit (out of memory), kFailure.
[[nodiscard]] Result<TriangleMesh> wrapMesh(const TriangleMesh& mesh, double alpha);

}  // namespace relief
