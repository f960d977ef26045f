// SPDX-License-Identifier: Apache-2.0
// Births of a surface where it touches another: emitter.touching of a scene.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/collider.h"
#include "runtime/births/emitter_motion.h"
#include "runtime/particles/emitter.h"
#include "runtime/scene/loaded_scene.h"

namespace relief {

/// A BirthFilter. The nearest surface of all colliders, or the ground if that is nearer, is what a place touches; of colliders
/// that are equally near the first. The emitter's own collider does not count, nor do those that deform. On the CPU, from the
/// same containers on every machine; of a world that is streamed, the coarse ones.
class TouchFilter {
  public:
    /// \param loaded   whose poses are those at each birth's moment. It must outlive this, and its colliders' poses must not
    ///                 change but by their keys.
    /// \param emitter  of that scene, with `touching`.
    TouchFilter(const LoadedScene& loaded, const SceneEmitter& emitter);

    [[nodiscard]] std::vector<bool> operator()(std::span<const Birth> births,
                                               std::span<const glm::vec3> velocities, double time) const;

  private:
    struct Body {
        std::size_t index = 0;  // in the scene
        Bounds box;             // of all its places in the world, with room for `within`
    };
    struct Touched {
        float distance = 0.0F;  // world units
        std::string material;   // empty: it has none
        glm::vec3 velocity{0.0F};
    };
    /// The surface of a body at a place, if it is nearer than `within`.
    [[nodiscard]] std::optional<Touched> touchedOf(const Body& body, const glm::vec3& p, double moment,
                                                   float within) const;
    [[nodiscard]] bool touches(const glm::vec3& p, const glm::vec3& velocity, double moment,
                               std::span<const Body> near) const;

    const LoadedScene* loaded_;
    SceneTouching touching_;
    std::vector<Body> bodies_;
};

/// emitterMotions() of all its emitters, with the filters of those that must touch something. \param loaded  must outlive them.
[[nodiscard]] std::vector<EmitterMotion> emitterMotions(const LoadedScene& loaded);

}  // namespace relief
