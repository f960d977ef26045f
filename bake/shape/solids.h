// SPDX-License-Identifier: Apache-2.0
// Builds the solids that represent sheets (shells, and the ground below terrains), and the union of all closed
// surfaces.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <utility>
#include <vector>

#include "bake/mesh/mesh_query.h"
#include "bake/mesh/prepared_mesh.h"
#include "bake/mesh/triangle_plane.h"
#include "bake/shape/sheet.h"
#include "formats/base/result.h"

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
    /// Adds a wall below the side from a to b of a triangle seen from above; each is {top, bottom}.
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

/// Builds the shell. Its two sides are half the thickness from the sheet, along the sheet's normals. Edges have mitres,
/// the border has flat ends, and corners have bevels if a common mitre would leave a side thin. Each set of joined
/// triangles becomes one closed surface. A region that is thinner than the shell, such as a rod, is filled; its offset
/// surface would turn inside out and is omitted.
///
///            top: + thickness/2
///      ┌──────────────────────────┐
///      │· · · · · sheet · · · · · │
///      └──────────────────────────┘
///            bottom: − thickness/2
///
/// \param query      for the sheet's triangles.
/// \param thickness  object units, above 0.
[[nodiscard]] SolidPart thickened(Sheet sheet, const MeshQuery& query, double thickness);

/// Builds the ground below a height field: walls below its border, and a flat bottom.
///
///           surface
///       __/\_____/\___
///      │              │ walls
///      └──────────────┘ bottom
///
/// \param axis    0, 1 or 2: the up axis.
/// \param bottom  coordinate of the bottom along the axis, object units.
[[nodiscard]] SolidPart extruded(const Sheet& sheet, int axis, float bottom);

/// Collects the closed surfaces that replace a mesh.
class SolidUnion {
  public:
    explicit SolidUnion(const TriangleMesh& source);

    /// Adds triangles of the source.
    /// \param part_of  per triangle of the source (SurfaceParts).
    /// \param body     as in PreparedMesh::unionOf.
    void addSource(const std::vector<std::uint32_t>& triangles, std::span<const std::uint32_t> part_of,
                   std::uint32_t body);
    /// Adds other triangles.
    /// \param parts    per triangle.
    /// \param surface  number of triangles before the caps.
    void add(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
             std::span<const std::uint32_t> parts, std::size_t surface, std::uint32_t body);
    void countHoles(std::uint64_t holes) { holes_ += holes; }

    /// Builds the mesh, with the source's name and metadata. \param shell_thickness  as in TriangleMesh.
    /// Errors: those of finishMesh; kFailure (triangles without area).
    [[nodiscard]] Result<PreparedMesh> finish(double shell_thickness);
    /// Returns SurfaceParts::part_of of the mesh; call it after finish().
    [[nodiscard]] std::vector<std::uint32_t> takePartOf() { return std::move(surface_.parts); }

  private:
    struct Half {
        std::vector<glm::uvec3> triangles;
        std::vector<std::uint32_t> bodies;
        std::vector<std::uint32_t> parts;
    };

    const TriangleMesh& source_;
    std::vector<glm::vec3> positions_;  // starts with those of the source
    Half surface_;
    Half caps_;
    std::uint64_t holes_ = 0;
};

}  // namespace relief
