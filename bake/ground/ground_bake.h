// SPDX-License-Identifier: Apache-2.0
// A height map baked into one collider, or into tiles and the world file that places them (formats/world).
//
//      squares of a row:  0 ... 1020 1024 1028 ... 2044 2048 2052
//      tile 0             |----------------|
//      tile 1                     |----------------------|
//
// Each tile goes a leaf beyond its own squares. Where tiles overlap their leaves are the same, bit by bit, so that the union of both
// is the surface of either, and no point of a seam lies outside of all. The coarse likeness of a tile has every fourth sample, and
// the same roots. Containers are named by their contents: a bake
// never replaces one that the world from before still names.
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
    std::string file;  ///< in the folder of the world; empty of a single collider
    std::string hash;  ///< XXH3-128 of the container
    std::uint64_t bytes = 0;
    std::uint64_t gpu_bytes = 0;
    std::optional<WorldFile> coarse;  ///< where hasCoarse()
    std::uint64_t squares = 0;        ///< with ground
    std::uint64_t steep = 0;  ///< of its own squares, without the rim, those that are steeper than kSteepest
    double error_max = 0.0;   ///< of its heights but those of steep squares, metres; 0: all are steep
    Bounds box;               ///< of its surface, in its own space
};

struct GroundResult {
    std::uint32_t columns = 0;  ///< of the height map
    std::uint32_t rows = 0;
    HeightsSpec heights;                ///< settings, with those that the map's name implies
    std::vector<InputFile> inputs;      ///< the height map, of a request
    std::vector<GroundTile> tiles;      ///< those with ground, row by row
    std::vector<std::byte> container;   ///< without a folder
    std::vector<std::string> removed;   ///< containers that only the world from before named
    std::vector<std::string> warnings;  ///< one line each

    [[nodiscard]] std::uint64_t gpuBytes() const;
    [[nodiscard]] double errorMax() const;  ///< of all tiles, metres; 0: all is steep
};

struct GroundOptions {
    HeightsSpec heights;
    std::filesystem::path folder;  ///< of the world, is there; empty: a single collider
    std::uint32_t compress = 0;
    /// Called now and then with the share of the work done; may be empty.
    std::function<void(double)> progress{};
};

/// Holds a row of tiles in memory at a time, or all of a single collider. The same for any number of threads.
/// \param map  of which no row was read yet.
/// Errors, with the file in front: kInvalidInput (a damaged image; no square has ground), kLimit (a tree or a world that is too
/// large); kIo.
[[nodiscard]] Result<GroundResult> bakeGroundOf(HeightMap& map, const GroundOptions& options);

/// The same of a request's height map, by as many threads.
/// \param options  whose heights are the request's.
/// Errors: also those of settingsOf and HeightMap::open.
[[nodiscard]] Result<GroundResult> bakeGroundOf(const BakeRequest& request, GroundOptions options);

}  // namespace relief
