// A tree of patches within a number of bytes: which cells are split, and how many heights each leaf has, by what a byte more
// would mend there.
#pragma once

#include <cstdint>
#include <functional>

#include "bake/mesh/mesh_query.h"
#include "bake/patches/cell_columns.h"
#include "formats/depth_map.h"

namespace relief {

struct PatchOptions {
    std::uint64_t bytes = 1'000'000;  ///< kPatchBytesMin to kPatchBytesMax
    MistakeCosts costs{};
    /// Lines along each side of a cell: to choose by, and for the 5² heights that are kept. Multiples of 4.
    unsigned lines = 12;
    unsigned final_lines = 20;
    /// A leaf is split on trial where it has more mistakes than so many bytes are worth: fewer find more, in more time.
    double trial_bytes = 45.0;
    /// Called now and then, from any thread but from one at a time, with the share of the work done; what it throws ends it.
    std::function<void(double)> progress{};
};

/// A map of MapFormat::kPatches of at most so many bytes. The same for any number of threads.
[[nodiscard]] DepthMap bakePatches(const MeshQuery& query, const PatchOptions& options);

}  // namespace relief
