// SPDX-License-Identifier: Apache-2.0
// Compares the GPU's samples at many points with the CPU's.
// Tolerance: both sides evaluate the same formulas in floats, but in different orders. The shader's rows are in texels,
// and it divides by a normal's length last. A GL may fuse or reorder operations, and its square roots and divisions may
// be off by a few ulp. So distances may differ by kRelative of the scale of the map's volume, and normals by kNormal. A
// point within kBorder texels of a texel's edge may fall into the neighbour. It agrees if it matches the CPU's sample
// at one of the surrounding points kBorder texels away; such points are counted.
// The normal of a patch changes along it. On a curved patch, rounding of the point changes it by more than kNormal. A
// GPU that fuses multiply-adds rounds the point differently, so its patch samples may also differ by the bound of
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

/// The possible votes, within rounding errors, of the patch map that decided on the GPU; none if that map has no patches.
inline std::vector<rounding::RoundedVote> possibleVotes(const Collider& collider, const glm::vec3& p,
                                                        const FieldSample& gpu) {
    if (gpu.map < 0 || isSoftwareRenderer()) {
        return {};
    }
    const DepthMap& map = collider.maps[static_cast<std::size_t>(gpu.map)];
    return map.format == MapFormat::kPatches ? rounding::patchVotes(map, p)
                                             : std::vector<rounding::RoundedVote>{};
}

/// The vote of one map of a collider.
inline FieldSample evaluateMap(const Collider& collider, const glm::vec3& p, int map) {
    Collider single;
    single.bounds = collider.bounds;
    single.maps.push_back(collider.maps[static_cast<std::size_t>(map)]);
    FieldSample own = evaluate(single, p);
    own.map = own.map < 0 ? own.map : map;
    return own;
}

/// True if two maps vote equally at p, up to rounding, and the GPU returned the sample of the map that the CPU did not
/// choose.
inline bool tied(const Collider& collider, const glm::vec3& p, const FieldSample& gpu,
                 const rounding::RoundedVote* vote) {
    const FieldSample cpu = evaluate(collider, p);
    const double apart = vote != nullptr ? vote->distance.error : 0.0;
    if (cpu.map < 0 || gpu.map < 0 ||
        std::abs(double{cpu.distance} - double{gpu.distance}) > double{kRelative} * 2.0 + apart) {
        return false;
    }
    return vote != nullptr || agrees(gpu, evaluateMap(collider, p, gpu.map));
}

/// Point k of the 27 points of a cube of side 2 around the origin.
inline glm::vec3 neighbour(int k) {
    return {static_cast<float>(k % 3 - 1), static_cast<float>(k / 3 % 3 - 1), static_cast<float>(k / 9 - 1)};
}

/// Whether the GPU agrees with the CPU's sample at p, or at one of the 26 neighbours `step` away, where ties count as
/// well.
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
    const bool own_vote = gpu.map >= 0 && agrees(gpu, evaluateMap(collider, p, gpu.map));
    for (int k = 0; k < 27; ++k) {
        const FieldSample near = evaluate(collider, p + step * neighbour(k));
        // The GPU's map decides at the neighbour, and the sample matches that map at p or at the neighbour.
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
                            double border_fraction_max) {
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
    EXPECT_GT(votes, points.size() / 8) << "too few points get votes: the test proves nothing";
    EXPECT_LE(static_cast<double>(at_border), border_fraction_max * static_cast<double>(points.size()));
    testing::Test::RecordProperty("at_border", static_cast<int>(at_border));
}

}  // namespace relief
