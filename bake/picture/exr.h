// SPDX-License-Identifier: Apache-2.0
// Images of floats and of words as OpenEXR files, written; bake/import reads those of heights. The only users of OpenEXR.
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

struct ExrImage {
    template <class Value>
    struct ChannelOf {
        std::string name;           ///< "Z", "N.X", …
        std::vector<Value> values;  ///< width · height, row by row from the image's top
    };
    using Channel = ChannelOf<float>;
    std::uint32_t width = 0;  ///< pixels
    std::uint32_t height = 0;
    std::vector<Channel> channels;
    std::vector<ChannelOf<std::uint32_t>> words;                  ///< channels of whole numbers
    std::vector<std::pair<std::string, std::string>> attributes;  ///< string attributes: name and text
    /// For column vectors, as in glm: camera = world_to_camera · (p, 1). Written transposed, as in OpenEXR.
    std::optional<glm::dmat4> world_to_camera;
    std::optional<glm::dmat4> world_to_ndc;
};

/// A ZIP-compressed scanline file of channels of 32 bits, without a date. Errors: kFailure with OpenEXR's message, kLimit
/// (out of memory).
[[nodiscard]] Result<std::vector<std::byte>> encodeExr(const ExrImage& image);

}  // namespace relief
