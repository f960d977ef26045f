// SPDX-License-Identifier: Apache-2.0
#include "bake/patches/patch_encoder.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <vector>

#include "bake/mesh/loops.h"
#include "bake/patches/depth_planes.h"

namespace relief {
namespace {

class Encoder {
  public:
    Encoder(const MeshQuery& query, const LeafFitter& fitter, const PatchRoots& roots)
        : query_(query), fitter_(fitter), roots_(roots) {}

    [[nodiscard]] DepthMap encode(std::span<const PatchNode* const> nodes,
                                  const std::function<void(double)>& progress) const {
        // Records level by level, and the index of the first child of each.
        std::vector<const PatchNode*> records(nodes.begin(), nodes.end());
        std::vector<std::uint32_t> first(records.size(), 0);
        std::uint32_t levels = 0;
        for (std::size_t at = 0, end = records.size(); at < records.size(); end = records.size()) {
            bool any = false;
            for (; at < end; ++at) {
                first[at] = 1 + static_cast<std::uint32_t>(records.size());
                if (records[at]->split) {
                    any = true;
                    for (const PatchNode& child : *records[at]->children) {
                        if (child.hasRecord()) {
                            records.push_back(&child);
                        }
                    }
                    first.resize(records.size(), 0);
                }
            }
            levels += any ? 1 : 0;
        }
        std::uint32_t next = 1 + static_cast<std::uint32_t>(records.size());
        for (std::size_t i = 0; i < records.size(); ++i) {
            const PatchNode& node = *records[i];
            if (!node.split && node.hasRecord()) {
                first[i] = next;
                next += node.texels();
            }
        }
        std::vector<PatchRecord> texels(next);
        texels[0] = {roots_.count.x | roots_.count.y << 16U, roots_.count.z | levels << 16U};
        std::atomic<std::size_t> done = 0;
        forEachIndex(0, records.size(), 16, [&](std::size_t i) {
            const PatchNode& node = *records[i];
            progress(static_cast<double>(++done) / static_cast<double>(records.size()));
            if (node.split) {
                texels[1 + i] = splitOf(node, first[i]);
            } else if (!node.surface() && node.planes != DepthPlanes::kTwo) {
                texels[1 + i] = node.planes == DepthPlanes::kOne ? node.depth[0] : flat(node);
            } else {
                writeLeaf(node, first[i], texels[1 + i], texels);
            }
        });
        DepthMap map;
        map.format = MapFormat::kPatches;
        map.decode = Decode::kPlane;
        map.object_per_map = glm::vec3(static_cast<float>(roots_.size));
        for (int axis = 0; axis < 3; ++axis) {
            map.object_to_map.row[axis] = glm::vec4(0.0F);
            map.object_to_map.row[axis][axis] = static_cast<float>(1.0 / roots_.size);
            map.object_to_map.row[axis].w = static_cast<float>(-roots_.origin[axis] / roots_.size);
        }
        map.setPatches(texels);
        return map;
    }

  private:
    /// Returns the record of a cell without a patch: the plane of the nearest surface.
    [[nodiscard]] PatchRecord flat(const PatchNode& node) const {
        const glm::dvec3 middle = node.cell.middle();
        const ClosestPoint closest = query_.closest(glm::vec3(middle));
        const bool inside = node.inside();
        glm::dvec3 away = middle - closest.point;
        away = length(away) > 0.0 ? (inside ? -away : away) : unitNormal(query_.mesh(), closest.triangle);
        const double distance = closest.distance / roots_.size;
        return PatchRecord::flat(inside, glm::vec3(unit(away)),
                                 static_cast<float>(inside ? -distance : distance));
    }

    [[nodiscard]] PatchRecord splitOf(const PatchNode& node, std::uint32_t first) const {
        std::uint32_t children = 0;
        std::uint32_t inside = 0;
        for (unsigned i = 0; i < 8; ++i) {
            const PatchNode& child = (*node.children)[i];
            children |= child.hasRecord() ? 1U << i : 0U;
            inside |= !child.hasRecord() && child.inside() ? 1U << i : 0U;
        }
        const CellPlane plane = planeOfSplit(query_, node);
        return PatchRecord::split(children, inside, first, glm::vec3(plane.normal),
                                  static_cast<float>(plane.offset));
    }

    /// Writes a leaf with patches.
    /// \param first  index of the leaf's texels other than its record.
    void writeLeaf(const PatchNode& node, std::uint32_t first, PatchRecord& record,
                   std::vector<PatchRecord>& texels) const {
        const auto write = [&](const PatchHeights& heights, std::uint32_t at) {
            for (std::uint32_t k = 0; k < heightTexels(heights.side); ++k) {
                texels[at + k] = heights.texel(k);
            }
        };
        if (!node.surface()) {
            record = PatchRecord::pair(true, first);
            std::ranges::copy(node.depth, &texels[first]);
            return;
        }
        if (!node.shape().pair) {
            PatchRecord* surface = &record;
            if (node.planes == DepthPlanes::kTwo) {
                record = PatchRecord::pair(true, first);
                surface = &texels[first];
                texels[first + 1] = node.depth[0];
                first += 2;
            }
            const PatchHeights heights = fitter_.heights(node);
            *surface = PatchRecord::patch(patchFrames()[node.frame.index], node.turned, heights, first);
            write(heights, first);
            return;
        }
        const std::array<PatchHeights, 2> pair = fitter_.pair(node);
        record = PatchRecord::pair(node.walls, first);
        for (std::uint32_t k = 0; k < 2; ++k) {
            // Outside is below the lower surface of a wall, and above the lower surface of a gap.
            const std::uint32_t at = first + 2 + k * heightTexels(pair[k].side);
            texels[first + k] =
                PatchRecord::patch(patchFrames()[node.frame.index], (k == 0) == node.walls, pair[k], at);
            write(pair[k], at);
        }
    }

    const MeshQuery& query_;
    const LeafFitter& fitter_;
    const PatchRoots& roots_;
};

}  // namespace

DepthMap encodePatches(const MeshQuery& query, const LeafFitter& fitter, const PatchRoots& roots,
                       std::span<const PatchNode* const> nodes, const std::function<void(double)>& progress) {
    return Encoder(query, fitter, roots).encode(nodes, progress);
}

}  // namespace relief
