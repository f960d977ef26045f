// A slice as a figure, like figure 6 of the paper; the only user of Cairo.
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

/// A PNG: inside and outside on the left, the signed distance in false colours with isolines on the right, the zero contour on
/// both, a colour bar and a legend. The same slice gives the same bytes. Errors: kFailure with Cairo's message.
[[nodiscard]] Result<std::vector<std::byte>> drawSlice(const Slice& slice, const SliceFigureOptions& options);

}  // namespace relief
