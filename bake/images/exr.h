// SPDX-License-Identifier: Apache-2.0
// Writes images of floats as OpenEXR files. Besides exr.cpp, only bake/import uses OpenEXR, to read heights.
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
    struct Channel {
        std::string name;           ///< "Z", "N.X", …
        std::vector<float> values;  ///< width · height, row by row from the top
    };
    std::uint32_t width = 0;  ///< pixels
    std::uint32_t height = 0;
    std::vector<Channel> channels;
    std::vector<std::pair<std::string, std::string>> attributes;  ///< string attributes: name and text
    /// For column vectors, as in glm: camera = world_to_camera · (p, 1). Stored transposed in OpenEXR.
    std::optional<glm::dmat4> world_to_camera;
    std::optional<glm::dmat4> world_to_ndc;

    /// Sets the camera. Camera space is that of OpenEXR and RenderMan: left-handed, x right, y up, z into the image,
    /// object units. NDC is (0, 0) and (1, 1) at the upper left and lower right corners of the image.
    /// \param x, y, z  rows that map object space to [0, 1] across the image, upwards, and from near to far.
    /// \param scale     the extents of the image in object units: width, height and depth.
    void setOrthographicCamera(const glm::dvec4& x, const glm::dvec4& y, const glm::dvec4& z,
                               const glm::dvec3& scale);
};

/// Encodes a ZIP-compressed scanline file of 32-bit floats, without a date.
/// Errors: kFailure with OpenEXR's message, kLimit (out of memory).
[[nodiscard]] Result<std::vector<std::byte>> encodeExr(const ExrImage& image);

}  // namespace relief
