// SPDX-License-Identifier: Apache-2.0
// Triangle meshes for pictures. relief-sim reads them from files (mesh_file.h).
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "formats/base/result.h"

namespace relief {

struct PictureMesh {
    std::vector<glm::vec3> positions;      ///< object units, finite
    std::vector<glm::vec3> normals;        ///< per vertex, unit length or zero; or empty
    std::vector<std::uint32_t> triangles;  ///< three indices each, counter-clockwise from outside
    /// Per vertex, or empty: sRGB, and the amount of snow that stays, 0…255.
    std::vector<std::array<std::uint8_t, 4>> colors{};
};

/// Returns the triangles as index triples.
[[nodiscard]] std::vector<glm::uvec3> trianglesOf(const PictureMesh& mesh);

/// Validates a mesh. Errors: kInvalidInput (no triangles; an index beyond the vertices; arrays of different lengths; a
/// position that is not finite).
[[nodiscard]] Result<void> checkMesh(const PictureMesh& mesh);

inline constexpr float kCrease = 1.0F;  ///< radians

/// Returns the mesh with normals. The normal of a corner is the mean of the normals of the triangles around its vertex,
/// weighted by angle. Triangles at an angle of more than `crease` to the corner's own triangle are excluded. Vertices
/// on creases are duplicated.
/// \param mesh    validated by checkMesh(); its normals are replaced.
/// \param crease  radians.
[[nodiscard]] PictureMesh withNormals(const PictureMesh& mesh, float crease = kCrease);

/// A mesh with moving vertices. Creases are found once, in the initial pose. The normal of a vertex is the mean normal
/// of the same triangles in every pose, weighted by area.
class MovingMesh {
  public:
    /// \param mesh  validated by checkMesh().
    explicit MovingMesh(const PictureMesh& mesh);

    /// \param positions  of all vertices of the mesh passed to the constructor; object units, finite.
    void setPositions(std::span<const glm::vec3> positions);

    /// Returns the mesh with normals and duplicated crease vertices. The number of vertices is constant.
    [[nodiscard]] const PictureMesh& mesh() const { return mesh_; }

  private:
    PictureMesh mesh_;
    std::vector<std::uint32_t> triangles_;  // of the original mesh
    std::vector<std::uint32_t> sources_;    // original vertex of each vertex
    // Corners whose triangles contribute to the normal of vertex i: corners_[begin_[i]] … corners_[begin_[i + 1] - 1].
    std::vector<std::uint32_t> begin_;
    std::vector<std::uint32_t> corners_;
};

}  // namespace relief
