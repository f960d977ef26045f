// SPDX-License-Identifier: Apache-2.0
// Bakes a level into a world. Each distinct mesh becomes a container, or several tiles if it is very large
// (world_tiles.h). Containers that are up to date are kept. The file that places them (formats/world) is written last.
//
// The name of a container consists of its mesh and the XXH3-128 of everything it depends on. A bake therefore never
// replaces a container that the previous world references: if anything fails, that world remains intact.
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
    /// For each collider, except: `mesh` is the file of the level, `budget` is shared by all, and `texel` is in units
    /// of the level.
    BakeRequest bake;
    std::filesystem::path folder;  ///< must exist
    std::uint32_t compress = 0;
    std::uint64_t tile_bytes = PatchTileOptions().bytes;  ///< target size of a tile, bytes on the GPU
};

enum class WorldColliderState : std::uint8_t { kBaked, kUpToDate, kFailed };
template <>
inline constexpr std::array<std::string_view, 3> kWordsOf<WorldColliderState>{"baked", "up to date",
                                                                              "failed"};

/// A collider of the world, and its share of the budget.
struct WorldColliderResult {
    std::string mesh;  ///< name in the level
    std::string tile;  ///< position among the tiles of its mesh, such as 0-1-0; empty: the whole mesh
    std::string file;  ///< relative to the folder
    WorldColliderState state = WorldColliderState::kUpToDate;
    std::uint64_t bodies = 0;
    double area = 0.0;                    ///< of the mesh's surface, object space
    double largest_scale = 0.0;           ///< of the bodies
    std::optional<std::uint64_t> budget;  ///< bytes: share of the mesh; nullopt for --texel without --budget
    std::string hash;                     ///< XXH3-128 of the container
    std::uint64_t bytes = 0;              ///< of the container
    std::uint64_t gpu_bytes = 0;
    Bounds box;
    std::vector<std::string> materials;  ///< names
    bool has_coarse = false;             ///< hasCoarse(); if true, the next two members are set
    std::optional<WorldFile> coarse;
    std::uint64_t coarse_bytes = 0;     ///< size of that container
    std::optional<WrongShare> wrong;    ///< near the surface of the mesh; for a baked collider
    std::optional<Verdict> verdict;     ///< if measured; all tiles have the verdict of their mesh
    IgnoredParts ignored;               ///< sizes in world space; for tiles, only in the first
    std::vector<std::string> warnings;  ///< one line each; for tiles, only in the first
    double ms = 0.0;                    ///< bake of the mesh; for tiles, only in the first
    Error error{};                      ///< if it failed
};

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

/// Follows a bake. Each function may be empty. Calls are sequential, from any thread.
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

/// Returns the request for one mesh of a level: removes names without triangles in the mesh from `as`, and renumbers
/// the marks.
/// \param mesh  its marks are indices into `names`.
[[nodiscard]] BakeRequest requestOf(const BakeRequest& request, const std::vector<std::string>& names,
                                    TriangleMesh& mesh);

}  // namespace relief
