// What of a surface the maps of a collider see: what a bake says of its plan, and a check of a collider.
#pragma once

#include <array>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "bake/measure/truth.h"
#include "bake/mesh/mesh_query.h"
#include "formats/depth_map.h"

namespace relief {

/// A wall that stands along a map's lines of sight is looked for from this far above it, in units of the longest side:
/// farther than flat walls of artists' meshes are rough.
inline constexpr double kWallStep = 1e-3;

/// The lines of sight of one map. Its texels do not matter, but those of a map of gaps, which say from where it looks: the
/// middle of the gap, both ways.
class Sight {
  public:
    /// \param map, query  borrowed.
    Sight(const DepthMap& map, const MeshQuery& query);

    /// The map holds the surface there: an end that it keeps has, in the map's volume, a free line of sight to the
    /// front of the surface, kSurfaceStep above it. A wall that stands along the line of sight (its cosine is below
    /// kStandingCosine) is held by the planes of Decode::kPlane, but not of gaps, and seen if the line is free
    /// kSurfaceStep or kWallStep above it.
    [[nodiscard]] bool sees(const SurfacePoint& point) const;

    /// Where a free line of sight to a point begins. nullopt: none of them reaches it, and with texels as fine as one
    /// likes the map would not say that it is outside.
    /// \param p  object space; anywhere.
    [[nodiscard]] std::optional<glm::dvec3> reaches(const glm::dvec3& p) const;

    /// Every surface that the texel of a point can hold is flat: the lines of sight through the texel meet it within
    /// `tolerance` of the plane that the middle one meets, or nothing at all. Its plane then is the surface. Never of a
    /// map of gaps.
    /// \param p  object space. \param tolerance  object units.
    [[nodiscard]] bool isFlatRound(const glm::dvec3& p, double tolerance) const;

  private:
    struct Line {
        glm::dvec3 start;  ///< where the map's ray starts, object space
        bool parallel;     ///< to the lines of the points beside it
    };
    struct Lines {
        std::array<Line, 2> line;
        std::size_t count = 0;
    };
    [[nodiscard]] glm::dvec3 inMap(const glm::dvec3& p) const;
    [[nodiscard]] bool isInVolume(const glm::dvec3& in_map) const;
    /// Where the line of sight with these coordinates across the texel of p begins and ends, object space.
    struct Ray {
        glm::dvec3 from;
        glm::dvec3 to;
    };
    [[nodiscard]] Ray texelRay(const glm::dvec3& in_map, double across, double along) const;
    [[nodiscard]] bool isFlat(const std::array<Ray, 9>& rays, bool from_far_end, double tolerance) const;
    [[nodiscard]] Lines linesTo(const glm::dvec3& p, const glm::dvec3& in_map) const;

    const DepthMap& map_;
    const MeshQuery& query_;
    glm::dvec3 rows_[3];
    glm::dvec3 offset_{0.0};
    glm::dmat3 to_object_{1.0};
    double side_ = 0.0;
};

/// All maps of a collider, or of a plan.
class Sights {
  public:
    /// \param maps, query  borrowed.
    Sights(std::span<const DepthMap> maps, const MeshQuery& query);

    [[nodiscard]] bool see(const SurfacePoint& point) const;
    [[nodiscard]] const std::vector<Sight>& maps() const { return sights_; }

    /// Share of the points that are not buried and that no map sees. Percent; the same for any number of threads.
    [[nodiscard]] double unseenPercent(std::span<const SurfacePoint> points) const;

  private:
    std::vector<Sight> sights_;
};

}  // namespace relief
