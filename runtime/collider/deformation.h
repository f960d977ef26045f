// Deformations of a mesh in the course of time, on the CPU: the truth of shaders/collider/deform.vert, and what a
// scene needs to choose boxes that hold the whole motion.
//
//     twist   p turns about the line (center, axis) by angle · share(s)         s = (p − center)·axis
//     bend    the beam along `along` is wound, over the range of s, on a circle about an axis parallel to
//             `axis`; s = (p − center)·along. What lies beyond the range goes on straight. Lengths on the
//             line through `center` stay (Barr, Global and Local Deformations of Solid Primitives, SIGGRAPH
//             1984, section 3.4)
//     wobble  p + n · amplitude/3 · Σ_k sin(2π (p_k / wavelength − r_k frequency·t) + phase + k), for
//             k = 0, 1, 2 of x, y, z; r = (1, 1.25, 0.8); n the normal of the vertex
//
//     angle = amplitude · sin(2π frequency·t + phase)
//     share   from 0 at range_low to 1 at range_high, clamped
#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "shaders/collider/constants.h"

namespace relief {

struct Deformation {
    DeformKind kind = DeformKind::kTwist;
    float amplitude = 0.0F;             ///< bend, twist: radians, at most 2π; wobble: object units
    float frequency = 1.0F;             ///< 1/s, ≥ 0
    float phase = 0.0F;                 ///< radians
    glm::vec3 center{0.0F};             ///< object units; bend, twist
    glm::vec3 axis{0.0F, 1.0F, 0.0F};   ///< of length 1; bend, twist
    glm::vec3 along{1.0F, 0.0F, 0.0F};  ///< of length 1, across `axis`; bend
    float range_low = 0.0F;             ///< object units from `center`; bend, twist
    float range_high = 1.0F;            ///< above range_low
    float wavelength = 1.0F;            ///< object units, > 0; wobble
    friend bool operator==(const Deformation&, const Deformation&) = default;
};

/// The part of a deformation that depends on the time alone, computed in double.
struct DeformMoment {
    float angle = 0.0F;      ///< bend, twist: radians
    glm::vec3 phases{0.0F};  ///< wobble: of the three waves, radians, −2π…2π
};

/// Errors: kUsage (a number that is not finite or out of its range, an axis not of length 1, `along` not
/// across it).
[[nodiscard]] Result<void> checkDeformation(const Deformation& deformation);

/// \param time  seconds.
[[nodiscard]] DeformMoment momentOf(const Deformation& deformation, double time);

/// The place, at that moment, of a point of the mesh at rest.
/// \param normal  of the surface there, of length 1 or zero; wobble alone needs it.
[[nodiscard]] glm::vec3 deform(const Deformation& deformation, const DeformMoment& moment, const glm::vec3& p,
                               const glm::vec3& normal);

/// A box that holds the mesh at all times.
/// \param positions  of the mesh at rest, finite; at least one.
[[nodiscard]] Bounds deformedBounds(const Deformation& deformation, std::span<const glm::vec3> positions);

}  // namespace relief
