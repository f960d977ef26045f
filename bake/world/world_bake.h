// SPDX-License-Identifier: Apache-2.0
// A level baked into a world: each different mesh into a container of its own, or a very large one into tiles
// (world_tiles.h), those that are up to date left as they are, and last the file that places them (formats/world).
//
// A container is named by its mesh and by the XXH3-128 of all that it depends on, so that a bake never replaces one that the
// world from before still names: whatever fails, that world stays whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bake/measure/accuracy.h"
#include "bake/pipeline/bake_request.h"
#include "bake/recipe/depfile.h"
#include "bake/verdict/parts_report.h"
#include "bake/world/world_tiles.h"
#include "formats/base/file_guard.h"
#include "formats/base/result.h"
#include "formats/world/world.h"

namespace relief {

inline constexpr std::uint64_t kWorldBudgetDefault = 16'000'000;  ///< bytes

struct WorldRequest {
    /// Of each collider, but that `mesh` is the level's file, `budget` is of all together, and `texel` in units of the level.
    BakeRequest bake;
    std::filesystem::path folder;  ///< is there
    std::uint32_t compress = 0;
    std::uint64_t tile_bytes = PatchTileOptions().bytes;  ///< on the GPU, that a tile should not pass
};

enum class WorldColliderState : std::uint8_t { kBaked, kUpToDate, kFailed };
template <>
inline constexpr std::array<std::string_view, 3> kWordsOf<WorldColliderState>{"baked", "up to date",
                                                                              "failed"};

/// A collider of the world, and its share.
struct WorldColliderResult {
    std::string mesh;  ///< its name in the level
    std::string tile;  ///< its place among those of its mesh, such as 0-1-0; empty: it is all of the mesh
    std::string file;  ///< in the folder
    WorldColliderState state = WorldColliderState::kUpToDate;
    std::uint64_t bodies = 0;
    double area = 0.0;                    ///< of its mesh's surface, in its own space
    double largest_scale = 0.0;           ///< of its bodies
    std::optional<std::uint64_t> budget;  ///< bytes: its mesh's share; not of --texel alone
    std::string hash;                     ///< XXH3-128 of the container
    std::uint64_t bytes = 0;              ///< of the container
    std::uint64_t gpu_bytes = 0;
    Bounds box;
    std::vector<std::string> materials;  ///< names
    bool has_coarse = false;             ///< hasCoarse(), and then the next
    std::optional<WorldFile> coarse;
    std::uint64_t coarse_bytes = 0;     ///< of that container
    std::optional<WrongShare> wrong;    ///< near its mesh's surface; of one that was baked
    std::optional<Verdict> verdict;     ///< if measured; of tiles all have that of the mesh
    IgnoredParts ignored;               ///< sizes in the world; of tiles those of the mesh are at the first
    std::vector<std::string> warnings;  ///< one line each; of tiles those of the mesh are at the first
    double ms = 0.0;                    ///< of its mesh's bake; of tiles at the first
    Error error{};                      ///< of one that failed
};

struct WorldBakeResult {
    World world;
    std::vector<WorldColliderResult> colliders;  ///< in the order of the world's
    std::vector<InputFile> inputs;               ///< the level and the files that it refers to
    std::vector<std::string> warnings;           ///< of the level, one line each
    std::vector<std::string> removed;            ///< containers that only the world from before named
    std::optional<std::uint64_t> budget;         ///< bytes; not of --texel alone
    bool written = false;                        ///< the world; not if a collider failed

    [[nodiscard]] std::size_t countOf(WorldColliderState state) const;
    [[nodiscard]] std::uint64_t gpuBytes() const;
};

/// Each function may be empty. They are called one after the other, from any thread.
struct WorldWatcher {
    std::function<void(const char* stage)> begin;
    std::function<void(std::size_t done, std::size_t all)> ended;  ///< of a collider
    FileGuard* files = nullptr;  ///< gets the files that the level refers to
};

/// Goes on where a collider fails, and then leaves the world as it was; colliders that were baked are found again by the
/// next run.
/// Errors: kUsage (an option that is for one mesh, a budget that is too small), those of importLevel, kIo.
[[nodiscard]] Result<WorldBakeResult> bakeWorld(const WorldRequest& request,
                                                const WorldWatcher& watcher = {});

/// An option that is for one mesh alone, and set: errors kUsage.
[[nodiscard]] Result<void> checkWorldRequest(const BakeRequest& request);

/// The request of one mesh of a level: names that it has no triangle of are left out of `as`, and marks renumbered.
/// \param mesh  whose marks are by `names`.
[[nodiscard]] BakeRequest requestOf(const BakeRequest& request, const std::vector<std::string>& names,
                                    TriangleMesh& mesh);

}  // namespace relief
