// SPDX-License-Identifier: Apache-2.0
// Point and ray queries of a mesh, by Embree: the truth that colliders are measured against.
#pragma once

#include <compare>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "bake/mesh/prepared_mesh.h"
#include "formats/base/result.h"

namespace relief {

struct ClosestPoint {
    double distance = 0.0;  ///< object units, not negative
    std::uint32_t triangle = 0;
    glm::dvec3 point{0.0};  ///< object space, on the triangle
};

/// The point of a triangle closest to p. Ericson, "Real-Time Collision Detection" (2005), section 5.1.5.
[[nodiscard]] glm::dvec3 closestOnTriangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                                           const glm::dvec3& c);

struct FirstHit {
    double along = 0.0;  ///< in units of the ray's direction
    std::uint32_t triangle = 0;
};

/// An interval of a line, in units of its direction.
struct LineSpan {
    double begin = 0.0;
    double end = 0.0;
};

/// The depth interval of a triangle's corners along a line.
[[nodiscard]] LineSpan cornerSpan(const TriangleMesh& mesh, std::uint32_t triangle, const glm::dvec3& origin,
                                  const glm::dvec3& direction);

struct LineHit {
    double at = 0.0;  ///< in units of the line's direction, in double precision
    std::uint32_t triangle = 0;

    friend auto operator<=>(const LineHit&, const LineHit&) = default;
};

/// The bodies of a mesh that a path is in.
struct BodyCounter {
    int winding = 0;                 ///< about body 0
    std::vector<std::uint32_t> odd;  ///< other bodies, crossed an odd number of times so far

    [[nodiscard]] bool inside() const { return winding != 0 || !odd.empty(); }
    /// \param side  1 if the path leaves by the surface that it crosses, −1 if it enters.
    void cross(std::uint32_t body, int side);
};

/// All queries are thread-safe, and their results independent of the threads and of each other. Directions may have any
/// length but 0.
class MeshQuery {
  public:
    /// Shares the mesh's tree. Errors: those of EmbreeMesh::build.
    [[nodiscard]] static Result<MeshQuery> build(PreparedMesh mesh);

    [[nodiscard]] const PreparedMesh& prepared() const { return mesh_; }
    [[nodiscard]] const TriangleMesh& mesh() const { return *mesh_; }

    /// By the majority of seven rays, kParityDirections (inside.h): independent of the winding, and for most points of the
    /// holes of an open mesh. For PreparedMesh::woundShells the winding number decides instead, so that the overlap of two
    /// solids is inside. In a union (PreparedMesh::unionOf) each body decides for itself, by two of three rays. Voids
    /// (PreparedMesh::voids) are inside.
    [[nodiscard]] bool inside(const glm::vec3& p) const;

    /// The same without voids.
    [[nodiscard]] bool inBody(const glm::vec3& p) const;
    [[nodiscard]] bool hasVoids() const { return !mesh_.voids().places.empty(); }
    /// \param p  in no body. Equal for the ends of a free segment, but in creases narrower than the grid of the voids.
    [[nodiscard]] bool inVoid(const glm::dvec3& p) const;
    /// No void meets the box. It may be wrong for one that does not.
    [[nodiscard]] bool awayFromVoids(const glm::dvec3& low, const glm::dvec3& high) const;

    /// The bodies that `p` is in, for a path that begins there and counts each triangle on its way by bodyOf(). On open meshes
    /// the path may end in another state than inside() has it.
    [[nodiscard]] BodyCounter bodiesAt(const glm::vec3& p) const;
    /// The body of a triangle: 0 where the winding number decides, else a number of one that decides by parity.
    [[nodiscard]] std::uint32_t bodyOf(std::uint32_t triangle) const {
        return shells_ ? 0 : bodies_.empty() ? 1 : bodies_[triangle];
    }

    /// Number of triangles that a ray from `p` meets.
    [[nodiscard]] unsigned crossings(const glm::vec3& p, const glm::dvec3& direction) const;

    /// All triangles on the whole line through `p`, in order; of equals the lower index first.
    void hitsAlong(const glm::dvec3& p, const glm::dvec3& direction, std::vector<LineHit>& hits) const;

    /// The intervals of the whole line through `p` that are inside, as inside() has it, in order. Their ends are those of
    /// the triangles' planes, in double precision.
    /// \return false if the crossings do not balance, and nothing is known: the line meets an edge, or the mesh is open.
    [[nodiscard]] bool spansInside(const glm::dvec3& p, const glm::dvec3& direction,
                                   std::vector<LineSpan>& spans) const;

    /// Every edge has an even number of triangles, equal positions being one: inside() is then equal at both ends of a free
    /// segment.
    [[nodiscard]] bool watertight() const { return mesh_.closed(); }

    /// Of equally close triangles the lowest index.
    /// \param hint  a triangle that is probably near: saves time, and does not change the distance.
    [[nodiscard]] ClosestPoint closest(const glm::vec3& p, std::optional<std::uint32_t> hint = {}) const;

    /// Whether a triangle of another label than `label` is that near.
    /// \param labels  of the triangles.
    [[nodiscard]] bool otherWithin(const glm::vec3& p, double radius, std::span<const std::uint8_t> labels,
                                   std::uint8_t label) const;

    /// Object units, negative inside.
    [[nodiscard]] double signedDistance(const glm::vec3& p) const;

    /// No triangle meets the open segment between two points.
    [[nodiscard]] bool segmentIsFree(const glm::dvec3& from, const glm::dvec3& to) const;

    /// No triangle meets the ray.
    [[nodiscard]] bool rayIsFree(const glm::dvec3& origin, const glm::dvec3& direction) const;

    [[nodiscard]] std::optional<FirstHit> firstHit(const glm::dvec3& origin,
                                                   const glm::dvec3& direction) const;

    [[nodiscard]] const EmbreeMesh& tree() const { return *tree_; }

  private:
    /// The body that a line crosses, and 1 if it leaves it, −1 if it enters.
    struct Crossing {
        std::uint32_t body;
        int side;
        auto operator<=>(const Crossing&) const = default;
    };
    [[nodiscard]] Crossing crossingOf(const LineHit& hit, const glm::dvec3& direction) const;

    MeshQuery(PreparedMesh mesh, const EmbreeMesh& tree)
        : mesh_(std::move(mesh)), tree_(&tree), shells_(mesh_.woundShells()), bodies_(mesh_.bodies()) {}

    [[nodiscard]] bool rayIsInside(const glm::vec3& p, const glm::dvec3& direction) const;
    /// The bodies at the begin of a ray.
    [[nodiscard]] BodyCounter countAlong(const glm::vec3& p, const glm::dvec3& direction) const;
    /// \param end  in units of the direction.
    [[nodiscard]] bool isFree(const glm::dvec3& origin, const glm::dvec3& direction, float end) const;

    PreparedMesh mesh_;
    const EmbreeMesh* tree_;                 // mesh_ holds it
    bool shells_;                            // PreparedMesh::woundShells
    std::span<const std::uint32_t> bodies_;  // mesh_ holds them
};

}  // namespace relief
