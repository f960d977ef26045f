// SPDX-License-Identifier: Apache-2.0
// Answers point and ray queries on a mesh with Embree: the truth that colliders are measured against.
#pragma once

#include <array>
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

/// Returns the point on a triangle closest to p. Ericson, "Real-Time Collision Detection" (2005), section 5.1.5.
[[nodiscard]] glm::dvec3 closestOnTriangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                                           const glm::dvec3& c);

struct FirstHit {
    double along = 0.0;  ///< units of the ray's direction
    std::uint32_t triangle = 0;
};

/// An interval of a line, in units of its direction.
struct LineSpan {
    double begin = 0.0;
    double end = 0.0;
};

/// Returns the interval of a triangle's corners, projected onto a line.
[[nodiscard]] LineSpan cornerSpan(const TriangleMesh& mesh, std::uint32_t triangle, const glm::dvec3& origin,
                                  const glm::dvec3& direction);

struct LineHit {
    double at = 0.0;  ///< units of the line's direction
    std::uint32_t triangle = 0;

    friend auto operator<=>(const LineHit&, const LineHit&) = default;
};

/// Tracks which bodies (sets of triangles: MeshQuery::bodyOf) a path is in.
struct BodyCounter {
    int winding = 0;                 ///< winding number for body 0
    std::vector<std::uint32_t> odd;  ///< other bodies, crossed an odd number of times so far

    [[nodiscard]] bool inside() const { return winding != 0 || !odd.empty(); }
    /// Records a crossing. \param side  1 if the path leaves through the surface, −1 if it enters.
    void cross(std::uint32_t body, int side);
};

/// Directions of the rays that classify points as inside or outside. About unit length. Modelled edges and faces are
/// unlikely to be parallel to them.
inline constexpr std::array<glm::dvec3, 7> kParityDirections = {{{0.5773, 0.6137, 0.5386},
                                                                 {-0.7351, 0.3119, 0.6019},
                                                                 {0.2677, -0.8713, 0.4111},
                                                                 {0.4637, 0.3511, -0.8135},
                                                                 {-0.1933, -0.5557, -0.8087},
                                                                 {0.8819, -0.2749, -0.3829},
                                                                 {-0.6131, 0.7717, -0.1693}}};

/// Queries are thread-safe and deterministic. Directions may have any length above 0.
class MeshQuery {
  public:
    /// Shares the Embree scene of the mesh. Errors: those of EmbreeMesh::build.
    [[nodiscard]] static Result<MeshQuery> build(PreparedMesh mesh);

    [[nodiscard]] const PreparedMesh& prepared() const { return mesh_; }
    [[nodiscard]] const TriangleMesh& mesh() const { return *mesh_; }

    /// Classifies a point by the majority of seven rays, kParityDirections. Their parity is independent of the winding
    /// and tolerates holes for most points. If PreparedMesh::woundShells(), the winding number decides, so that the
    /// overlap of two solids is inside. In a union (PreparedMesh::unionOf), each body that uses parity is tested
    /// separately; if none does, three rays vote on the winding number. Voids are inside.
    [[nodiscard]] bool inside(const glm::vec3& p) const;

    /// Like inside(), but voids are outside.
    [[nodiscard]] bool inBody(const glm::vec3& p) const;
    [[nodiscard]] bool hasVoids() const { return !mesh_.voids().places.empty(); }
    /// Whether a point is in a void. Equal for both ends of a free segment, except in creases narrower than the grid of
    /// the voids.
    /// \param p  in no body.
    [[nodiscard]] bool inVoid(const glm::dvec3& p) const;
    /// Whether no void meets the box. Conservative: may return false for a box that meets none.
    [[nodiscard]] bool awayFromVoids(const glm::dvec3& low, const glm::dvec3& high) const;

    /// Returns a counter of the bodies that contain `p`. To follow a path from `p`, call BodyCounter::cross()
    /// with the bodyOf() of each crossed triangle. On open meshes, the counter at the end can differ from inside().
    [[nodiscard]] BodyCounter bodiesAt(const glm::vec3& p) const;
    /// The body of a triangle: 0 if the winding number decides, else the number of a body that uses parity.
    [[nodiscard]] std::uint32_t bodyOf(std::uint32_t triangle) const {
        return shells_ ? 0 : bodies_.empty() ? 1 : bodies_[triangle];
    }

    [[nodiscard]] unsigned crossings(const glm::vec3& p, const glm::dvec3& direction) const;

    /// Finds all triangles on the infinite line through `p`, sorted by position, then index.
    void hitsAlong(const glm::dvec3& p, const glm::dvec3& direction, std::vector<LineHit>& hits) const;

    /// Finds the intervals of the infinite line through `p` that are inside, as inside() defines it, in order. Their
    /// ends lie on the triangles' planes, in double precision.
    /// \return false, with no valid intervals, if crossings do not balance: the line meets an edge, or the mesh is
    /// open.
    [[nodiscard]] bool spansInside(const glm::dvec3& p, const glm::dvec3& direction,
                                   std::vector<LineSpan>& spans) const;

    /// Whether every edge has an even number of triangles, with equal positions merged. Then inside() is equal at both
    /// ends of a free segment.
    [[nodiscard]] bool watertight() const { return mesh_.closed(); }

    /// Finds the closest point; among equally close triangles, on the one with the lowest index.
    /// \param hint  a triangle that is probably near: speeds up the search, without changing the distance.
    [[nodiscard]] ClosestPoint closest(const glm::vec3& p, std::optional<std::uint32_t> hint = {}) const;

    /// Whether a triangle with a label other than `label` is within `radius`.
    /// \param labels  per triangle.
    [[nodiscard]] bool hasOtherLabelWithin(const glm::vec3& p, double radius,
                                           std::span<const std::uint8_t> labels, std::uint8_t label) const;

    [[nodiscard]] double signedDistance(const glm::vec3& p) const;

    /// Whether no triangle meets the open segment between two points.
    [[nodiscard]] bool isSegmentFree(const glm::dvec3& from, const glm::dvec3& to) const;

    [[nodiscard]] bool isRayFree(const glm::dvec3& origin, const glm::dvec3& direction) const;

    [[nodiscard]] std::optional<FirstHit> firstHit(const glm::dvec3& origin,
                                                   const glm::dvec3& direction) const;

    [[nodiscard]] const EmbreeMesh& tree() const { return *tree_; }

  private:
    MeshQuery(PreparedMesh mesh, const EmbreeMesh& tree)
        : mesh_(std::move(mesh)), tree_(&tree), shells_(mesh_.woundShells()), bodies_(mesh_.bodies()) {}

    [[nodiscard]] bool rayIsInside(const glm::vec3& p, const glm::dvec3& direction) const;
    /// Returns the bodies at the start of a ray.
    [[nodiscard]] BodyCounter countAlong(const glm::vec3& p, const glm::dvec3& direction) const;
    /// \param end  in units of the direction.
    [[nodiscard]] bool isFree(const glm::dvec3& origin, const glm::dvec3& direction, float end) const;

    PreparedMesh mesh_;
    const EmbreeMesh* tree_;                 // owned by mesh_
    bool shells_;                            // PreparedMesh::woundShells()
    std::span<const std::uint32_t> bodies_;  // owned by mesh_
};

}  // namespace relief
