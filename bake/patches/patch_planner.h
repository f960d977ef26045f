// SPDX-License-Identifier: Apache-2.0
// Plans a tree of patches: which cells are split, and how many heights each leaf has. Minimizes the errors within a
// number of bytes, or reaches a uniform texel size.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "bake/mesh/mesh_query.h"
#include "bake/patches/leaf_fitter.h"
#include "bake/patches/patch_tiles.h"
#include "formats/base/result.h"
#include "formats/depth_map.h"

namespace relief {

struct PatchOptions {
    /// Size of the tree in bytes, kPatchBytesMin to kPatchBytesMax; an upper limit if `texel` is set.
    std::uint64_t bytes = 1'000'000;
    /// Object units. If above 0, the texel determines the tree instead of the bytes: a cell is split while the error of
    /// its patch exceeds a quarter of the texel and the cell's side is longer than two texels.
    double texel = 0.0;
    bool coarsen = false;  ///< if the tree exceeds the bytes, uses a larger texel
    /// Object units: a box that the roots contain in addition to the mesh.
    std::optional<Bounds> roots_contain{};
    /// If a tree exceeds this size, its roots are small, so that it can be cut into tiles of this size (patch_tiles.h).
    /// If `texel` is 0, the roots are always small.
    std::uint64_t tile_bytes = PatchTileOptions().bytes;
    ErrorCosts costs{};
    LeafLines lines{};
    /// The planner tries to split a leaf if fixing its errors is worth more than this many bytes. Lower values find
    /// better trees and take longer.
    double trial_bytes = 45.0;
    /// Called periodically with the fraction of the work done; from any thread, never concurrently. Its exceptions end
    /// the bake and propagate.
    std::function<void(double)> progress{};
};

struct PatchTree {
    DepthMap map;        ///< of MapFormat::kPatches
    double texel = 0.0;  ///< object units: PatchOptions::texel, or larger if coarsened
};

/// The size of a tree and its errors.
struct ErrorPoint {
    double bytes = 0.0;
    double wrong = 0.0;  ///< weighted volume of the errors, object units cubed

    bool operator==(const ErrorPoint&) const = default;
};
/// Sorted by bytes; each tree is larger and has fewer errors than the previous one.
using ErrorCurve = std::vector<ErrorPoint>;

/// Returns the sizes and errors of trees that bakePatches() tries, including some that are too large. Takes as long as
/// a bake without its encoding. The result does not depend on the number of threads.
/// \param options  `texel` must be 0.
[[nodiscard]] ErrorCurve planErrors(const MeshQuery& query, const PatchOptions& options);

/// Bakes a mesh into a tree of patches. The result does not depend on the number of threads.
/// Errors: kUsage (a texel too fine for floats), kLimit (the tree exceeds the bytes, and `coarsen` is false).
[[nodiscard]] Result<PatchTree> bakePatches(const MeshQuery& query, const PatchOptions& options);

}  // namespace relief
