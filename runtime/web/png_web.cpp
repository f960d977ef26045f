// SPDX-License-Identifier: Apache-2.0
// Decodes PNG in browsers with stb_image; libpng is not packaged for WebAssembly.
#include "runtime/files/png.h"

#include <algorithm>
#include <memory>
#include <string>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STBI_NO_THREAD_LOCALS
#define STBI_MAX_DIMENSIONS 8192
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb/stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace relief {

static_assert(STBI_MAX_DIMENSIONS == kPngReadSideMax);

Result<RgbaPicture> decodePng(std::span<const std::byte> bytes, std::string_view name) {
    const auto* const data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = static_cast<int>(std::min<std::size_t>(bytes.size(), 1U << 30));
    int width = 0;
    int height = 0;
    int channels = 0;
    if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0) {
        return invalidInput(std::string(name) +
                            " cannot be read as PNG: not a PNG, damaged, or larger than " +
                            std::to_string(kPngReadSideMax) + " pixels per side");
    }
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(data, size, &width, &height, &channels, STBI_rgb_alpha), stbi_image_free);
    if (pixels == nullptr) {
        return invalidInput(std::string(name) + " cannot be read as PNG: damaged or truncated");
    }
    RgbaPicture picture{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
    picture.rgba.assign(pixels.get(), pixels.get() + std::size_t{4} * picture.width * picture.height);
    return picture;
}

}  // namespace relief
