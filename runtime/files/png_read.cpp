#include <png.h>

#include <algorithm>
#include <string>

#include "runtime/files/png.h"

namespace relief {

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
                                           " pixels; " + std::to_string(kPngReadSideMax) + " are the most");
    }
    RgbaPicture picture;
    picture.width = image.width;
    picture.height = image.height;
    image.format = PNG_FORMAT_RGBA;
    picture.rgba.resize(PNG_IMAGE_SIZE(image));
    // Frees the image, whether it succeeds or not.
    if (png_image_finish_read(&image, nullptr, picture.rgba.data(), 0, nullptr) == 0) {
        return fail(ErrorCode::kInvalidInput, std::string(name) + " cannot be read as PNG: " + image.message);
    }
    return picture;
}

}  // namespace relief
