// SPDX-License-Identifier: Apache-2.0
// Computes which parts of a surface the maps of a collider can see.
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

/// The lines of sight of one map, independent of its texels.
class Sight {
  public:
    /// Borrows both arguments.
    Sight(const DepthMap& map, const MeshQuery& query);

    /// Returns true if an unobstructed line within the volume leads from a start of the map's rays to a point
    /// kSurfaceStep in front of the surface, so that the map can represent the surface. Always true for patches.
    [[nodiscard]] bool sees(const SurfacePoint& point) const;

    /// Returns the start of an unobstructed line of sight to a point in object space. nullopt: there is none, so even
    /// the finest texels would not classify the point as outside.
    [[nodiscard]] std::optional<glm::dvec3> reaches(const glm::dvec3& p) const;

  private:
    struct Lines {
        std::array<glm::dvec3, 2> start;  ///< start of the map's rays, object space
        std::size_t count = 0;
    };
    [[nodiscard]] glm::dvec3 inMap(const glm::dvec3& p) const;
    [[nodiscard]] bool isInVolume(const glm::dvec3& in_map) const;
    [[nodiscard]] Lines linesTo(const glm::dvec3& p, const glm::dvec3& in_map) const;

    const DepthMap& map_;
    const MeshQuery& query_;
    glm::dmat3 to_map_;
    glm::dmat3 to_object_;
    glm::dvec3 offset_;
    double side_;
};

/// The lines of sight of all maps of a collider.
class Sights {
  public:
    /// Borrows both arguments.
    Sights(std::span<const DepthMap> maps, const MeshQuery& query);

    [[nodiscard]] bool isVisible(const SurfacePoint& point) const;
    [[nodiscard]] const std::vector<Sight>& maps() const { return sights_; }

    /// Unseen fraction of the points that are not buried, in percent. The result does not depend on the number of
    /// threads.
    [[nodiscard]] double unseenPercent(std::span<const SurfacePoint> points) const;

  private:
    std::vector<Sight> sights_;
};

}  // namespace relief
