// SPDX-License-Identifier: Apache-2.0
// A collider's field on a grid: for tools that read distance volumes or meshes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

struct FieldGridOptions {
    std::uint32_t voxels = 128;  ///< along the longest side of the bounds; kVoxelsMin … kVoxelsMax
    bool level_set = true;       ///< what is wanted
    bool surface = true;
};
inline constexpr std::uint32_t kVoxelsMin = 8;
inline constexpr std::uint32_t kVoxelsMax = 1024;

struct FieldGrids {
    /// An OpenVDB file with one grid "surface" of class level set: distances in object units, negative inside, three
    /// voxels to either side of the surface. Voxel (i, j, k) has its centre at voxel size × (i, j, k). The sign is that
    /// of the votes (evaluate()), the distance that to the nearest surface (nearestSurface()). Empty if not wanted.
    std::vector<std::byte> level_set;
    /// The surface of that level set as binary PLY: vertices as floats in object units, quads and triangles,
    /// anticlockwise seen from outside. Empty if not wanted.
    std::vector<std::byte> surface;
    double voxel = 0.0;  ///< the side of one, object units
    /// The share of the collider's surface, 0 … 1, that neither has: parts thinner than a voxel, which no voxel's centre
    /// lies in. An estimate.
    double missing = 0.0;
};

/// The same for any number of threads. Memory: three bytes for each voxel of the box, besides the grid.
/// Errors: kUnsupported (a build without OpenVDB), kLimit (voxels, memory), kInvalidInput (no voxel is inside, or the
/// inside goes on beyond the bounds), kFailure.
[[nodiscard]] Result<FieldGrids> encodeGrids(const Collider& collider, const FieldGridOptions& options = {});

}  // namespace relief
