// SPDX-License-Identifier: Apache-2.0
// The default sweep length of a scene.
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

/// Computes the maximum length of a step's pieces (ParticleSystem::setSweep()) from the longest step and the fastest
/// birth so far. The length is 0 if no particle can pass through a collider in one step. Otherwise it is half the
/// thickness of the thinnest collider that a particle can pass through, plus the particle's radius; it is larger if a
/// step would need more than StepPass::kSweepPieces pieces. Ignores deforming colliders.
class SceneSweep {
  public:
    SceneSweep() = default;
    /// \param scene     complete, with all defaults.
    /// \param colliders of the scene.
    /// \param emitters  of the scene, before their first birth.
    /// \param bounds    of all colliders, in the space of the particles.
    SceneSweep(const Scene& scene, std::span<const std::shared_ptr<const Collider>> colliders,
               std::span<const Emitter> emitters, const Bounds& bounds);

    /// Accounts for new emitters, before their first birth.
    void add(const Scene& scene, std::span<const Emitter> emitters);
    /// Accounts for changed forces and types.
    void change(const Scene& scene) { add(scene, births_); }
    /// Accounts for births that do not come from emitters.
    void add(const Scene& scene, std::span<const Birth> births);

    /// Returns the maximum length of a step's pieces: collision.sweep if the scene sets it, else the computed length.
    /// \param warnings  receives one line, once, if thin colliders can still be passed through: the number of these
    ///                  colliders, the thinnest, and the fix.
    [[nodiscard]] float lengthFor(float dt, const Scene& scene, std::vector<std::string>& warnings);

  private:
    struct Body {
        std::filesystem::path path;
        float thick = 0.0F;     // typical thickness, world units
        std::size_t group = 0;  // bit of ParticleType::collides_with
    };
    struct Thin;
    [[nodiscard]] std::vector<Thin> thinColliders() const;
    [[nodiscard]] static std::string thinWarning(std::span<const Thin> all, bool sweeps);

    Bounds bounds_;
    std::vector<Birth> births_;  // the first births of the emitters
    std::vector<Body> bodies_;
    std::vector<std::map<float, float>> groups_;  // per group: highest speed by particle radius
    float longest_ = 0.0F;                        // longest step, seconds
    float half_ = 0.0F;    // half the smallest sum of thickness and diameter that a step exceeds; 0: none
    float speed_ = 0.0F;   // highest speed at colliders thinner than a step
    bool fitted_ = false;  // half_ and speed_ are up to date
    bool warned_ = false;
};

}  // namespace relief
