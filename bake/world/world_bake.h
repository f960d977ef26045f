// SPDX-License-Identifier: Apache-2.0
// Bakes a level into a world. Each distinct mesh becomes a container, or several tiles if it is very large
// (world_tiles.h). Containers that are up to date are kept. The file that places all containers (formats/world) is
// written last.
//
// The file name of a container is its mesh's name and a hash of everything that the container depends on. A bake thus
// never replaces a container that the previous world references: if anything fails, that world remains intact.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bake/pipeline/bake_request.h"
#include "bake/recipe/depfile.h"
#include "bake/world/world_collider.h"
#include "formats/base/file_guard.h"
#include "formats/base/result.h"
#include "formats/world/world.h"

namespace relief {

inline constexpr std::uint64_t kWorldBudgetDefault = 16'000'000;  ///< bytes

struct WorldBakeResult {
    World world;
    std::vector<WorldColliderResult> colliders;  ///< in the order of World::colliders
    std::vector<InputFile> inputs;               ///< the level and the files it references
    std::vector<std::string> warnings;           ///< about the level, one line each
    std::vector<std::string> removed;            ///< containers referenced only by the previous world
    std::optional<std::uint64_t> budget;         ///< bytes; nullopt for --texel without --budget
    bool written = false;                        ///< the world was written; false if a collider failed

    [[nodiscard]] std::size_t countOf(WorldColliderState state) const;
    [[nodiscard]] std::uint64_t gpuBytes() const;
};

/// Receives the progress of a bake. Each function may be empty. Calls are sequential, from any thread.
struct WorldWatcher {
    std::function<void(const char* stage)> begin;
    std::function<void(std::size_t done, std::size_t all)> ended;  ///< a mesh is done
    FileGuard* files = nullptr;  ///< receives the files that the level references
};

/// Bakes a level. Continues if a collider fails, and then keeps the previous world; the next run reuses the colliders
/// that were baked.
/// Errors: kUsage (an option for single meshes, a budget that is too small), those of importLevel, kIo.
[[nodiscard]] Result<WorldBakeResult> bakeWorld(const WorldRequest& request,
                                                const WorldWatcher& watcher = {});

/// Checks that no option for single meshes is set. Errors: kUsage.
[[nodiscard]] Result<void> checkWorldRequest(const BakeRequest& request);

/// Returns the request for one mesh of a level. Omits --as options whose name applies to no triangle, and renumbers
/// mesh.marks to match.
/// \param mesh  mesh.marks contains 1 + the index into `names`, or 0.
[[nodiscard]] BakeRequest requestOf(const BakeRequest& request, const std::vector<std::string>& names,
                                    TriangleMesh& mesh);

}  // namespace relief
