// SPDX-License-Identifier: Apache-2.0
// Triangles as a picture needs them. The runtime takes them raw; relief-sim reads them from files
// (mesh_file.h).
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
    std::vector<glm::vec3> normals;        ///< of the vertices, unit or zero, as many as positions; or empty
    std::vector<std::uint32_t> triangles;  ///< three indices each, anticlockwise seen from outside
    std::vector<std::array<std::uint8_t, 4>>
        colors{};  ///< of the vertices, as many as positions, or empty: sRGB, and how much snow stays there, 0…255
};

/// Its triangles, one by one.
[[nodiscard]] std::vector<glm::uvec3> trianglesOf(const PictureMesh& mesh);

/// Errors: kInvalidInput (no triangle, an index beyond the vertices, numbers of things that do not match, a
/// position that is not finite).
[[nodiscard]] Result<void> checkMesh(const PictureMesh& mesh);

inline constexpr float kCrease = 1.0F;  ///< radians

/// The same triangles with normals: each corner has the mean of the triangles round its vertex, weighted by
/// their angles there, but of those alone that lie within `crease` of its own triangle. Vertices on a crease
/// are doubled.
/// \param mesh    as checkMesh wants it; its normals are replaced.
/// \param crease  radians.
[[nodiscard]] PictureMesh withNormals(const PictureMesh& mesh, float crease = kCrease);

/// A mesh whose vertices move. Its creases are those of the pose it begins in, so that no pose costs a search for them: each
/// vertex has the mean, weighted by area, of the triangles that it had there.
class MovingMesh {
  public:
    /// \param mesh  as checkMesh wants it.
    explicit MovingMesh(const PictureMesh& mesh);

    /// \param positions  of the vertices of that mesh, as many; object units, finite.
    void setPositions(std::span<const glm::vec3> positions);

    /// With normals, and vertices on creases doubled; of as many vertices in every pose.
    [[nodiscard]] const PictureMesh& mesh() const { return mesh_; }

  private:
    PictureMesh mesh_;
    std::vector<std::uint32_t> triangles_;  // of the mesh before
    std::vector<std::uint32_t> sources_;    // of each vertex that of the mesh before
    // Of vertex i the corners whose triangles its normal is the mean of: corners_[begin_[i]] … corners_[begin_[i + 1] - 1].
    std::vector<std::uint32_t> begin_;
    std::vector<std::uint32_t> corners_;
};

}  // namespace relief
