// Emitters that move: along keys of their own, with a body, or both.
#pragma once

#include <span>
#include <vector>

#include "runtime/collider/pose_keys.h"
#include "runtime/particles/birth.h"

namespace relief {

/// The trajectory that carries an emitter's births. Its places are then in a space of its own, which `keys` bring into the
/// space of the body, and `body` into the world; a scale scales places, but no velocities.
struct EmitterMotion {
    std::vector<PoseKey> keys;  ///< empty: its space is that of the body
    std::vector<PoseKey> body;  ///< one key: a body at rest; empty: the space of the body is the world
    float inherit = 0.0F;       ///< share of the velocity of its place that a birth takes on
    [[nodiscard]] bool none() const { return keys.empty() && body.empty(); }
};

/// Brings births into the world: each from where the emitter is at its own moment, `age` before `time`.
/// \param time  when they enter a step: its beginning, seconds on the clock of the keys.
void carry(const EmitterMotion& motion, double time, std::span<Birth> births);

}  // namespace relief
