// SPDX-License-Identifier: Apache-2.0
// A small part of a plane, coloured by whether a collider classifies each point correctly.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "formats/base/result.h"

namespace relief {

enum class SideVerdict : std::uint8_t { kInside, kOutside, kFalseInside, kFalseOutside };

/// A square of samples perpendicular to an axis.
struct VerdictSlice {
    int axis = 2;
    /// The horizontal and vertical axes: (z, y) across x, (x, z) across y, (x, y) across z.
    int right = 0;
    int up = 1;
    glm::vec3 center{0.0F};             ///< the place of interest
    double side = 0.0;                  ///< length of a side, object units
    std::uint32_t size = 0;             ///< samples along a side
    std::vector<SideVerdict> verdicts;  ///< row by row from the bottom

    [[nodiscard]] glm::dvec3 point(std::uint32_t x, std::uint32_t y) const;
    [[nodiscard]] SideVerdict at(std::uint32_t x, std::uint32_t y) const {
        return verdicts[std::size_t{y} * size + x];
    }
};

/// Makes a slice through a place that cuts its surface: perpendicular to the axis with the smallest component of the
/// normal.
[[nodiscard]] VerdictSlice verdictSlice(const glm::vec3& center, const glm::vec3& normal, double side);

/// Draws a PNG: the verdicts, the true surface, a ring around the place, a scale and a legend. Equal slices give
/// identical bytes.
/// \param unit  of lengths: "m", or "" for object units
/// Errors: kFailure with Cairo's message.
[[nodiscard]] Result<std::vector<std::byte>> drawVerdicts(const VerdictSlice& slice, const std::string& unit);

}  // namespace relief
