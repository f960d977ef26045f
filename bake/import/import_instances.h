// Meshes as their nodes place them, as one TriangleMesh.
#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <span>
#include <string>

#include "bake/import/import_names.h"
#include "bake/mesh/mesh.h"
#include "formats/base/result.h"

namespace relief {

/// p -> linear · p + offset
struct Transform {
    glm::dmat3 linear{1.0};
    glm::dvec3 offset{0.0};

    [[nodiscard]] glm::dvec3 apply(const glm::dvec3& p) const { return linear * p + offset; }
    [[nodiscard]] bool mirrors() const;
    /// A scale of 0 along some direction.
    [[nodiscard]] bool flattens() const;
};
/// First `inner`, then `outer`.
[[nodiscard]] Transform operator*(const Transform& outer, const Transform& inner);

/// "SHOWN: more than N triangles…", kLimit.
[[nodiscard]] tl::unexpected<Error> tooManyTriangles(const std::string& shown, std::uint64_t triangle_max);

/// Count every use of every mesh, then begin, then add them all: a small file can place one mesh very often, and nothing is
/// allocated before the sum is known.
class MeshInstances {
  public:
    /// \param mesh  what is known of it otherwise; no positions yet. \param triangle_max  at most kTriangleMax.
    MeshInstances(std::string shown, std::uint64_t triangle_max, TriangleMesh mesh)
        : shown_(std::move(shown)), triangle_max_(triangle_max), mesh_(std::move(mesh)) {}

    /// \return false if these are too many: more than triangle_max, or more than thrice as many vertices.
    [[nodiscard]] bool count(std::uint64_t vertices, std::uint64_t triangles, const Transform& transform);
    /// The error of a count that is false.
    [[nodiscard]] tl::unexpected<Error> tooMany() const { return tooManyTriangles(shown_, triangle_max_); }
    /// \param marked  whether every mesh comes with a mark.
    void begin(bool marked);
    /// Names the surface of all that is added until the next call. \param name  its strings as the file has them.
    void surface(SurfaceName name);
    /// \param triangles  of positions that exist. Where the transform mirrors, they are turned over.
    void add(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
             const Transform& transform, std::uint8_t mark = 0);
    /// Errors: kInvalidInput (no triangles), kUsage (NameMarks::allMet).
    [[nodiscard]] Result<TriangleMesh> finish(const NameMarks& names);

  private:
    std::uint32_t labelOfSurface();

    std::string shown_;
    std::uint64_t triangle_max_;
    TriangleMesh mesh_;
    std::uint64_t vertices_ = 0;
    std::uint64_t triangles_ = 0;
    std::uint64_t flat_ = 0;
    bool marked_ = false;
    SurfaceName surface_;
    std::uint32_t label_ = 0;                      // of the triangles that were added last
    std::map<SurfaceName, std::uint32_t> labels_;  // of TriangleMesh::surface_names
};

}  // namespace relief
