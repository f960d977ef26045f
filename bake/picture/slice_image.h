// A slice as a figure for people: figure 6 of the paper. The only file that knows Cairo.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bake/picture/slice.h"
#include "formats/base/result.h"

namespace relief {

struct SliceFigureOptions {
    std::string name;  ///< of the collider, for the title
    std::string unit;  ///< of lengths: "m", or "" for object units
};

/// A PNG: on the left inside and outside, on the right the signed distance in false colours with isolines, a
/// colour bar and a legend; the zero contour on both. The same slice gives the same bytes.
/// Errors: kFailure with Cairo's words.
[[nodiscard]] Result<std::vector<std::byte>> drawSlice(const Slice& slice, const SliceFigureOptions& options);

}  // namespace relief
