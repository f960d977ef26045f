// SPDX-License-Identifier: Apache-2.0
// A solid that represents a sheet, and the class that collects it.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <utility>
#include <vector>

#include "bake/mesh/triangle_plane.h"

namespace relief {

/// Closed, consistently wound surfaces that face outwards.
struct SolidPart {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    std::vector<std::uint32_t> sources;  ///< per triangle, the sheet's triangle that it represents or closes
    std::size_t surface_triangles = 0;   ///< the first ones, which represent the sheet; the others close it
};

/// Collects a solid part; drops triangles without area.
class PartBuilder {
  public:
    std::uint32_t addPosition(const glm::dvec3& p) {
        part_.positions.emplace_back(p);
        return static_cast<std::uint32_t>(part_.positions.size() - 1);
    }
    void move(std::uint32_t vertex, const glm::dvec3& to) { part_.positions[vertex] = to; }
    /// \param source  the sheet's triangle.
    void addTriangle(std::uint32_t source, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const glm::uvec3 t(a, b, c);
        if (hasArea(planeOf(part_.positions, t))) {
            part_.triangles.push_back(t);
            part_.sources.push_back(source);
        }
    }
    /// Adds a wall below the side from a to b of a triangle seen from above.
    void addWall(std::uint32_t source, const std::array<std::uint32_t, 2>& a,
                 const std::array<std::uint32_t, 2>& b) {
        addTriangle(source, b[0], a[0], a[1]);
        addTriangle(source, b[0], a[1], b[1]);
    }
    [[nodiscard]] glm::dvec3 at(std::uint32_t vertex) const { return part_.positions[vertex]; }
    void endSurface() { part_.surface_triangles = part_.triangles.size(); }
    SolidPart take() { return std::move(part_); }

  private:
    SolidPart part_;
};

}  // namespace relief
