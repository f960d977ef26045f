// SPDX-License-Identifier: Apache-2.0
// The closed surfaces that replace a mesh.
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
    /// \param source  borrowed.
    explicit SolidUnion(const TriangleMesh& source);

    /// Triangles of the source. \param body  as in PreparedMesh::unionOf.
    /// \param part_of  per triangle of the source (SurfaceParts).
    void addSource(const std::vector<std::uint32_t>& triangles, std::span<const std::uint32_t> part_of,
                   std::uint32_t body);
    /// \param parts    per triangle.
    /// \param surface  number of triangles before the caps.
    void add(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
             std::span<const std::uint32_t> parts, std::size_t surface, std::uint32_t body);
    void countHoles(std::uint64_t holes) { holes_ += holes; }

    /// With the source's name and metadata. \param shell_thickness  as in TriangleMesh.
    /// Errors: those of finishMesh; kFailure (triangles without area).
    [[nodiscard]] Result<PreparedMesh> finish(double shell_thickness);
    /// After finish(): SurfaceParts::part_of of that mesh.
    [[nodiscard]] std::vector<std::uint32_t> takePartOf() { return std::move(surface_.parts); }

  private:
    struct Half {
        std::vector<glm::uvec3> triangles;
        std::vector<std::uint32_t> bodies;
        std::vector<std::uint32_t> parts;
    };

    const TriangleMesh& source_;
    std::vector<glm::vec3> positions_;  // first those of the source
    Half surface_;
    Half caps_;
    std::uint64_t holes_ = 0;
};

}  // namespace relief
