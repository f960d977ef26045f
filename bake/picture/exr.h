// Float images as OpenEXR files. The only file that knows OpenEXR.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats/base/result.h"

namespace relief {

struct FloatImage {
    struct Channel {
        std::string name;           ///< "Z", "N.X", …
        std::vector<float> values;  ///< width · height, row by row from the image's top
    };
    std::uint32_t width = 0;  ///< pixels
    std::uint32_t height = 0;
    std::vector<Channel> channels;
    /// Names and texts of string attributes.
    std::vector<std::pair<std::string, std::string>> attributes;
    /// Column vectors, as glm has it: camera = world_to_camera · (p, 1). Written transposed, as OpenEXR has
    /// it.
    std::optional<glm::dmat4> world_to_camera;
    std::optional<glm::dmat4> world_to_ndc;
};

/// A scanline file, ZIP-compressed, 32-bit float channels. The same image gives the same bytes: no date.
/// Errors: kFailure with OpenEXR's words, kLimit when out of memory.
[[nodiscard]] Result<std::vector<std::byte>> encodeExr(const FloatImage& image);

}  // namespace relief
