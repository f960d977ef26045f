// The closed surfaces that take a mesh's place.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "bake/mesh/prepared_mesh.h"
#include "bake/shape/sheet.h"
#include "formats/base/result.h"

namespace relief {

class SolidUnion {
  public:
    /// \param source  borrowed.
    explicit SolidUnion(const TriangleMesh& source);

    /// Triangles of the source, as they are. \param body  as PreparedMesh::unionOf has it.
    void addSource(const std::vector<std::uint32_t>& triangles, std::uint32_t body);
    /// \param surface  how many of the triangles, the first, are no caps.
    void add(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles, std::size_t surface,
             std::uint32_t body);
    void add(const SolidPart& part) { add(part.positions, part.triangles, part.surface_triangles, 0); }
    void countHoles(std::uint64_t holes) { holes_ += holes; }

    /// Named and described as the source is. \param shell_thickness  as TriangleMesh has it.
    /// Errors: those of finishMesh; kFailure (triangles without area).
    [[nodiscard]] Result<PreparedMesh> finish(double shell_thickness);

  private:
    struct Half {
        std::vector<glm::uvec3> triangles;
        std::vector<std::uint32_t> bodies;
    };

    const TriangleMesh& source_;
    std::vector<glm::vec3> positions_;  // first those of the source
    Half surface_;
    Half caps_;
    std::uint64_t holes_ = 0;
};

}  // namespace relief
