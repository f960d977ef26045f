// SPDX-License-Identifier: Apache-2.0
// The field of a world at a point: the union of its bodies, as shaders make it of theirs.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "formats/world/world.h"

namespace relief {

struct WorldSample {
    /// Signed distance in world units, as that of a FieldSample times the body's scale; meaningless where body is −1.
    float distance = 0.0F;
    glm::vec3 normal{0.0F};  ///< world space; zero where it is unknown
    int body = -1;           ///< the deepest or nearest; the first of equals; −1 where every body abstains

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

    /// The least distance of all bodies.
    [[nodiscard]] WorldSample evaluate(const glm::vec3& p) const;
    /// The least distance of some bodies. \param bodies  in rising order.
    [[nodiscard]] WorldSample evaluate(const glm::vec3& p, std::span<const std::uint32_t> bodies) const;
    /// The bodies that may hold a point of a box: of any other the point is outside. In rising order.
    [[nodiscard]] std::vector<std::uint32_t> bodiesIn(const Bounds& box) const;

    [[nodiscard]] glm::vec3 toObject(std::size_t body, const glm::vec3& p) const;
    /// \param v  a vector of object space; its length is multiplied by the scale.
    [[nodiscard]] glm::vec3 turn(std::size_t body, const glm::vec3& v) const;

  private:
    void addSample(std::size_t body, const glm::vec3& p, WorldSample& best) const;

    LoadedWorld loaded_;
    std::vector<Bounds> boxes_;  ///< of the bodies, in the world, with room
    std::vector<char>
        local_;  ///< 1: all that the body knows of a point beyond its box is that it is far outside
};

}  // namespace relief
