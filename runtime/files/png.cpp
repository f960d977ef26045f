// SPDX-License-Identifier: Apache-2.0
#include "runtime/files/png.h"

#include <png.h>

#include <algorithm>
#include <string>

namespace relief {

Result<std::vector<std::byte>> encodePng(std::span<const std::uint8_t> rgb, std::uint32_t width,
                                         std::uint32_t height) {
    constexpr std::uint32_t kSideMax = 65535;
    if (width == 0 || height == 0 || width > kSideMax || height > kSideMax ||
        rgb.size() != std::size_t{3} * width * height) {
        return fail(ErrorCode::kUsage, "a picture of " + std::to_string(width) + "x" +
                                           std::to_string(height) + " pixels cannot be written as PNG from " +
                                           std::to_string(rgb.size()) + " bytes; sides must be 1 to " +
                                           std::to_string(kSideMax));
    }
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = width;
    image.height = height;
    image.format = PNG_FORMAT_RGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::vector<std::byte> out(size);
    if (png_image_write_to_memory(&image, out.data(), &size, 0, rgb.data(), 0, nullptr) == 0) {
        return fail(ErrorCode::kFailure,
                    "the picture cannot be encoded as PNG: " + std::string(image.message));
    }
    out.resize(size);
    return out;
}

Result<RgbaPicture> decodePng(std::span<const std::byte> bytes, std::string_view name) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) {
        return fail(ErrorCode::kInvalidInput, std::string(name) + " cannot be read as PNG: " + image.message);
    }
    const std::uint32_t side = std::max(image.width, image.height);
    if (side > kPngReadSideMax) {
        png_image_free(&image);
        return fail(ErrorCode::kLimit, std::string(name) + " has a side of " + std::to_string(side) +
                                           " pixels; the maximum is " + std::to_string(kPngReadSideMax));
    }
    RgbaPicture picture;
    picture.width = image.width;
    picture.height = image.height;
    image.format = PNG_FORMAT_RGBA;
    picture.rgba.resize(PNG_IMAGE_SIZE(image));
    // Always frees the image.
    if (png_image_finish_read(&image, nullptr, picture.rgba.data(), 0, nullptr) == 0) {
        return fail(ErrorCode::kInvalidInput, std::string(name) + " cannot be read as PNG: " + image.message);
    }
    return picture;
}

}  // namespace relief
