// SPDX-License-Identifier: Apache-2.0
#include "bake/patches/patch_tiles.h"

#include <algorithm>
#include <bit>
#include <glm/common.hpp>

#include "bake/mesh/loops.h"
#include "formats/patch_tree.h"

namespace relief {
namespace {

/// Minimum number of roots along the side of a tile, without the extra ones.
constexpr std::uint32_t kRootsMin = 4;

std::uint32_t childCount(const PatchRecord& split) {
    return static_cast<std::uint32_t>(std::popcount(split.children()));
}

/// Texels of a leaf in addition to its record.
std::uint32_t leafTexels(PatchTexels texels, const PatchRecord& leaf) {
    if (leaf.kind() != PatchRecord::Kind::kPatch) {
        return 0;
    }
    if (!leaf.isPair()) {
        return heightTexels(leaf.side());
    }
    return 2 + heightTexels(patchTexel(texels, leaf.first()).side()) +
           heightTexels(patchTexel(texels, leaf.first() + 1).side());
}

PatchRecord withFirstTexel(PatchRecord record, std::uint32_t first) {
    record.high = (record.high & 0xff000000U) | first;
    return record;
}

/// Copies roots and their descendants in the order of encodePatches().
class Copier {
  public:
    explicit Copier(PatchTexels from) : from_(from) {}

    [[nodiscard]] std::vector<PatchRecord> copy(const glm::uvec3& first, const glm::uvec3& count) {
        gather(first, count);
        std::uint32_t next = 1 + static_cast<std::uint32_t>(records_.size());
        for (std::size_t i = 0; i < records_.size(); ++i) {
            if (!isSplit(records_[i])) {
                first_texels_[i] = next;
                next += leafTexels(from_, records_[i]);
            }
        }
        texels_.resize(next);
        texels_[0] = {count.x | count.y << 16U, count.z | levels_ << 16U};
        for (std::size_t i = 0; i < records_.size(); ++i) {
            const PatchRecord& record = records_[i];
            texels_[1 + i] = isSplit(record)   ? withFirstTexel(record, first_texels_[i])
                             : record.isPair() ? copyPair(record, first_texels_[i])
                                               : copyPatch(record, first_texels_[i]);
        }
        return std::move(texels_);
    }

  private:
    static bool isSplit(const PatchRecord& record) { return record.kind() == PatchRecord::Kind::kSplit; }

    /// Collects the records level by level.
    void gather(const glm::uvec3& first, const glm::uvec3& count) {
        const glm::uvec3 roots = patchTreeSize(from_).roots;
        forEachPoint(first, first + count, [&](const glm::uvec3& at) {
            records_.push_back(patchTexel(from_, 1 + (at.z * roots.y + at.y) * roots.x + at.x));
        });
        for (std::size_t at = 0, end = records_.size(); at < records_.size(); end = records_.size()) {
            bool any = false;
            for (; at < end; ++at) {
                first_texels_.push_back(1 + static_cast<std::uint32_t>(records_.size()));
                const PatchRecord record = records_[at];
                for (std::uint32_t k = 0; isSplit(record) && k < childCount(record); ++k) {
                    records_.push_back(patchTexel(from_, record.first() + k));
                }
                any = any || isSplit(record);
            }
            levels_ += any ? 1 : 0;
        }
    }

    PatchRecord copyPatch(const PatchRecord& record, std::uint32_t to) {
        // A record of 2² heights, or of a cell without a surface, needs no other texels.
        const std::uint32_t heights = leafTexels(from_, record);
        for (std::uint32_t k = 0; k < heights; ++k) {
            texels_[to + k] = patchTexel(from_, record.first() + k);
        }
        return heights > 0 ? withFirstTexel(record, to) : record;
    }

    PatchRecord copyPair(const PatchRecord& record, std::uint32_t to) {
        std::uint32_t heights = to + 2;
        for (std::uint32_t k = 0; k < 2; ++k) {
            const PatchRecord patch = patchTexel(from_, record.first() + k);
            texels_[to + k] = copyPatch(patch, heights);
            heights += heightTexels(patch.side());
        }
        return withFirstTexel(record, to);
    }

    PatchTexels from_;
    std::vector<PatchRecord> records_;         // copied from the whole tree
    std::vector<std::uint32_t> first_texels_;  // by record: index of its first texel, in the copy
    std::uint32_t levels_ = 0;
    std::vector<PatchRecord> texels_;
};

class Cutter {
  public:
    Cutter(const DepthMap& whole, const PatchTileOptions& options)
        : whole_(whole), options_(options), roots_(patchTreeSize(whole.texels).roots) {
        const std::size_t count = std::size_t{roots_.x} * roots_.y * roots_.z;
        for (std::uint32_t i = 0; i < count; ++i) {
            const PatchRecord root = patchTexel(whole.texels, 1 + i);
            below_.push_back(texelsBelow(root));
            outside_.push_back(root.kind() == PatchRecord::Kind::kOutside ? 1 : 0);
        }
    }

