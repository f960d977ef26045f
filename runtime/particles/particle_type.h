// What kinds of particles there are, and how each moves and collides.
#pragma once

#include <cstddef>
#include <cstdint>

namespace relief {

/// What a collision does to a particle; one that is caught inside always leaves first.
enum class OnCollision : std::uint8_t {
    kBounce = 0,  ///< the paper's reaction, by restitution and friction
    kStop = 1,    ///< stays where it touches, and goes with what it touched (snow)
    kSlide = 2,   ///< keeps the tangential part of its velocity alone
    kDie = 3,     ///< out of sight at once; its place is free again at the end of its lifetime
};

struct ParticleType {
    float mass = 1.0F;    ///< divides the drag; > 0
    float radius = 0.0F;  ///< of collision, world units, ≥ 0
    float restitution =
        0.0F;  ///< ε, 0…1: how much comes back of the normal speed at the beginning of the step
    float friction = 0.0F;            ///< ν, 0…1: how much of the tangential speed is lost
    float friction_threshold = 0.0F;  ///< no friction below this speed, world units a second
    OnCollision on_collision = OnCollision::kBounce;
    float lifetime_loss = 0.0F;  ///< seconds of life that each step in contact costs, ≥ 0
};

inline constexpr std::size_t kParticleTypesMax = 16;

}  // namespace relief
