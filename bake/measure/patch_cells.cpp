#include "bake/measure/patch_cells.h"

#include <bit>
#include <cmath>
#include <glm/common.hpp>

#include "formats/patch_tree.h"

namespace relief {
namespace {

using Kind = PatchRecord::Kind;

/// Gaps between the heights along a side of a patch.
double gapsOf(const PatchRecord& record) {
    return static_cast<double>(1U << (record.low >> 2U & 3U));  // of 2, 3 or 5 heights
}

}  // namespace

std::uint32_t patchCount(const DepthMap& map) {
    const auto [roots, levels] = patchTreeSize(map.texels);
    std::uint32_t patches = 0;
    std::uint32_t end = 1 + roots.x * roots.y * roots.z;
    for (std::uint32_t i = 1; i < end; ++i) {
        const PatchRecord record = patchTexel(map.texels, i);
        patches += record.kind() == Kind::kPatch ? 1 : 0;
        // Records are in the order of the levels, so that each split cell makes room for its children at the end.
        end +=
            record.kind() == Kind::kSplit ? static_cast<std::uint32_t>(std::popcount(record.children())) : 0;
    }
    return patches;
}

double patchSpacingAt(const DepthMap& map, const glm::vec3& p) {
    const auto [roots, levels] = patchTreeSize(map.texels);
    const glm::dvec3 last = glm::dvec3(roots) - 1.0;
    const glm::dvec3 in_roots = map.object_to_map.apply(p);
    const glm::dvec3 root = glm::clamp(glm::floor(in_roots), glm::dvec3(0.0), last);
    glm::dvec3 in_cell = glm::clamp(in_roots - root, glm::dvec3(0.0), glm::dvec3(1.0));
    const glm::uvec3 at(root);
    PatchRecord record = patchTexel(map.texels, 1 + (at.z * roots.y + at.y) * roots.x + at.x);
    double cell = double{map.object_per_map.x};
    while (record.kind() == Kind::kSplit) {
        const glm::dvec3 child = glm::min(glm::floor(2.0 * in_cell), glm::dvec3(1.0));
        const unsigned octant = static_cast<unsigned>(child.x) + 2 * static_cast<unsigned>(child.y) +
                                4 * static_cast<unsigned>(child.z);
        cell *= 0.5;
        if ((record.children() >> octant & 1U) == 0) {
            return cell;
        }
        in_cell = 2.0 * in_cell - child;
        const auto before =
            static_cast<std::uint32_t>(std::popcount(record.children() & ((1U << octant) - 1U)));
        record = patchTexel(map.texels, record.first() + before);
    }
    record = record.isPair() ? patchTexel(map.texels, record.first()) : record;
    return record.kind() == Kind::kPatch ? cell / gapsOf(record) : cell;
}

}  // namespace relief
