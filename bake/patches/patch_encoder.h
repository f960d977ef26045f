// SPDX-License-Identifier: Apache-2.0
// A tree of patches, planned, as a map.
#pragma once

#include <functional>
#include <span>

#include <glm/vec3.hpp>

#include "bake/patches/leaf_fitter.h"
#include "bake/patches/patch_node.h"
#include "formats/depth_map.h"

namespace relief {

/// The roots of a tree.
struct PatchRoots {
    double size = 0.0;       ///< of one, object units
    glm::dvec3 origin{0.0};  ///< the low corner of the first, object space
    glm::uvec3 count{1};     ///< x fastest
};

/// \param nodes  of the roots.
/// \param progress  as that of PatchOptions; the share is that of the encoding.
[[nodiscard]] DepthMap encodePatches(const MeshQuery& query, const LeafFitter& fitter,
                                     const PatchRoots& roots, std::span<const PatchNode* const> nodes,
                                     const std::function<void(double)>& progress);

}  // namespace relief
