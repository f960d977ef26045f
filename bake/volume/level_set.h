// SPDX-License-Identifier: Apache-2.0
// Samples the field of a collider on a grid, for tools that read distance volumes or meshes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

struct FieldGridOptions {
    std::uint32_t voxels = 128;  ///< along the longest side of the bounds; kVoxelsMin … kVoxelsMax
    bool level_set = true;       ///< create FieldGrids::level_set
    bool surface = true;
};
inline constexpr std::uint32_t kVoxelsMin = 8;
inline constexpr std::uint32_t kVoxelsMax = 1024;

struct FieldGrids {
    /// An OpenVDB file with one grid "surface" of class level set: distances in object units, negative inside, in a
    /// band of three voxels on each side of the surface. Voxel (i, j, k) has its centre at voxel size × (i, j, k). The
    /// sign is that of the votes (evaluate()); the distance is that to the nearest surface (nearestSurface()). Empty if
    /// not requested.
    std::vector<std::byte> level_set;
    /// The surface of the level set as binary PLY: vertices as floats in object units, quads and triangles,
    /// counterclockwise seen from outside. Empty if not requested.
    std::vector<std::byte> surface;
    double voxel = 0.0;  ///< side of a voxel, object units
    /// Estimated fraction of the collider's surface, 0 to 1, missing from `level_set` and `surface`: parts thinner than
    /// a voxel that contain no voxel centre.
    double missing = 0.0;
};

/// Creates the level set and the surface. The result does not depend on the number of threads. Memory: three bytes per
/// voxel of the collider's box, in addition to the level set.
/// Errors: kUnsupported (a build without OpenVDB), kLimit (voxels, memory), kInvalidInput (no voxel is inside, or the
/// inside extends beyond solidBox()), kFailure.
[[nodiscard]] Result<FieldGrids> encodeGrids(const Collider& collider, const FieldGridOptions& options = {});

}  // namespace relief
