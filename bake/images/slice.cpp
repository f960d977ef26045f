// SPDX-License-Identifier: Apache-2.0
#include "bake/images/slice.h"

#include <tbb/parallel_for.h>

#include <limits>
#include <string>

#include "formats/base/text.h"

namespace relief {
namespace {

constexpr double kMargin = 0.1;  // around the bounds, in units of their longer side in the plane

}  // namespace

Result<Slice> evaluateSlice(const Collider& collider, const SliceOptions& options) {
    if (options.size < 2) {
        return fail(ErrorCode::kUsage,
                    "--size is " + std::to_string(options.size) + " but must be at least 2");
    }
    if (options.size > kSliceSizeMax) {
        return fail(ErrorCode::kLimit, "--size is " + std::to_string(options.size) + "; the limit is " +
                                           std::to_string(kSliceSizeMax));
    }
    // The axes of these views match those of the image.
    const int view = options.axis == 2 ? 5 : 2 * options.axis;
    Slice slice{RELIEF_TRY(gridAcross(collider.bounds, view, options.size, kMargin))};
    slice.at = options.at.value_or(collider.bounds.center()[options.axis]);
    slice.samples.resize(std::size_t{slice.width} * slice.height);
    tbb::parallel_for(std::uint32_t{0}, slice.height, [&](std::uint32_t y) {
        for (std::uint32_t x = 0; x < slice.width; ++x) {
            slice.samples[std::size_t{y} * slice.width + x] = evaluate(collider, slice.point(x, y));
        }
    });
    return slice;
}

ExrImage distanceImage(const Slice& slice, const Collider& collider) {
    ExrImage image = slice.image(slice.at, collider, {"distance"});
    image.attributes.emplace_back("relief.plane", axisName(slice.axis()) + (" = " + shortest(slice.at)));
    image.attributes.emplace_back(
        "relief.distance",
        "object units, negative inside; +inf: outside, no distance known; NaN: no map votes");
    for (std::uint32_t y = 0; y < slice.height; ++y) {
        for (std::uint32_t x = 0; x < slice.width; ++x) {
            const FieldSample& sample = slice.sample(x, y);
            image.channels[0].values[slice.pixel(x, y)] =
                sample.map < 0                  ? std::numeric_limits<float>::quiet_NaN()
                : sample.distance < kFarOutside ? sample.distance
                                                : std::numeric_limits<float>::infinity();
        }
    }
    return image;
}

}  // namespace relief
