// SPDX-License-Identifier: Apache-2.0
// The distance and normal of a patch map at a point, each with a bound of its rounding error.
// Evaluates the formulas of formats/patch_tree.cpp and shaders/engines/relief.glsl again in doubles. Every operation
// adds the error of one rounding to float, 2^-24 of its result, to the errors of its operands. The bound also holds if
// a multiply-add is fused, because that only omits a rounding. The transform to map space dominates: a rounding of a
// coordinate p is p / cell in leaf units, and the gradient of a patch of 5² heights changes within a quarter of that.
// If rounding may change a decision (cell, square of heights, patch of a pair), the result of either side is accepted.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <utility>
#include <vector>

#include "formats/collider.h"
#include "formats/patch_tree.h"

namespace relief::rounding {

/// A number and a bound of its float error.
struct Rounded {
    double value = 0.0;
    double error = 0.0;
    Rounded(double exact) : value(exact) {}  // NOLINT(google-explicit-constructor): an operand
    Rounded(double of, double off) : value(of), error(off) {}
};
/// \param roundings  in units of 2^-24.
inline Rounded rounded(double value, double error, double roundings = 1.0) {
    return {value, error + std::ldexp(roundings, -24) * (std::abs(value) + error)};
}
inline Rounded operator+(const Rounded& a, const Rounded& b) {
    return rounded(a.value + b.value, a.error + b.error);
}
inline Rounded operator-(const Rounded& a, const Rounded& b) {
    return rounded(a.value - b.value, a.error + b.error);
}
inline Rounded operator*(const Rounded& a, const Rounded& b) {
    return rounded(a.value * b.value,
                   std::abs(a.value) * b.error + std::abs(b.value) * a.error + a.error * b.error);
}
/// Multiplies by a power of two or −1, which is exact.
inline Rounded scaled(double factor, const Rounded& a) {
    return {factor * a.value, std::abs(factor) * a.error};
}
using RoundedVec = std::array<Rounded, 3>;
inline Rounded dot(const RoundedVec& a, const RoundedVec& b) {
    return a[0] * b[0] + (a[1] * b[1] + a[2] * b[2]);
}

struct RoundedVote {
    Rounded distance{0.0};
    RoundedVec normal{0.0, 0.0, 0.0};
};

/// \param q      in the leaf's unit cube.
/// \param aside  the point whose square of heights is used.
inline RoundedVote patchVote(PatchTexels texels, const PatchRecord& record, const RoundedVec& q,
                             const glm::dvec3& aside) {
    const PatchFrame frame{static_cast<std::uint8_t>(record.low >> 5U & 3U),
                           static_cast<std::uint8_t>(record.low >> 7U & 3U),
                           static_cast<std::uint8_t>(record.low >> 9U & 3U)};
    const auto mirror = [&](unsigned bit, const Rounded& x) {
        return (frame.mirrored & bit) != 0 ? Rounded(1.0) - x : x;
    };
    const std::size_t first = frame.first;
    const Rounded a = mirror(1, q[first]);
    const Rounded b = mirror(2, q[(first + 1) % 3]);
    const Rounded c = q[(first + 2) % 3];
    RoundedVec at{b, c, a};
    if (frame.diagonal != 0) {
        at[0] = scaled(0.5, a - b + 1.0);
        at[1] = frame.diagonal == 1 ? c : scaled(0.25, a + b - scaled(2.0, c) + 2.0);
        at[2] = frame.diagonal == 1 ? a + b : a + b + c;
    }
    const std::uint32_t side = record.side();
    const double last = side - 1.0;
    const glm::dvec3 place = last * frame.across(aside);
    const double column = std::clamp(std::floor(place.x), 0.0, last - 1.0);
    const double row = std::clamp(std::floor(place.y), 0.0, last - 1.0);
    const Rounded s = scaled(last, at[0]) - column;
    const Rounded t = scaled(last, at[1]) - row;
    const auto corner = static_cast<std::uint32_t>(row) * side + static_cast<std::uint32_t>(column);
    const auto code = [&](std::uint32_t i) {
        if (i == side * side - 1) {
            return static_cast<double>(record.low >> 23U & 0xffU);
        }
        const PatchRecord texel = side == 2 ? record : patchTexel(texels, record.first() + i / 8);
        return static_cast<double>((side == 2 || i % 8 > 3 ? texel.high : texel.low) >> 8U * (i % 4) & 0xffU);
    };
    const double c00 = code(corner), c10 = code(corner + 1);
    const double c01 = code(corner + side), c11 = code(corner + side + 1);
    PatchHeights heights;
    heights.base = static_cast<int>(record.low >> 11U & 0xfffU) - 2048;
    heights.scale = static_cast<std::uint8_t>(record.high >> 24U);
    const Rounded lower = c00 + s * (c10 - c00);
    const Rounded upper = c01 + s * (c11 - c01);
    const Rounded step = double{heights.step()};
    const Rounded height = double{heights.low()} + step * (lower + t * (upper - lower));
    const Rounded by_u = scaled(last, step) * ((c10 - c00) + t * ((c11 - c01) - (c10 - c00)));
    const Rounded by_v = scaled(last, step) * (upper - lower);
    RoundedVec by{1.0, scaled(-1.0, by_u), scaled(-1.0, by_v)};
    if (frame.diagonal != 0) {
        const Rounded v = frame.diagonal == 1 ? Rounded(0.0) : scaled(0.25, by_v);
        by = {1.0 - scaled(0.5, by_u) - v, 1.0 + scaled(0.5, by_u) - v,
              frame.diagonal == 1 ? scaled(-1.0, by_v) : 1.0 + scaled(0.5, by_v)};
    }
    by[0] = scaled((frame.mirrored & 1U) != 0 ? -1.0 : 1.0, by[0]);
    by[1] = scaled((frame.mirrored & 2U) != 0 ? -1.0 : 1.0, by[1]);
    RoundedVote vote;
    for (std::size_t i = 0; i < 3; ++i) {
        vote.normal[(first + i) % 3] = by[i];
    }
    const Rounded square = dot(vote.normal, vote.normal);
    const double inverse = 1.0 / std::sqrt(square.value);
    // GLSL: inversesqrt() is off by up to two ulp, four roundings.
    const Rounded per_length =
        rounded(inverse, 0.5 * inverse * square.error / (square.value - square.error), 4.0);
    const double sign = (record.low & 16U) != 0 ? -1.0 : 1.0;
    vote.distance = scaled(sign, (at[2] - height) * per_length);
    for (Rounded& along : vote.normal) {
        along = scaled(sign, along * per_length);
    }
    return vote;
}

/// The possible votes at p within rounding errors, in object units; the CPU's vote is first. Empty if no possible leaf
/// of p has patches.
inline std::vector<RoundedVote> patchVotes(const DepthMap& map, const glm::vec3& p) {
    const auto transformed = [&](const glm::vec4& r) {
        const auto term = [](float factor, float coordinate) {
            return Rounded(double{factor}) * Rounded(double{coordinate});
        };
        return term(r.x, p.x) + (term(r.y, p.y) + (term(r.z, p.z) + Rounded(double{r.w})));
    };
    const auto& rows = map.object_to_map.row;
    const RoundedVec in_map{transformed(rows[0]), transformed(rows[1]), transformed(rows[2])};
    const glm::vec3 cpu = map.object_to_map.apply(p);
    const glm::vec3 roots(patchTreeSize(map.texels).roots);
    const double root = double{map.object_per_map.x};
    std::vector<RoundedVote> votes;
    const auto add = [&](RoundedVote vote, double cell) {
        vote.distance = scaled(cell, vote.distance) * root;
        RoundedVec normal{0.0, 0.0, 0.0};
        for (int k = 0; k < 3; ++k) {
            // Two roundings for a column of the inverse, five for 1 / root (GLSL: 2.5 ulp), one for their product.
            const auto axis = [&](int i) { return rounded(double{rows[i][k]} * root, 0.0, 8.0); };
            normal[static_cast<std::size_t>(k)] = dot({axis(0), axis(1), axis(2)}, vote.normal);
        }
        votes.push_back({vote.distance, normal});
    };
    // The CPU's own point first.
    for (int k = 0; k < 27; ++k) {
        const std::array<int, 3> way{(k + 1) % 3 - 1, (k / 3 + 1) % 3 - 1, (k / 9 + 1) % 3 - 1};
        glm::vec3 at = cpu;
        bool within = true;
        for (int i = 0; i < 3; ++i) {
            const Rounded& exact = in_map[static_cast<std::size_t>(i)];
            const int to = way[static_cast<std::size_t>(i)];
            at[i] = to == 0 ? cpu[i] : static_cast<float>(exact.value + to * exact.error);
            within = within && at[i] >= 0.0F && at[i] < roots[i];
        }
        const PatchLeaf leaf = within ? patchLeafAt(map.texels, at) : PatchLeaf{};
        if (!within || leaf.record.kind() != PatchRecord::Kind::kPatch) {
            continue;
        }
        const double cell = double{leaf.cell};
        RoundedVec q{0.0, 0.0, 0.0};
        for (int i = 0; i < 3; ++i) {
            const Rounded& exact = in_map[static_cast<std::size_t>(i)];
            const double origin = double{at[i]} - cell * double{leaf.in_cell[i]};
            q[static_cast<std::size_t>(i)] = {(exact.value - origin) / cell, exact.error / cell};
        }
        const glm::dvec3 aside(leaf.in_cell);
        if (!leaf.record.isPair()) {
            add(patchVote(map.texels, leaf.record, q, aside), cell);
            continue;
        }
        const std::uint32_t first = leaf.record.first();
        RoundedVote a = patchVote(map.texels, patchTexel(map.texels, first), q, aside);
        RoundedVote b = patchVote(map.texels, patchTexel(map.texels, first + 1), q, aside);
        const bool both = (leaf.record.low & 16U) != 0;
        if ((both ? b.distance.value > a.distance.value : b.distance.value < a.distance.value)) {
            std::swap(a, b);
        }
        add(a, cell);
        if (std::abs(a.distance.value - b.distance.value) <= a.distance.error + b.distance.error) {
            add(b, cell);
        }
    }
    return votes;
}

inline bool isWithin(float number, const Rounded& bound) {
    return std::abs(double{number} - bound.value) <= bound.error;
}
inline bool isWithin(const FieldSample& sample, const RoundedVote& vote) {
    return isWithin(sample.distance, vote.distance) && isWithin(sample.normal.x, vote.normal[0]) &&
           isWithin(sample.normal.y, vote.normal[1]) && isWithin(sample.normal.z, vote.normal[2]);
}

}  // namespace relief::rounding
