// SPDX-License-Identifier: Apache-2.0
// Draws planes through a collider as figures: the field of all its maps together, or whether the collider classifies
// the points around a place correctly.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bake/images/axis_grid.h"
#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

inline constexpr std::uint32_t kSliceSizeMax = 8192;  ///< samples along the longer side

struct SliceOptions {
    int axis = 2;              ///< 0, 1, 2: the plane is perpendicular to x, y, z
    std::optional<float> at;   ///< object units along the axis; nullopt: the middle of the bounds
    std::uint32_t size = 512;  ///< samples along the longer side
};

/// Samples on a regular grid that covers the bounds, with a margin of a tenth of their longer side all around. The
/// horizontal and vertical axes are (z, y) for axis x, (x, z) for axis y, and (x, y) for axis z.
struct Slice : AxisGrid {
    float at = 0.0F;                     ///< object units
    std::vector<FieldSample> samples{};  ///< row by row from the bottom

    [[nodiscard]] glm::vec3 point(std::uint32_t x, std::uint32_t y) const {
        return AxisGrid::point(x, y, at);
    }
    [[nodiscard]] const FieldSample& sample(std::uint32_t x, std::uint32_t y) const {
        return samples[std::size_t{y} * width + x];
    }
};

/// Evaluates the field on a plane. Errors: kUsage and kLimit (size), kInvalidInput (bounds too large for floats).
[[nodiscard]] Result<Slice> evaluateSlice(const Collider& collider, const SliceOptions& options);

struct SliceFigureOptions {
    std::string name;  ///< of the collider, for the title
    std::string unit;  ///< of lengths: "m", or "" for object units
};

/// Draws a PNG: the signed distance in false colours, the surface, a colour bar and a legend. Equal slices give
/// identical bytes. Errors: kFailure with Cairo's message.
[[nodiscard]] Result<std::vector<std::byte>> drawSlice(const Slice& slice, const SliceFigureOptions& options);

/// Returns the signed distances in the channel "distance": +inf where only the side is known (outside), NaN where no
/// map votes. The axes and the extent match drawSlice().
[[nodiscard]] ExrImage distanceImage(const Slice& slice, const Collider& collider);

[[nodiscard]] constexpr char axisName(int axis) {
    return "xyz"[axis];
}

enum class SideVerdict : std::uint8_t { kInside, kOutside, kFalseInside, kFalseOutside };

/// A square of samples perpendicular to an axis, coloured by whether a collider classifies each point correctly.
struct VerdictSlice {
    int axis = 2;
    /// The horizontal and vertical axes: (z, y) for axis x, (x, z) for axis y, (x, y) for axis z.
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

/// Makes a slice through `center` that cuts the surface: perpendicular to the axis with the smallest component of
/// `normal`.
[[nodiscard]] VerdictSlice verdictSlice(const glm::vec3& center, const glm::vec3& normal, double side);

/// Draws a PNG: the verdicts, the true surface, a ring around the place, a scale and a legend. Equal slices give
/// identical bytes.
/// \param unit  of lengths: "m", or "" for object units
/// Errors: kFailure with Cairo's message.
[[nodiscard]] Result<std::vector<std::byte>> drawVerdicts(const VerdictSlice& slice, const std::string& unit);

}  // namespace relief
