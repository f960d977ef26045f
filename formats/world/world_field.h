// SPDX-License-Identifier: Apache-2.0
// The field of a world at a point: the union of its bodies, as in the shaders.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "formats/world/world.h"

namespace relief {

struct WorldSample {
    /// Signed, world units: FieldSample::distance times the body's scale; kFarOutside if that is, or no body votes.
    float distance = kFarOutside;
    glm::vec3 normal{0.0F};  ///< world space; zero if unknown
    int body = -1;           ///< deepest or nearest body, the first on ties; −1 if every body abstains

    [[nodiscard]] bool inside() const { return body >= 0 && distance < 0.0F; }
};

class WorldField {
  public:
    explicit WorldField(LoadedWorld loaded);

    [[nodiscard]] const World& world() const { return loaded_.world; }
    [[nodiscard]] const LoadedWorld& loaded() const { return loaded_; }
    [[nodiscard]] const std::vector<Collider>& colliders() const { return loaded_.colliders; }
    [[nodiscard]] const Collider& colliderOf(std::size_t body) const {
        return loaded_.colliders[world().bodies[body].collider];
    }

    /// Evaluates the union of all bodies.
    [[nodiscard]] WorldSample evaluate(const glm::vec3& p) const;
    /// Evaluates the union of some bodies. \param bodies  in ascending order.
    [[nodiscard]] WorldSample evaluate(const glm::vec3& p, std::span<const std::uint32_t> bodies) const;
    /// Returns the bodies that may contain a point of a box, in ascending order; the box is outside all other bodies.
    [[nodiscard]] std::vector<std::uint32_t> bodiesIn(const Bounds& box) const;

    [[nodiscard]] glm::vec3 toObject(std::size_t body, const glm::vec3& p) const;
    /// Transforms a vector to world space; its length is multiplied by the scale. \param v  in object space.
    [[nodiscard]] glm::vec3 turn(std::size_t body, const glm::vec3& v) const;

  private:
    void addSample(std::size_t body, const glm::vec3& p, WorldSample& best) const;

    LoadedWorld loaded_;
    std::vector<Bounds> boxes_;  ///< world-space boxes of the bodies, with a margin
    std::vector<char> local_;    ///< 1: all points beyond the body's box are far outside the body
};

}  // namespace relief
