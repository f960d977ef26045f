// SPDX-License-Identifier: Apache-2.0
// Stores free space within a mesh that cannot be reached from outside.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace relief {

/// A grid of nodes, each classified.
struct Voids {
    enum class Place : std::uint8_t { kSolid, kOutside, kVoid };

    glm::dvec3 origin{0.0};  ///< position of node (0, 0, 0), object space
    double step = 0.0;       ///< node spacing, object units
    glm::ivec3 nodes{0};
    std::vector<Place> places;  ///< x fastest; empty: no void. There is no void outside the grid
    std::uint32_t count = 0;    ///< number of voids

    [[nodiscard]] std::size_t at(const glm::ivec3& node) const {
        return (static_cast<std::size_t>(node.z) * static_cast<std::size_t>(nodes.y) +
                static_cast<std::size_t>(node.y)) *
                   static_cast<std::size_t>(nodes.x) +
               static_cast<std::size_t>(node.x);
    }
    [[nodiscard]] glm::dvec3 position(const glm::ivec3& node) const {
        return origin + step * glm::dvec3(node);
    }
    /// Calls visit(node, place) for the nodes in [first, last], clipped to the grid.
    template <class Visit>
    void eachNode(const glm::ivec3& first, const glm::ivec3& last, const Visit& visit) const {
        const glm::ivec3 low = glm::max(first, glm::ivec3(0));
        const glm::ivec3 high = glm::min(last, nodes - 1);
        for (int z = low.z; z <= high.z; ++z) {
            for (int y = low.y; y <= high.y; ++y) {
                for (int x = low.x; x <= high.x; ++x) {
                    visit(glm::ivec3(x, y, z), places[at({x, y, z})]);
                }
            }
        }
    }
    /// Whether a node in [first, last] is in a void.
    [[nodiscard]] bool meet(const glm::ivec3& first, const glm::ivec3& last) const {
        bool found = false;
        eachNode(first, last,
                 [&](const glm::ivec3&, Place place) { found = found || place == Place::kVoid; });
        return found;
    }
};

}  // namespace relief
