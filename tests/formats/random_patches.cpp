// SPDX-License-Identifier: Apache-2.0
#include "tests/formats/random_patches.h"

#include <bit>
#include <glm/geometric.hpp>

namespace relief::test {

DepthMap patchesOf(const PatchTreeSize& size, const std::vector<PatchRecord>& records) {
    std::vector<PatchRecord> texels{{size.roots.x | size.roots.y << 16U, size.roots.z | size.levels << 16U}};
    texels.insert(texels.end(), records.begin(), records.end());
    DepthMap map;
    map.format = MapFormat::kPatches;
    map.decode = Decode::kPlane;
    map.setPatches(texels);
    return map;
}

DepthMap randomPatches(std::mt19937& random) {
    constexpr std::uint32_t kLevels = 3;
    const PatchTreeSize size{{3, 2, 4}, kLevels};
    std::uniform_real_distribution<float> unit(0.0F, 1.0F);
    const auto normal = [&] {
        std::normal_distribution<float> gauss;
        return glm::normalize(glm::vec3(gauss(random), gauss(random), gauss(random)));
    };
    const auto below = [&](std::uint32_t end) { return static_cast<std::uint32_t>(random() % end); };

    // Splits and leaves of every level, before children and heights are placed.
    struct Node {
        int kind;  // 0 flat, 1 split, 2 patch
        std::uint32_t children;
        std::uint32_t side;
    };
    std::vector<Node> nodes;
    const auto add = [&](bool may_split) {
        const int kind =
            static_cast<int>(below(may_split ? 3 : 2)) + (may_split ? 0 : static_cast<int>(below(2)));
        nodes.push_back({may_split   ? kind
                         : kind == 1 ? 2
                                     : kind,
                         below(256), std::array{2U, 3U, 5U}[below(3)]});
    };
    std::vector<std::uint32_t> first;
    for (std::uint32_t i = 0; i < size.roots.x * size.roots.y * size.roots.z; ++i) {
        add(true);
    }
    std::size_t at = 0;
    for (std::uint32_t level = 0; level <= kLevels; ++level) {
        for (const std::size_t end = nodes.size(); at < end; ++at) {
            first.push_back(1 + static_cast<std::uint32_t>(nodes.size()));
            if (nodes[at].kind == 1) {
                for (int i = 0; i < std::popcount(nodes[at].children); ++i) {
                    add(level + 1 < kLevels);
                }
            }
        }
    }
    std::vector<PatchRecord> records;
    std::vector<PatchRecord> heights;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Node& node = nodes[i];
        if (node.kind == 1) {
            records.push_back(PatchRecord::split(node.children, below(256), first[i], normal(),
                                                 1.8F * (unit(random) - 0.5F)));
        } else if (node.kind == 0) {
            const bool inside = below(2) == 0;
            records.push_back(PatchRecord::flat(inside, normal(), (inside ? -2.0F : 2.0F) * unit(random)));
        } else {
            const auto place = [&] { return static_cast<std::uint32_t>(1 + nodes.size() + heights.size()); };
            const auto patch = [&](std::uint32_t side) {
                std::array<double, 25> values{};
                for (double& value : values) {
                    value = 1.5 * double{unit(random)};
                }
                const PatchHeights codes = PatchHeights::of(std::span(values).first(side * side), side);
                const PatchRecord record =
                    PatchRecord::patch(patchFrames()[below(13)], below(2) == 0, codes, place());
                for (std::uint32_t k = 0; k < heightTexels(side); ++k) {
                    heights.push_back(codes.texel(k));
                }
                return record;
            };
            if (below(3) > 0) {
                records.push_back(patch(node.side));
                continue;
            }
            const std::array<PatchRecord, 2> both = {patch(node.side),
                                                     patch(std::array{2U, 3U, 5U}[below(3)])};
            records.push_back(PatchRecord::pair(below(2) == 0, place()));
            heights.insert(heights.end(), both.begin(), both.end());
        }
    }
    records.insert(records.end(), heights.begin(), heights.end());
    return patchesOf(size, records);
}

}  // namespace relief::test
