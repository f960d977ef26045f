// SPDX-License-Identifier: Apache-2.0
// The combined field of a collider on a plane across an axis.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/images/axis_grid.h"
#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

inline constexpr std::uint32_t kSliceSizeMax = 8192;  ///< samples along the longer side

struct SliceOptions {
    int axis = 2;              ///< 0, 1, 2: the plane is across x, y, z
    std::optional<float> at;   ///< object units along the axis; nullopt: the middle of the bounds
    std::uint32_t size = 512;  ///< samples along the longer side
};

/// Samples on a regular grid that covers the bounds and a tenth of their longer side around them.
/// The axes run to the right and upwards: (z, y) across x, (x, z) across y, (x, y) across z.
struct Slice : AxisGrid {
    float at = 0.0F;                     ///< object units
    std::vector<FieldSample> samples{};  ///< row by row from the lowest

    [[nodiscard]] glm::vec3 point(std::uint32_t x, std::uint32_t y) const {
        return AxisGrid::point(x, y, at);
    }
    [[nodiscard]] const FieldSample& sample(std::uint32_t x, std::uint32_t y) const {
        return samples[std::size_t{y} * width + x];
    }
};

/// Errors: kUsage and kLimit (size), kInvalidInput (bounds too large for floats).
[[nodiscard]] Result<Slice> evaluateSlice(const Collider& collider, const SliceOptions& options);

struct SliceFigureOptions {
    std::string name;  ///< of the collider, for the title
    std::string unit;  ///< of lengths: "m", or "" for object units
};

/// A PNG: the signed distance in false colours, the surface, a colour bar and a legend. The same slice gives the same
/// bytes. Errors: kFailure with Cairo's message.
[[nodiscard]] Result<std::vector<std::byte>> drawSlice(const Slice& slice, const SliceFigureOptions& options);

/// The signed distances in the channel "distance": +inf where only the side is known (outside), NaN where no map votes. Axes
/// and extent are the figure's.
[[nodiscard]] ExrImage distanceImage(const Slice& slice, const Collider& collider);

[[nodiscard]] constexpr char axisName(int axis) {
    return "xyz"[axis];
}

}  // namespace relief
