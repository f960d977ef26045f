// SPDX-License-Identifier: Apache-2.0
// The sweep of a scene that does not state it.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "formats/collider.h"
#include "runtime/particles/emitter.h"
#include "runtime/scene/scene.h"

namespace relief {

/// By the longest step and the fastest birth so far: half of the thinnest collider that such a step is longer than, or what the
/// pieces of a sweep reach; 0 if there is none. Colliders that deform are left out.
class SceneSweep {
  public:
    SceneSweep() = default;
    /// \param scene     complete, with every default.
    /// \param colliders as many as the scene has.
    /// \param emitters  as many as the scene has, before their first birth.
    /// \param bounds    of all colliders, in the particles' space.
    SceneSweep(const Scene& scene, std::span<const std::shared_ptr<const Collider>> colliders,
               std::span<const Emitter> emitters, const Bounds& bounds);

    /// Emitters in place of those of before.
    void add(const Scene& scene, std::span<const Emitter> emitters);
    /// Births besides the emitters'.
    void add(const Scene& scene, std::span<const Birth> births);

    /// The sweep of a step: collision.sweep if the scene states it.
    /// \param warnings  gets one line, once, if colliders are still thinner than a step or than the sweep, so that particles pass
    ///                  through them: how many there are, the thinnest, and the cure for all.
    [[nodiscard]] float lengthFor(float dt, const Scene& scene, std::vector<std::string>& warnings);

  private:
    struct Body {
        std::filesystem::path path;
        float thick = 0.0F;     // mostly, world units
        std::size_t group = 0;  // a bit of ParticleType::collides
    };
    struct Thin;
    [[nodiscard]] std::vector<Thin> thinColliders() const;
    [[nodiscard]] static std::string thinWarning(std::span<const Thin> all, bool sweeps);

    Bounds bounds_;
    std::vector<Body> bodies_;
    std::vector<std::map<float, float>> groups_;  // the fastest that meets the bodies of each, by its radius
    float longest_ = 0.0F;                        // step, seconds
    float half_ = 0.0F;    // of the thinnest; 0: no step is longer than a collider is thick
    float speed_ = 0.0F;   // of the fastest that meets a collider as thin
    bool fitted_ = false;  // these two, to the births so far
    bool warned_ = false;
};

}  // namespace relief
