// SPDX-License-Identifier: Apache-2.0
// Limits births to places where one surface touches another: emitter.touching.
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

/// A BirthFilter. A birth can touch only the nearest surface: a collider, or the ground if it is nearer. Ties go to the
/// first collider. Ignores the emitter's own collider and deforming colliders. Runs on the CPU. Uses the coarse
/// containers of a streamed world, so that births do not depend on which full containers are loaded.
class TouchFilter {
  public:
    /// \param loaded   provides the poses at the time of each birth; must outlive the filter. Poses may change only
    ///   along SceneCollider::keys.
    /// \param emitter  of that scene, with `touching`.
    TouchFilter(const LoadedScene& loaded, const SceneEmitter& emitter);

    [[nodiscard]] std::vector<bool> operator()(std::span<const Birth> births,
                                               std::span<const glm::vec3> velocities, double time) const;

  private:
    struct Body {
        std::size_t index = 0;  // in the scene
        Bounds box;             // world bounds over all times, enlarged by `within`
    };
    struct Touched {
        float distance = 0.0F;  // world units
        std::string material;   // empty: none
        glm::vec3 velocity{0.0F};
    };
    /// Returns the surface of a body at a place, if it is nearer than `within`.
    [[nodiscard]] std::optional<Touched> touchedOf(const Body& body, const glm::vec3& p, double moment,
                                                   float within) const;
    [[nodiscard]] bool touches(const glm::vec3& p, const glm::vec3& velocity, double moment,
                               std::span<const Body> near) const;

    const LoadedScene* loaded_;
    SceneTouching touching_;
    std::vector<Body> bodies_;
};

/// Returns emitterMotions() of all emitters, with filters for those with `touching`. \param loaded  must outlive them.
[[nodiscard]] std::vector<EmitterMotion> emitterMotions(const LoadedScene& loaded);

}  // namespace relief
