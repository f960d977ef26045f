// SPDX-License-Identifier: Apache-2.0
// A tree of patches: which cells are split, and how many heights each leaf has, within a number of bytes by what a byte more
// would mend there, or by the texel that is wanted everywhere.
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
    /// kPatchBytesMin to kPatchBytesMax; of a tree by texel the most that it may take.
    std::uint64_t bytes = 1'000'000;
    /// Object units; above 0 it decides in place of the bytes: a cell is split as long as its patch is off by more than a quarter
    /// of the texel, and its side is longer than two of them.
    double texel = 0.0;
    bool coarsen = false;                ///< where that takes more bytes, a texel is taken that does not
    std::optional<Bounds> roots_hold{};  ///< object units: a box that the roots hold beside the mesh
    /// A tree by texel that takes more has small roots, so that it can be cut into tiles of this size (patch_tiles.h); one by
    /// bytes always has.
    std::uint64_t tile_bytes = PatchTileOptions().bytes;
    ErrorCosts costs{};
    LeafLines lines{};
    /// A leaf is split on trial where it has more errors than so many bytes are worth: fewer find more, in more time.
    double trial_bytes = 45.0;
    /// Called now and then, from any thread but from one at a time, with the share of the work done; what it throws ends it.
    std::function<void(double)> progress{};
};

struct PatchTree {
    DepthMap map;        ///< of MapFormat::kPatches
    double texel = 0.0;  ///< object units: that of the options or, coarsened, a larger one; 0: by bytes
};

/// A tree by bytes.
struct ErrorPoint {
    double bytes = 0.0;
    double wrong = 0.0;  ///< its errors: volume, object units cubed, times its costs

    bool operator==(const ErrorPoint&) const = default;
};
/// By bytes; each tree is larger and has fewer errors than the one before.
using ErrorCurve = std::vector<ErrorPoint>;

/// Trees that bakePatches() tries on the way to the one that it takes, some of them too large: a curve for the time of a plan
/// without its encoding. The same for any number of threads.
/// \param options  whose texel is 0.
[[nodiscard]] ErrorCurve planErrors(const MeshQuery& query, const PatchOptions& options);

/// The same for any number of threads.
/// Errors: kUsage (a texel that floats do not resolve), kLimit (one that takes more bytes, without `coarsen`).
[[nodiscard]] Result<PatchTree> bakePatches(const MeshQuery& query, const PatchOptions& options);

}  // namespace relief
