// SPDX-License-Identifier: Apache-2.0
// Names the containers of a world, and finds those that are up to date according to its cache.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "bake/recipe/bake_cache.h"
#include "bake/world/world_collider.h"

namespace relief {

/// Returns the options of a request that affect the bytes of a container, as words of a command line.
[[nodiscard]] std::vector<std::string> cacheOptions(const BakeRequest& request, std::uint32_t compress);

/// The file names of the containers of one mesh: `front` + name of a tile + `back`.
struct ContainerNames {
    std::string front;
    std::string back;

    /// \param entry  cache entry of the mesh, without outputs.
    [[nodiscard]] static ContainerNames of(const std::string& mesh, const BakeCacheEntry& entry);
    /// \param tile  its name; empty for the whole mesh.
    [[nodiscard]] std::string fileOf(const std::string& tile) const;
};

/// Returns the name of the coarse container beside a container.
[[nodiscard]] std::string coarseFile(const std::string& file);

/// Returns the cache option that lists all tiles of a mesh; part of the entry of each tile.
[[nodiscard]] std::string tilesOption(const std::vector<std::string>& tiles);

/// Copies the properties of a container into the result of its collider.
void copyContainerInfo(const Collider& from, std::span<const std::byte> bytes, WorldColliderResult& collider);

/// Finds the colliders of a mesh in the folder of a world.
/// \param whole  copied to each result; whole.file is names.fileOf("").
/// \param expected  cache entry of the mesh, without outputs.
/// \return empty unless all are up to date.
[[nodiscard]] std::vector<WorldColliderResult> upToDate(const std::filesystem::path& folder,
                                                        const WorldColliderResult& whole,
                                                        const ContainerNames& names, BakeCacheEntry expected,
                                                        const BakeCacheEntries& cache);

}  // namespace relief
