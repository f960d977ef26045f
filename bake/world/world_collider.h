// SPDX-License-Identifier: Apache-2.0
// The request to bake a world, and the result for each collider.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bake/measure/accuracy.h"
#include "bake/pipeline/bake_request.h"
#include "bake/verdict/parts_report.h"
#include "bake/world/world_tiles.h"
#include "formats/base/result.h"
#include "formats/world/world.h"

namespace relief {

struct WorldRequest {
    /// The request for each collider, with three exceptions: `mesh` is the file of the level, `budget` is shared by all
    /// colliders, and `texel` is in units of the level.
    BakeRequest bake;
    std::filesystem::path folder;  ///< must exist
    std::uint32_t compress = 0;
    std::uint64_t tile_bytes = PatchTileOptions().bytes;  ///< target size of a tile, bytes on the GPU
};

enum class WorldColliderState : std::uint8_t { kBaked, kUpToDate, kFailed };
template <>
inline constexpr std::array<std::string_view, 3> kWordsOf<WorldColliderState>{"baked", "up_to_date",
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
    std::optional<WrongPercent> wrong;  ///< near the surface of the mesh; for a baked collider
    std::optional<Verdict> verdict;     ///< if measured; all tiles have the verdict of their mesh
    IgnoredParts ignored;               ///< sizes in world space; for tiles, only in the first
    std::vector<std::string> warnings;  ///< one line each; for tiles, only in the first
    double ms = 0.0;                    ///< bake of the mesh; for tiles, only in the first
    Error error{};                      ///< if it failed
};

}  // namespace relief
