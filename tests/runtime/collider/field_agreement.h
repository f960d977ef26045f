// SPDX-License-Identifier: Apache-2.0
// The GPU's answers at many points against the CPU's.
//
// Tolerance. Both sides evaluate the same formulas in floats, but not in the same order (the shader's rows
// are in texels, and it divides by a normal's length last), and a GL may fuse or reorder operations and be
// off by some units in the last place in its square roots and divisions. So distances may differ by kRelative
// of the distance's own scale (that of the map's volume), and normals by kNormal. A point closer than kBorder
// texels to a texel's edge may fall to the neighbour: it counts as agreeing if it agrees with the CPU's
// answer at one of the surrounding points kBorder texels away, and such points are counted.
// The normal of a patch changes along it, by a rounding of the point more than kNormal where the patch is curved. A GPU that
// fuses multiplications and additions rounds the point otherwise; its answers by patches may also differ by the bound of
// patch_rounding.h. A software renderer fuses nothing and gets no such allowance.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>
#include <vector>

#include "formats/collider.h"
#include "runtime/gl/gl_capabilities.h"
#include "tests/results.h"
#include "tests/runtime/collider/field_query.h"
#include "tests/runtime/collider/patch_rounding.h"

namespace relief {

inline constexpr float kRelative = 2e-6F;
inline constexpr float kNormal = 2e-6F;
inline constexpr float kBorder = 2e-3F;

inline bool agrees(const FieldSample& a, const FieldSample& b) {
    if (a.map != b.map) {
        return false;
    }
    return a.map < 0 ||
           (std::abs(a.distance - b.distance) <= kRelative * std::max(2.0F, std::abs(b.distance)) &&
            glm::length(a.normal - b.normal) <= kNormal);
}

/// The votes of a GPU's map of patches that rounding leaves possible; none if the map is of another kind.
inline std::vector<rounding::RoundedVote> possibleVotes(const Collider& collider, const glm::vec3& p,
                                                        const FieldSample& gpu) {
    if (gpu.map < 0 || isSoftwareRenderer()) {
        return {};
    }
    const DepthMap& map = collider.maps[static_cast<std::size_t>(gpu.map)];
    return map.format == MapFormat::kPatches ? rounding::patchVotes(map, p)
                                             : std::vector<rounding::RoundedVote>{};
}

/// What one map of a collider votes.
inline FieldSample evaluateAlone(const Collider& collider, const glm::vec3& p, int map) {
    Collider alone;
    alone.bounds = collider.bounds;
    alone.maps.push_back(collider.maps[static_cast<std::size_t>(map)]);
    FieldSample own = evaluate(alone, p);
    own.map = own.map < 0 ? own.map : map;
    return own;
}

/// True if two maps vote alike at p, but for rounding, and the GPU chose the other: its answer is that map's own.
inline bool tied(const Collider& collider, const glm::vec3& p, const FieldSample& gpu,
                 const rounding::RoundedVote* vote) {
    const FieldSample cpu = evaluate(collider, p);
    const double apart = vote != nullptr ? vote->distance.error : 0.0;
    if (cpu.map < 0 || gpu.map < 0 ||
        std::abs(double{cpu.distance} - double{gpu.distance}) > double{kRelative} * 2.0 + apart) {
        return false;
    }
    return vote != nullptr || agrees(gpu, evaluateAlone(collider, p, gpu.map));
}

/// Of the 27 points of a cube of side 2, the middle among them.
inline glm::vec3 neighbour(int k) {
    return {static_cast<float>(k % 3 - 1), static_cast<float>(k / 3 % 3 - 1), static_cast<float>(k / 9 - 1)};
}

/// Agreement with the CPU's answer at p, or at one of the 26 neighbours `step` away; there a tie counts, too.
enum class Agreement { kExact, kAtBorder, kNone };
inline Agreement compareAt(const Collider& collider, const glm::vec3& p, const FieldSample& gpu, float step) {
    const FieldSample cpu = evaluate(collider, p);
    if (agrees(gpu, cpu)) {
        return Agreement::kExact;
    }
    const std::vector<rounding::RoundedVote> votes = possibleVotes(collider, p, gpu);
    const auto own = std::find_if(votes.begin(), votes.end(),
                                  [&](const rounding::RoundedVote& vote) { return isWithin(gpu, vote); });
    const bool rounded = own != votes.end();
    if (rounded && gpu.map == cpu.map) {
        return Agreement::kExact;
    }
    if (tied(collider, p, gpu, rounded ? &*own : nullptr)) {
        return Agreement::kAtBorder;
    }
    const bool own_vote = gpu.map >= 0 && agrees(gpu, evaluateAlone(collider, p, gpu.map));
    for (int k = 0; k < 27; ++k) {
        const FieldSample near = evaluate(collider, p + step * neighbour(k));
        // Either another map leaves the decision to the GPU's there, or the distance has moved with the point, too.
        if (near.map == gpu.map &&
            (rounded || own_vote ||
             (std::abs(near.distance - gpu.distance) <= 4.0F * step + kRelative * 2.0F &&
              glm::length(near.normal - gpu.normal) <= kNormal))) {
            return Agreement::kAtBorder;
        }
    }
    return Agreement::kNone;
}

inline void expectAgreement(const Collider& collider, std::span<const glm::vec3> points, float texel,
                            double border_share_max) {
    FieldQuery query = required(FieldQuery::create(collider));
    const std::vector<FieldSample> samples = required(query.evaluate(points));
    ASSERT_EQ(samples.size(), points.size());
    std::size_t at_border = 0;
    std::size_t none = 0;
    std::size_t votes = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        votes += (samples)[i].map >= 0 ? 1U : 0U;
        switch (compareAt(collider, points[i], (samples)[i], kBorder * texel)) {
            case Agreement::kExact:
                break;
            case Agreement::kAtBorder:
                ++at_border;
                break;
            case Agreement::kNone:
                if (none++ < 5) {
                    const FieldSample cpu = evaluate(collider, points[i]);
                    ADD_FAILURE() << "point " << i << ": GPU " << (samples)[i].distance << " map "
                                  << (samples)[i].map << ", CPU " << cpu.distance << " map " << cpu.map
                                  << ", normals " << glm::length((samples)[i].normal - cpu.normal)
                                  << " apart";
                }
                break;
        }
    }
    EXPECT_EQ(none, 0U);
    EXPECT_GT(votes, points.size() / 8) << "the points hardly meet the maps: this would prove nothing";
    EXPECT_LE(static_cast<double>(at_border), border_share_max * static_cast<double>(points.size()));
    testing::Test::RecordProperty("at_border", static_cast<int>(at_border));
}

}  // namespace relief
