// SPDX-License-Identifier: Apache-2.0
// The combined field of a collider on a plane across an axis.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

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
struct Slice {
    int axis = 2;
    /// The axes that run to the right and upwards: (z, y) across x, (x, z) across y, (x, y) across z.
    int right = 0;
    int up = 1;
    float at = 0.0F;          ///< object units
    std::uint32_t width = 0;  ///< samples
    std::uint32_t height = 0;
    glm::dvec2 corner{0.0};  ///< lower left corner of the area, half a sample before the first sample
    double spacing = 1.0;    ///< object units between samples
    std::vector<FieldSample> samples;  ///< row by row from the lowest

    [[nodiscard]] glm::vec3 point(std::uint32_t x, std::uint32_t y) const;
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

[[nodiscard]] constexpr char axisName(int axis) {
    return "xyz"[axis];
}

}  // namespace relief
