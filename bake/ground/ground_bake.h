// SPDX-License-Identifier: Apache-2.0
// Bakes a height map into one collider, or into tiles and the world file that places them (formats/world).
//
//      squares of a row:  0 ... 1020 1024 1028 ... 2044 2048 2052
//      tile 0             |----------------|
//      tile 1                     |---------------------------|
//
// Each tile extends one leaf beyond its own squares. Leaves in the overlap of two tiles are bit-identical, so that the
// union of both has the same surface, and no point of a seam lies outside all tiles. A tile's coarse collider uses
// every fourth sample and has the same roots. Containers are named by content hash: a bake never replaces a container
// that the previous world references.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bake/ground/ground_tree.h"
#include "bake/height_map/height_map.h"
#include "bake/height_map/heights_spec.h"
#include "bake/pipeline/bake_request.h"
#include "bake/recipe/depfile.h"
#include "formats/base/result.h"
#include "formats/world/world.h"

namespace relief {

struct GroundTile {
    std::string file;  ///< in the folder of the world; empty for a single collider
    std::string hash;  ///< XXH3-128 of the container
    std::uint64_t bytes = 0;
    std::uint64_t gpu_bytes = 0;
    std::optional<WorldFile> coarse;  ///< set if hasCoarse()
    std::uint64_t squares = 0;        ///< number of squares with ground
    std::uint64_t steep = 0;          ///< number of squares steeper than kSteepest, excluding the overlap
    double error_max = 0.0;  ///< largest height error, excluding steep squares, metres; 0: all are steep
    Bounds box;              ///< of its surface, in its own space
};

struct GroundResult {
    std::uint32_t columns = 0;  ///< of the height map
    std::uint32_t rows = 0;
    HeightsSpec heights;                ///< settings, including those that the file's extension implies
    std::vector<InputFile> inputs;      ///< the height map of a BakeRequest; otherwise empty
    std::vector<GroundTile> tiles;      ///< only tiles with ground, row by row
    std::vector<std::byte> container;   ///< set if there is no folder
    std::vector<std::string> removed;   ///< containers referenced only by the previous world
    std::vector<std::string> warnings;  ///< one line each

    [[nodiscard]] std::uint64_t gpuBytes() const;
    [[nodiscard]] double errorMax() const;  ///< over all tiles, metres; 0: all squares are steep
};

struct GroundOptions {
    HeightsSpec heights;
    std::filesystem::path folder;  ///< existing folder of the world; empty: a single collider
    std::uint32_t compress = 0;
    /// Called occasionally with the completed fraction; may be empty.
    std::function<void(double)> progress{};
};

/// Bakes a height map. Holds one row of tiles in memory, or the whole map for a single collider. The result does not
/// depend on the number of threads.
/// \param map  positioned before its first row.
/// Errors: kUsage (a tile size without a folder); prefixed with the file: kInvalidInput (a damaged image; no square has
/// ground), kLimit (the tree or world is too large), kIo.
[[nodiscard]] Result<GroundResult> bakeHeightMap(HeightMap& map, const GroundOptions& options);

/// Bakes the height map of a request, with the request's number of threads.
/// \param options  `heights` comes from the request.
/// Errors: also those of settingsOf and HeightMap::open.
[[nodiscard]] Result<GroundResult> bakeHeightMap(const BakeRequest& request, GroundOptions options);

}  // namespace relief
