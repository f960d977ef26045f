// A tree of patches within a number of bytes: which cells are split, and how many heights each leaf has, by what a byte more
// would mend there.
#pragma once

#include <cstdint>

#include "bake/mesh/mesh_query.h"
#include "formats/depth_map.h"

namespace relief {

/// A map of MapFormat::kPatches of at most `bytes`. The same for any number of threads.
/// \pre kPatchBytesMin ≤ bytes ≤ kPatchBytesMax
[[nodiscard]] DepthMap bakePatches(const MeshQuery& query, std::uint64_t bytes);

}  // namespace relief
