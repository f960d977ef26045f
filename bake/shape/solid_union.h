// SPDX-License-Identifier: Apache-2.0
// Collects the closed surfaces that replace a mesh.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <utility>
#include <vector>

#include "bake/mesh/prepared_mesh.h"
#include "formats/base/result.h"

namespace relief {

class SolidUnion {
  public:
    /// Borrows the source.
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
