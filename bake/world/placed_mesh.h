// SPDX-License-Identifier: Apache-2.0
// A mesh at the pose of a level's node, for the truth of checks.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "bake/import/level.h"
#include "bake/mesh/mesh_query.h"

namespace relief {

/// A node of the level.
struct PlacedMesh {
    const LevelBody* body;
    const MeshQuery* query;
    glm::dvec3 low;  ///< bounds in world space
    glm::dvec3 high;

    [[nodiscard]] glm::dvec3 turn(const glm::dvec3& p, double sign) const {
        const glm::dvec3 v = sign * glm::dvec3(body->rotation[0], body->rotation[1], body->rotation[2]);
        const glm::dvec3 t = 2.0 * glm::cross(v, p);
        return p + body->rotation[3] * t + glm::cross(v, t);
    }
    [[nodiscard]] glm::dvec3 position() const {
        return {body->position[0], body->position[1], body->position[2]};
    }
    [[nodiscard]] glm::dvec3 toWorld(const glm::dvec3& p) const {
        return position() + body->scale * turn(p, 1.0);
    }
    [[nodiscard]] glm::dvec3 toObject(const glm::dvec3& p) const {
        return turn(p - position(), -1.0) / body->scale;
    }
    [[nodiscard]] bool inside(const glm::dvec3& p) const {
        return glm::all(glm::lessThanEqual(low, p)) && glm::all(glm::lessThanEqual(p, high)) &&
               query->inside(glm::vec3(toObject(p)));
    }
};

/// Returns the nodes whose bounds overlap a box.
[[nodiscard]] inline std::vector<const PlacedMesh*> placedIn(const std::vector<PlacedMesh>& all,
                                                             const glm::dvec3& low, const glm::dvec3& high) {
    std::vector<const PlacedMesh*> found;
    for (const PlacedMesh& placed : all) {
        if (glm::all(glm::lessThanEqual(placed.low, high)) &&
            glm::all(glm::greaterThanEqual(placed.high, low))) {
            found.push_back(&placed);
        }
    }
    return found;
}

}  // namespace relief
