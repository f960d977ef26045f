#include "runtime/depth_maps/depth_map_frame.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

namespace relief {
namespace {

bool isCube(const DepthMapFrame& frame) {
    return frame.format == MapFormat::kCube8;
}

}  // namespace

DepthMapFrame frameOf(const DepthMap& map) {
    DepthMapFrame frame;
    frame.format = map.format;
    frame.compare = map.compare;
    frame.decode = map.decode;
    frame.width = map.width;
    frame.height = map.height;
    // The rows are orthogonal, so that the columns of the inverse are the rows over their squared lengths.
    for (int k = 0; k < 3; ++k) {
        const glm::vec4& row = map.object_to_map.row[k];
        const glm::dvec3 direction(row.x, row.y, row.z);
        frame.axis[k] = direction / glm::dot(direction, direction);
        frame.origin -= double(row.w) * frame.axis[k];
    }
    frame.encloses = map.encloses;
    frame.starts_free[0] = isCube(frame) || map.encloses;
    frame.starts_free[1] = map.encloses;
    return frame;
}

std::uint32_t faceCount(const DepthMapFrame& frame) {
    return isCube(frame) ? 6 : 1;
}

Result<void> checkFrame(const DepthMapFrame& frame) {
    const std::uint32_t least = isCube(frame) ? 1 : kMapSizeMin;
    if (std::min(frame.width, frame.height) < least || std::max(frame.width, frame.height) > kMapSizeMax ||
        (isCube(frame) && frame.width != frame.height)) {
        return fail(ErrorCode::kUsage,
                    "a depth map of " + std::to_string(frame.width) + " x " + std::to_string(frame.height) +
                        " texels cannot be rendered; take " + std::to_string(least) + " to " +
                        std::to_string(kMapSizeMax) + " along a side, a cube as wide as high");
    }
    if (frame.compare == Compare::kGap) {
        return fail(ErrorCode::kUsage,
                    "a map of gaps cannot be rendered, which shows the outer surfaces alone; bake it");
    }
    if ((frame.compare == Compare::kBoth) != isFrontBack(frame.format)) {
        return fail(ErrorCode::kUsage, std::string("a depth map of format ") + mapFormatName(frame.format) +
                                           " cannot keep " + compareName(frame.compare) +
                                           "; front-back maps, and only those, keep both surfaces");
    }
    for (int k = 0; k < 3; ++k) {
        const glm::dvec3 row = frame.axis[k] / glm::dot(frame.axis[k], frame.axis[k]);
        const glm::vec3 direction(row);
        const double length = glm::length(frame.axis[k]);
        if (!(std::isfinite(direction.x) && std::isfinite(direction.y) && std::isfinite(direction.z)) ||
            !std::isfinite(static_cast<float>(glm::dot(row, frame.origin))) ||
            !(static_cast<float>(length) > 0.0F) || !std::isfinite(static_cast<float>(length))) {
            return fail(
                ErrorCode::kUsage,
                "a depth map has an axis " + std::to_string(k) +
                    " that floats cannot hold; its axes must have a length, and its origin be finite");
        }
    }
    return {};
}

}  // namespace relief
