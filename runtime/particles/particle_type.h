// What kinds of particles there are, and how each moves and collides.
#pragma once

#include <cstddef>

#include "shaders/shader_constants.h"

namespace relief {

struct ParticleType {
    float mass = 1.0F;    ///< divides the drag; at least kParticleMassMin
    float radius = 0.0F;  ///< of collision, world units, ≥ 0
    /// ε, 0…1: how much comes back of the normal speed at the beginning of the step.
    float restitution = 0.0F;
    float friction = 0.0F;            ///< ν, 0…1: how much of the tangential speed is lost
    float friction_threshold = 0.0F;  ///< no friction below this speed, world units a second
    OnCollision on_collision = OnCollision::kBounce;
    float lifetime_loss = 0.0F;  ///< seconds of life that each step in contact costs, ≥ 0
};

inline constexpr std::size_t kParticleTypesMax = 16;
/// With less, drag over mass times wind is no float any more.
inline constexpr float kParticleMassMin = 1e-15F;

}  // namespace relief