    [[nodiscard]] std::vector<PatchTile> run() {
        std::vector<PatchTile> best = {PatchTile{.own = roots_}};
        glm::uvec3 grid(1);
        for (std::uint64_t largest = sizeOf(best).largest; largest > options_.bytes;) {
            int axis = 0;
            for (int i = 1; i < 3; ++i) {
                axis = roots_[i] * grid[axis] > roots_[axis] * grid[i] ? i : axis;
            }
            ++grid[axis];
            std::vector<PatchTile> tiles = tilesOf(grid);
            const Sizes sizes = sizeOf(tiles);
            if (roots_[axis] / grid[axis] < kRootsMin || grid.x * grid.y * grid.z > options_.most ||
                sizes.total > options_.total) {
                break;
            }
            best = std::move(tiles);
            largest = sizes.largest;
        }
        for (PatchTile& tile : best) {
            if (tile.own != roots_) {
                tile.map = cutPatches(whole_, tile.first, withRim(tile));
            }
        }
        return best;
    }

  private:
    /// All texels that a record refers to, recursively.
    [[nodiscard]] std::uint32_t texelsBelow(const PatchRecord& record) const {
        if (record.kind() != PatchRecord::Kind::kSplit) {
            return leafTexels(whole_.texels, record);
        }
        std::uint32_t texels = 0;
        for (std::uint32_t k = 0; k < childCount(record); ++k) {
            texels += 1 + texelsBelow(patchTexel(whole_.texels, record.first() + k));
        }
        return texels;
    }

    [[nodiscard]] glm::uvec3 withRim(const PatchTile& tile) const {
        return glm::min(tile.own + 1U, roots_ - tile.first);
    }

    [[nodiscard]] std::size_t indexOf(const glm::uvec3& root) const {
        return (std::size_t{root.z} * roots_.y + root.y) * roots_.x + root.x;
    }

    [[nodiscard]] std::vector<PatchTile> tilesOf(const glm::uvec3& grid) const {
        std::vector<PatchTile> tiles;
        for (std::uint32_t i = 0; i < grid.x * grid.y * grid.z; ++i) {
            PatchTile tile;
            tile.place = {i % grid.x, i / grid.x % grid.y, i / grid.x / grid.y};
            tile.first = tile.place * roots_ / grid;
            tile.own = (tile.place + 1U) * roots_ / grid - tile.first;
            bool outside = true;
            forEachPoint(tile.first, tile.first + tile.own,
                         [&](const glm::uvec3& root) { outside = outside && outside_[indexOf(root)] != 0; });
            if (!outside) {
                tiles.push_back(std::move(tile));
            }
        }
        return tiles;
    }

    struct Sizes {
        std::uint64_t largest = 0;
        std::uint64_t total = 0;
    };
    [[nodiscard]] Sizes sizeOf(const std::vector<PatchTile>& tiles) const {
        Sizes sizes;
        for (const PatchTile& tile : tiles) {
            std::size_t texels = 1;
            forEachPoint(tile.first, tile.first + withRim(tile),
                         [&](const glm::uvec3& root) { texels += 1 + below_[indexOf(root)]; });
            const PatchMapSize size = patchMapSize(texels);
            const std::uint64_t bytes = std::uint64_t{size.width} * size.height * texelSize(whole_.format);
            sizes.largest = std::max(sizes.largest, bytes);
            sizes.total += bytes;
        }
        return sizes;
    }

    const DepthMap& whole_;
    const PatchTileOptions& options_;
    glm::uvec3 roots_;
    std::vector<std::uint32_t> below_;  // texels below each root
    std::vector<char> outside_;         // 1: the root is entirely outside
};

}  // namespace

std::vector<PatchTile> cutIntoTiles(const DepthMap& whole, const PatchTileOptions& options) {
    return Cutter(whole, options).run();
}

DepthMap cutPatches(const DepthMap& whole, const glm::uvec3& first, const glm::uvec3& count) {
    DepthMap map;
    map.format = whole.format;
    map.compare = whole.compare;
    map.decode = whole.decode;
    map.object_to_map = whole.object_to_map;
    for (int axis = 0; axis < 3; ++axis) {
        float& from = map.object_to_map.row[axis].w;
        from = static_cast<float>(double{from} - static_cast<double>(first[axis]));
    }
    map.object_per_map = whole.object_per_map;
    map.encloses = whole.encloses;
    map.empty_is_outside = whole.empty_is_outside;
    map.setPatches(Copier(whole.texels).copy(first, count));
    return map;
}

}  // namespace relief
