// Questions to a mesh that need no map: is a point inside, how far is the surface, what does a ray meet. This
// is the truth that colliders are measured against. By Embree.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "bake/mesh/prepared_mesh.h"
#include "formats/base/result.h"

namespace relief {

/// The surface point next to another point.
struct ClosestPoint {
    double distance = 0.0;  ///< object units, not negative
    std::uint32_t triangle = 0;
    glm::dvec3 point{0.0};  ///< object space, on the triangle
};

/// What a ray meets first.
struct FirstHit {
    double along = 0.0;  ///< in units of the ray's direction
    std::uint32_t triangle = 0;
};

/// A stretch of a line that is outside, between two surfaces.
struct LineGap {
    double begin = 0.0;  ///< in units of the line's direction
    double end = 0.0;
    std::uint32_t first = 0;  ///< the triangle at its begin
    std::uint32_t last = 0;   ///< and at its end

    [[nodiscard]] double length() const { return end - begin; }
    [[nodiscard]] double middle() const { return 0.5 * (begin + end); }
};

/// A part of a line, in units of its direction.
struct LineSpan {
    double begin = 0.0;
    double end = 0.0;
};

/// Where a line meets a triangle: along it, in units of its direction, in double precision.
struct LineHit {
    double at = 0.0;
    std::uint32_t triangle = 0;
};

/// All questions may be asked from any thread, and their answers depend neither on the number of threads nor
/// on the order of the questions.
class MeshQuery {
  public:
    /// Shares the mesh's tree. Errors: those of EmbreeMesh::build.
    [[nodiscard]] static Result<MeshQuery> build(PreparedMesh mesh);

    [[nodiscard]] const PreparedMesh& prepared() const { return mesh_; }
    [[nodiscard]] const TriangleMesh& mesh() const { return *mesh_; }

    /// Seven rays from `p` vote, as insideByParity (inside.h) has it; one traversal a ray counts all crossings.
    /// The winding of the triangles does not matter. Where the mesh is open, most rays still miss its holes.
    /// If PreparedMesh::woundShells, the winding number decides instead, so that the overlap of two solids is
    /// inside. Of a union (PreparedMesh::unionOf) each body decides for itself, and of three rays two.
    [[nodiscard]] bool inside(const glm::vec3& p) const;

    /// How many triangles a ray from `p` meets.
    /// \param direction  of any length but 0.
    [[nodiscard]] unsigned crossings(const glm::vec3& p, const glm::dvec3& direction) const;

    /// All triangles that the whole line through `p` meets, in their order along it; of equals the lower index first.
    /// \param hits  receives them
    void hitsAlong(const glm::dvec3& p, const glm::dvec3& direction, std::vector<LineHit>& hits) const;

    /// The parts of the whole line through `p` that are inside, as inside() has it, in order. Their ends are those of the
    /// triangles' planes, in double precision.
    /// \param spans  receives them
    /// \return false if the crossings do not add up, and nothing is known: the line passes through an edge, or the mesh is
    ///         open.
    [[nodiscard]] bool spansInside(const glm::dvec3& p, const glm::dvec3& direction,
                                   std::vector<LineSpan>& spans) const;

    /// Every edge belongs to an even number of triangles, where equal positions are one: inside() is then the
    /// same at both ends of any segment that meets no surface.
    [[nodiscard]] bool watertight() const { return mesh_.closed(); }

    /// The lowest index of equally close triangles.
    /// \param hint  a triangle that is probably near: saves time, and does not change the distance.
    [[nodiscard]] ClosestPoint closest(const glm::vec3& p, std::optional<std::uint32_t> hint = {}) const;

    /// The distance to the surface, negative where p is inside. Object units.
    [[nodiscard]] double signedDistance(const glm::vec3& p) const;

    /// No triangle meets the open segment between two points.
    [[nodiscard]] bool segmentIsFree(const glm::dvec3& from, const glm::dvec3& to) const;

    /// No triangle meets the ray. \param direction  of any length but 0.
    [[nodiscard]] bool rayIsFree(const glm::dvec3& origin, const glm::dvec3& direction) const;

    /// \param direction  of any length but 0.
    [[nodiscard]] std::optional<FirstHit> firstHit(const glm::dvec3& origin,
                                                   const glm::dvec3& direction) const;

    /// The stretches of a line that are outside, but for its two ends, in their order. By what it crosses, so that one
    /// through an edge may be told less than there are, or one that is none: ask inside() in the middle of what counts.
    /// \param direction  of any length but 0.
    [[nodiscard]] std::vector<LineGap> gapsAlong(const glm::dvec3& origin, const glm::dvec3& direction) const;

  private:
    MeshQuery(PreparedMesh mesh, const EmbreeMesh& tree)
        : mesh_(std::move(mesh)), tree_(&tree), shells_(mesh_.woundShells()), bodies_(mesh_.bodies()) {}

    [[nodiscard]] bool rayIsInside(const glm::vec3& p, const glm::dvec3& direction) const;
    /// \param end  in units of the direction.
    [[nodiscard]] bool isFree(const glm::dvec3& origin, const glm::dvec3& direction, float end) const;

    PreparedMesh mesh_;
    const EmbreeMesh* tree_;                 // mesh_ holds it
    bool shells_;                            // PreparedMesh::woundShells
    std::span<const std::uint32_t> bodies_;  // mesh_ holds them
};

}  // namespace relief
