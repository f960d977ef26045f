// SPDX-License-Identifier: Apache-2.0
// Emitters that go along a trajectory or with a body, and births that a filter lets pass.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "runtime/bodies/pose_keys.h"
#include "runtime/particles/emitter.h"

namespace relief {

/// Which births come into being: one for each. The others are made all the same, so that these do not depend on them.
/// \param births      of one emitter in one step, in the world.
/// \param velocities  of their places, world units a second.
/// \param time        when they enter a step: the `time` of carry().
using BirthFilter = std::function<std::vector<bool>(std::span<const Birth> births,
                                                    std::span<const glm::vec3> velocities, double time)>;
/// Births of an emitter with a filter that a step makes at most; the rest is refused.
inline constexpr std::uint64_t kFilteredMax = std::uint64_t{1} << 20;

/// The trajectory that carries an emitter's births. Its places are then in a space of its own, which `keys` bring into the
/// space of the body, and `body` into the world; a scale scales places, but no velocities.
struct EmitterMotion {
    std::vector<PoseKey> keys;  ///< empty: its space is that of the body
    std::vector<PoseKey> body;  ///< one key: a body at rest; empty: the space of the body is the world
    float inherit = 0.0F;       ///< share of the velocity of its place that a birth takes on
    BirthFilter filter = {};    ///< of emitAll(); empty: all births come into being
    [[nodiscard]] bool none() const { return keys.empty() && body.empty(); }
};

/// Brings births into the world: each from where the emitter is at its own moment, `age` before `time`.
/// \param time  when they enter a step: its beginning, seconds on the clock of the keys.
/// \param own   velocities of their places in the emitter's space, of which they take on a share as well; empty: none moves.
/// \param velocities  becomes those of their places in the world; may be null.
void carry(const EmitterMotion& motion, double time, std::span<Birth> births,
           std::span<const glm::vec3> own = {}, std::vector<glm::vec3>* velocities = nullptr);

/// emit() of each in turn: where there is too little room, the earlier ones take it.
/// \param motions  of as many, or none: they carry the births along, at once, and filter them. What a filter drops takes no room.
/// \param time     of the beginning of these `dt` seconds, on the clock of the motions.
/// \return the sum.
std::uint64_t emitAll(std::span<Emitter> emitters, double dt, std::uint64_t room, std::vector<Birth>& births,
                      std::span<const EmitterMotion> motions = {}, double time = 0.0);

}  // namespace relief
