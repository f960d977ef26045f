// SPDX-License-Identifier: Apache-2.0
// Finds the nearest surface of a collider by repeated evaluation of its maps.
//
// The vote at a point P uses only one plane: the plane of the texel that P projects to. The distance is correct if the
// surface coincides with that plane. It is wrong beside a silhouette, past an edge, or in a pocket, where another part
// is nearer. The search therefore tests whether the maps change sign at the plane, adopts the plane found there, and
// probes around P for nearer surfaces:
//
//            ·  P  ·          1. Project P onto the plane of the vote (1), and step slightly beyond.
//         ·    /|\    ·       2. If that point is on P's side, its plane (2) also counts: continue to the nearest
//        ·    / | \    ·         point behind both planes. Otherwise, it is on the other side, behind a surface.
//        ·   2  1  ·   ·      3. Probe 14 points on two spheres around P, inside the distance found. If one
//     ____\ /______ ·            is on the other side, a nearer surface exists there.
//          X
// Other implementations may evaluate other points. They must keep the sign, and return only points on the side opposite
// P's, or points on a plane just in front of that side.
#pragma once

#include <glm/vec3.hpp>

#include "formats/collider.h"

namespace relief {

/// A surface near a point.
struct SurfaceSample {
    /// Object units, with the sign of evaluate(): negative inside. kFarOutside if evaluate() returns it and no
    /// surface was found.
    float distance = kFarOutside;
    glm::vec3 point{0.0F};   ///< nearest point found, object space; P if distance is kFarOutside
    glm::vec3 normal{0.0F};  ///< of the surface there, unit length, outwards; zero if distance is kFarOutside
    int map = -1;            ///< the map of that surface; −1 if all maps abstain at P

    [[nodiscard]] bool inside() const { return map >= 0 && distance < 0.0F; }
};

/// Search parameters; nearest_surface.cpp documents their use.
struct NearestSearch {
    /// Maximum evaluations per search. Near the surface, a search needs about 20 on average. If P is outside, most
    /// evaluations stop at the first vote.
    static constexpr int kEvaluationsMax = 192;
    static constexpr int kSteps = 8;           // from the plane of the vote at P
    static constexpr int kStepsFromProbe = 4;  // from a plane found by a probe
    // Overshoot of an evaluation behind a plane, as a fraction of the distance to the plane.
    static constexpr float kBeyond = 0.015625F;
    static constexpr float kBeyondMin = 1.52587890625e-5F;  // 2⁻¹⁶, as a fraction of the bounds' longest side
    // As a fraction of the longest side; small enough not to step over thin parts.
    static constexpr float kBeyondMax = 0.00390625F;
    // A new plane must be nearer by this factor to justify another step.
    static constexpr float kNearer = 0.9921875F;
    static constexpr int kFinestRing = 5;  // radius 2⁻⁵ of the longest side
    static constexpr int kFinestWholeRing = 3;
    static constexpr int kHalvings = 4;
    static constexpr int kRounds = 2;
    static constexpr float kShareNear = 0.5F;  // fraction of the distance found
    static constexpr float kShareFar = 0.9F;
    static constexpr int kTurns = 12;
    static constexpr float kTilt = 0.5F;
    static constexpr float kTiltMin = 0.0625F;
    static constexpr float kReachMax = 1e15F;  // keeps squares from overflowing
    static constexpr float kReachMin = 1e-12F;
    // The smallest normal float: a distance of 0 would have no sign.
    static constexpr float kDistanceMin = 1.17549435e-38F;
};

/// Computes the distance from P to the nearest surface that the maps represent.
///
/// The sign is that of evaluate(). The distance is measured to `point`, which is on the side opposite P's, or on the
/// plane of a vote just in front of that side. The search never returns a surface that the maps do not represent, but
/// may miss a nearer surface: a part that is thin relative to its distance from P. If no point on the other side is
/// found, the result is that of evaluate().
///
/// \param p  object space; any finite point. The result is that of evaluate() if a coordinate of P or of the bounds
/// exceeds 10¹⁵ in magnitude, or if the bounds' longest side is below 10⁻¹².
/// \return finite for all map contents.
[[nodiscard]] SurfaceSample nearestSurface(const Collider& collider, const glm::vec3& p);

/// Returns a box that contains inside points if nearestSurface() finds a surface at less than `distance` from P. If P is
/// outside, the search evaluates an inside point at most a little farther than each surface that it finds. The plane of
/// the vote at P, which the search returns if it finds no surface, may be in front of all inside points.
[[nodiscard]] Bounds boxToSearch(const Collider& collider, const glm::vec3& p, float distance);

}  // namespace relief
