// SPDX-License-Identifier: Apache-2.0
// The nearest surface of a collider, found by evaluating its maps repeatedly.
//
// A vote knows one plane: that of the texel that P falls on. Its distance is the surface's where the surface is that
// plane, and wrong beside a silhouette, off an edge, or in a pocket, where another part is nearer. So the search
// looks whether the maps change sign where the plane says so, takes the plane that it finds there, and looks around
// P for whatever is nearer still:
//
//            ·  P  ·          1. the foot of P on the plane of the vote (1), and a little beyond
//         ·    /|\    ·       2. still P's side: the plane met there (2) counts too; on to the nearest
//        ·    / | \    ·         point of both. The other side: a surface lies between
//        ·   2  1  ·   ·      3. eight points on spheres about P, inside the distance found: where one is
//     ____\ /______ ·         on the other side, a nearer surface is there
//          X
// Another implementation may evaluate other points. It must keep the sign, and offer only points of the other side, or feet
// whose plane was met just behind them.
#pragma once

#include <glm/vec3.hpp>

#include "formats/collider.h"

namespace relief {

/// A surface near a point.
struct SurfaceSample {
    /// Object units, with the sign of evaluate(), negative inside. kFarOutside where P is known to be outside and no
    /// surface was found; meaningless where map is −1.
    float distance = 0.0F;
    glm::vec3 point{0.0F};  ///< the nearest point found, object space; P where distance is kFarOutside
    glm::vec3 normal{
        0.0F};     ///< of the surface there, unit length, outwards; zero where distance is kFarOutside
    int map = -1;  ///< whose surface that is; −1 where every map abstains at P

    [[nodiscard]] bool inside() const { return map >= 0 && distance < 0.0F; }
};

/// The numbers of the search, of which nearest_surface.cpp uses each.
struct NearestSearch {
    /// No search evaluates more points. Near the surface it evaluates about 20 on average; outside, most of them
    /// cost one vote.
    static constexpr int kEvaluationsMax = 192;
    static constexpr int kSteps = 8;           // from the plane of the vote at P
    static constexpr int kStepsFromProbe = 4;  // from a plane met beside it
    static constexpr float kBeyond =
        0.015625F;  // of the way to a plane: how far behind it the maps are evaluated
    static constexpr float kBeyondMin = 1.52587890625e-5F;  // 2⁻¹⁶ of the longest side
    static constexpr float kBeyondMax =
        0.00390625F;                              // of the longest side, so that no thin part is stepped over
    static constexpr float kNearer = 0.9921875F;  // a plane must be nearer by that to be worth another step
    static constexpr int kFinestRing = 5;         // of radius 2⁻⁵ of the longest side
    static constexpr int kFinestWholeRing = 3;
    static constexpr int kHalvings = 4;
    static constexpr int kRounds = 2;
    static constexpr float kShareNear = 0.5F;  // of the distance found
    static constexpr float kShareFar = 0.9F;
    static constexpr int kTurns = 12;
    static constexpr float kTilt = 0.5F;
    static constexpr float kTiltMin = 0.0625F;
    static constexpr float kReachMax = 1e15F;  // so that squares do not overflow
    static constexpr float kReachMin = 1e-12F;
    static constexpr float kDistanceMin =
        1.17549435e-38F;  // the least normal float: a distance of 0 would be neither side
};

/// The distance from P to the nearest surface that the maps know of.
///
/// The sign is that of evaluate(). The distance is that to `point`, a point of a plane that the maps vote by, between P
/// and a point that they call the other side. So no surface is made up, but a nearer one may be missed: a part that is
/// thin against its distance from P. Where nothing of the other side is found at all, the answer is evaluate()'s, whose
/// plane then is all that is known.
///
/// \param p  object space; any finite point. The search leaves out points and colliders beyond 10¹⁵, or flatter than
///           10⁻¹²; the answer then is evaluate()'s.
/// \return finite, whatever the maps hold.
[[nodiscard]] SurfaceSample nearestSurface(const Collider& collider, const glm::vec3& p);

}  // namespace relief
