// SPDX-License-Identifier: Apache-2.0
// Proves how deep the errors of a collider can be. Samples find errors that are common; a proof also covers a hole of
// one texel.
//
// Claim: no point farther than `depth` from every triangle is on the wrong side. The proof divides the cells of the
// octree into boxes. In a box with centre c and radius r, with d the distance from c to the nearest triangle:
//
//     the truth     has one side if d > r, because no triangle meets the box
//     the field     has one side in a leaf without heights, and in a patch if the bounds of w − H(u, v), the height
//                   above the patch (PatchFrame), have one sign
//     both agree    no point of the box is wrong
//     otherwise     a wrong point is at most d + r deep; at most r − d if the field has the true side of c in the whole
//                   box, because the segment from c to the point crosses the surface
//
// A box is divided into eight if its bound exceeds the depth of the deepest error found so far by more than the
// tolerance. The centres of boxes are tested as well, so that the bound and that depth converge.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>

#include "bake/mesh/mesh_query.h"
#include "formats/collider.h"

namespace relief {

struct DepthProofOptions {
    /// The proof ends when the bound is at most `tolerance` times the depth of the deepest error.
    double tolerance = 1.1;
    double bound_fraction_min = 1e-4;     ///< bounds below this fraction of the mesh's longest side suffice
    std::uint64_t boxes_max = 2'000'000;  ///< at this number, the proof ends with a larger bound
};

struct DepthProof {
    std::string unproven;  ///< why no depth can be proven; empty if it is proven
    /// Proven bound, object units. It includes the rounding of an evaluation in floats by the library or by shaders
    /// with RELIEF_PRECISE.
    double depth = 0.0;
    double deepest = 0.0;     ///< depth of the deepest error found, object units; 0: none
    glm::vec3 place{0.0F};    ///< of that error, object space
    std::uint64_t boxes = 0;  ///< examined
};

/// Proves nothing if the collider is not a single map of patches, if the map has more than four million cells or
/// numbers above 10³⁰, or if the mesh is not watertight, has filled cavities, or reaches outside the roots. Triangles
/// inside the solid, where parts overlap, count like others. The result does not depend on the number of threads.
/// \param query  of the solid that the collider represents.
[[nodiscard]] DepthProof proveDepth(const MeshQuery& query, const Collider& collider,
                                    const DepthProofOptions& options = {});

}  // namespace relief
