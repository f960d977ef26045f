// SPDX-License-Identifier: Apache-2.0
#include "bake/world/world_cache.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "bake/world/coarse_collider.h"
#include "bake/world/world_files.h"
#include "formats/base/file_io.h"
#include "formats/base/hash.h"
#include "formats/base/text.h"
#include "formats/container.h"
#include "formats/fields/text.h"

namespace relief {
namespace {

/// Options that affect how a bake runs, but not its bytes.
constexpr std::array<std::string_view, 6> kWithoutEffect = {
    "threads", "timeout", "no_check", "max_import_memory", "import_timeout", "max_triangles"};
constexpr std::size_t kKeyDigits = 16;
/// Prefix of a cache option that lists the tiles of a mesh.
constexpr std::string_view kTilesWord = "--tiles=";

bool isUpToDate(const std::filesystem::path& folder, const BakeCacheEntry& expected,
                const BakeCacheEntries& cache, WorldColliderResult& collider) {
    const auto found = cache.find(collider.file);
    if (found == cache.end()) {
        return false;
    }
    const BakeCacheEntry& known = found->second;
    if (known.tool != expected.tool || known.options != expected.options || known.inputs != expected.inputs) {
        return false;
    }
    const auto bytes = readFile(folder / collider.file);
    if (!bytes || xxh3_128Hex(*bytes) != known.output_hash) {
        return false;
    }
    const Result<Collider> there = readContainer(*bytes);
    if (there) {
        copyContainerInfo(*there, *bytes, collider);
    }
    return there.has_value();
}

bool coarseIsUpToDate(const std::filesystem::path& folder, const BakeCacheEntry& expected,
                      const BakeCacheEntries& cache, WorldColliderResult& collider) {
    if (!collider.has_coarse) {
        return true;
    }
    WorldColliderResult coarse;
    coarse.file = coarseFile(collider.file);
    if (!isUpToDate(folder, expected, cache, coarse)) {
        return false;
    }
    collider.coarse = WorldFile{coarse.file, coarse.hash, coarse.gpu_bytes};
    collider.coarse_bytes = coarse.bytes;
    return true;
}

/// Returns the tiles of a mesh, as listed in the cache entry of any of its tiles.
std::vector<std::string> knownTiles(const ContainerNames& names, const BakeCacheEntries& cache) {
    const auto& [front, back] = names;
    std::vector<std::string> tiles;
    for (auto at = cache.lower_bound(front); at != cache.end() && at->first.starts_with(front); ++at) {
        const std::vector<std::string>& options = at->second.options;
        if (!at->first.ends_with(back) || options.empty() || !options.back().starts_with(kTilesWord)) {
            continue;
        }
        const std::string list = options.back().substr(kTilesWord.size());
        for (std::size_t from = 0; from < list.size();) {
            const std::size_t end = std::min(list.find(',', from), list.size());
            tiles.push_back(list.substr(from, end - from));
            from = end + 1;
        }
        break;
    }
    return tiles;
}

}  // namespace

std::vector<std::string> cacheOptions(const BakeRequest& request, std::uint32_t compress) {
    std::vector<std::string> words = {"--compress=" + std::to_string(compress)};
    for (const FieldWords& field : changedFields(request)) {
        for (const std::string& word : field.words) {
            if (std::find(kWithoutEffect.begin(), kWithoutEffect.end(), field.name) == kWithoutEffect.end()) {
                words.push_back(optionName(field.name) + "=" + word);
            }
        }
    }
    return words;
}

ContainerNames ContainerNames::of(const std::string& mesh, const BakeCacheEntry& entry) {
    return {fileStem(mesh) + "-",
            "-" + assetKey(entry.tool, entry.options, entry.inputs).substr(0, kKeyDigits) +
                std::string(kColliderExtension)};
}

std::string ContainerNames::fileOf(const std::string& tile) const {
    return front + tile + (tile.empty() ? back.substr(1) : back);
}

std::string coarseFile(const std::string& file) {
    const std::size_t key = file.size() - kColliderExtension.size() - kKeyDigits;
    return file.substr(0, key) + "coarse-" + file.substr(key);
}

std::string tilesOption(const std::vector<std::string>& tiles) {
    std::string word(kTilesWord);
    for (const std::string& tile : tiles) {
        word += (word.size() == kTilesWord.size() ? "" : ",") + tile;
    }
    return word;
}

void copyContainerInfo(const Collider& from, std::span<const std::byte> bytes,
                       WorldColliderResult& collider) {
    collider.box = from.bounds;
    collider.gpu_bytes = from.texelBytes();
    collider.has_coarse = hasCoarse(from);
    collider.bytes = bytes.size();
    collider.hash = xxh3_128Hex(bytes);
    collider.materials.clear();
    for (const Material& material : from.materials.list) {
        collider.materials.push_back(material.name);
    }
}

std::vector<WorldColliderResult> upToDate(const std::filesystem::path& folder,
                                          const WorldColliderResult& whole, const ContainerNames& names,
                                          BakeCacheEntry expected, const BakeCacheEntries& cache) {
    WorldColliderResult part = whole;
    if (isUpToDate(folder, expected, cache, part)) {
        return coarseIsUpToDate(folder, expected, cache, part) ? std::vector{part}
                                                               : std::vector<WorldColliderResult>();
    }
    std::vector<WorldColliderResult> parts;
    const std::vector<std::string> tiles = knownTiles(names, cache);
    expected.options.push_back(tilesOption(tiles));
    for (const std::string& tile : tiles) {
        part.tile = tile;
        part.file = names.fileOf(tile);
        part.coarse.reset();
        const bool twice = !parts.empty() && std::ranges::count(tiles, tile) > 1;
        if (twice || !isTileName(tile) || !isUpToDate(folder, expected, cache, part) ||
            !coarseIsUpToDate(folder, expected, cache, part)) {
            return {};
        }
        parts.push_back(part);
    }
    return parts;
}

}  // namespace relief
