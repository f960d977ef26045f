// SPDX-License-Identifier: Apache-2.0
// Encodes a planned tree of patches as a map.
#pragma once

#include <functional>
#include <span>

#include <glm/vec3.hpp>

#include "bake/patches/leaf_fitter.h"
#include "bake/patches/patch_node.h"
#include "formats/depth_map.h"

namespace relief {

/// The grid of a tree's roots.
struct PatchRoots {
    double size = 0.0;       ///< side of a root, object units
    glm::dvec3 origin{0.0};  ///< low corner of the first root, object space
    glm::uvec3 count{1};     ///< number of roots along each axis
};

/// \param nodes  the roots, x fastest.
/// \param progress  as PatchOptions::progress, with the fraction of the encoding done.
[[nodiscard]] DepthMap encodePatches(const MeshQuery& query, const LeafFitter& fitter,
                                     const PatchRoots& roots, std::span<const PatchNode* const> nodes,
                                     const std::function<void(double)>& progress);

}  // namespace relief
