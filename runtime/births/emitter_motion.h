// SPDX-License-Identifier: Apache-2.0
// Emitters that follow a trajectory or a body, and filters of births.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "runtime/bodies/pose_keys.h"
#include "runtime/particles/emitter.h"

namespace relief {

/// Selects births: returns one flag for each. Rejected births are still generated, so that the others do not depend on
/// the filter.
/// \param births      of one emitter in one step, world space.
/// \param velocities  of their emitting points, world units/s.
/// \param time        start of the step, the `time` of carry().
using BirthFilter = std::function<std::vector<bool>(std::span<const Birth> births,
                                                    std::span<const glm::vec3> velocities, double time)>;
/// Maximum births per step of an emitter with a filter; the rest are rejected.
inline constexpr std::uint64_t kFilteredMax = std::uint64_t{1} << 20;

/// The trajectory of an emitter. Its points are in emitter space; `keys` transform them into the space of a body, and
/// `body` transforms body space into world space. Scales affect positions, but not velocities.
struct EmitterMotion {
    std::vector<PoseKey> keys;  ///< empty: emitter space is body space
    std::vector<PoseKey> body;  ///< one key: a static body; empty: body space is world space
    float inherit = 0.0F;       ///< fraction of the emitting point's velocity that a birth inherits
    BirthFilter filter = {};    ///< used by emitAll(); empty: all births are kept
    [[nodiscard]] bool none() const { return keys.empty() && body.empty(); }
};

/// Transforms births into the world. Each birth uses the emitter's pose at `time` minus its `age`.
/// \param time  start of the step in which the births first move, in seconds on the clock of the keys.
/// \param own   velocities of the emitting points in emitter space, also inherited; empty: zero.
/// \param velocities  receives the world-space velocities of the emitting points; may be null.
void carry(const EmitterMotion& motion, double time, std::span<Birth> births,
           std::span<const glm::vec3> own = {}, std::vector<glm::vec3>* velocities = nullptr);

/// Calls emit() for each emitter in turn; if there is too little room, earlier emitters have priority.
/// \param motions  transform and filter the births; one for each emitter, or empty. Rejected births use no room.
/// \param time     as in carry(); the births occur in the `dt` seconds before it.
/// \return the sum of the values that emit() returned.
std::uint64_t emitAll(std::span<Emitter> emitters, double dt, std::uint64_t room, std::vector<Birth>& births,
                      std::span<const EmitterMotion> motions = {}, double time = 0.0);

}  // namespace relief
