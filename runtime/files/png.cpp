#include "runtime/files/png.h"

#include <png.h>

#include <exception>
#include <string>

namespace relief {
namespace {

constexpr std::uint32_t kSideMax = 65535;
constexpr int kCompressionLevel = 6;

struct ErrorText {
    std::string text;
};

// libpng must not return from its error function; it jumps back to writeAll, over C frames alone.
[[noreturn]] void onError(png_structp png, png_const_charp message) {
    static_cast<ErrorText*>(png_get_error_ptr(png))->text = message;
    png_longjmp(png, 1);
}

void onWarning(png_structp /*png*/, png_const_charp /*message*/) {}

void onWrite(png_structp png, png_bytep data, png_size_t size) {
    bool held = false;
    try {
        auto& out = *static_cast<std::vector<std::byte>*>(png_get_io_ptr(png));
        const auto* bytes = reinterpret_cast<const std::byte*>(data);
        out.insert(out.end(), bytes, bytes + size);
        held = true;
    } catch (const std::exception&) {
        held = false;  // reported below: an exception must not pass through libpng
    }
    if (!held) {
        png_error(png, "out of memory");
    }
}

void onFlush(png_structp /*png*/) {}

/// Everything between setjmp and a possible longjmp, without objects that have destructors.
bool writeAll(png_structp png, png_infop info, const std::uint8_t* rgb, std::uint32_t width,
              std::uint32_t height) {
    if (setjmp(png_jmpbuf(png)) != 0) {
        return false;
    }
    png_set_IHDR(png, info, width, height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_compression_level(png, kCompressionLevel);
    png_write_info(png, info);
    for (std::uint32_t y = 0; y < height; ++y) {
        png_write_row(png, rgb + std::size_t{3} * width * y);
    }
    png_write_end(png, nullptr);
    return true;
}

}  // namespace

Result<std::vector<std::byte>> encodePng(std::span<const std::uint8_t> rgb, std::uint32_t width,
                                         std::uint32_t height) {
    if (width == 0 || height == 0 || width > kSideMax || height > kSideMax ||
        rgb.size() != std::size_t{3} * width * height) {
        return fail(ErrorCode::kUsage, "a picture of " + std::to_string(width) + "x" +
                                           std::to_string(height) + " pixels cannot be written as PNG from " +
                                           std::to_string(rgb.size()) + " bytes; sides go from 1 to " +
                                           std::to_string(kSideMax));
    }
    std::vector<std::byte> out;
    out.reserve(rgb.size() / 2);
    ErrorText error;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &error, onError, onWarning);
    png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
    bool written = false;
    if (info != nullptr) {
        png_set_write_fn(png, &out, onWrite, onFlush);
        written = writeAll(png, info, rgb.data(), width, height);
    }
    png_destroy_write_struct(&png, &info);
    if (!written) {
        return fail(ErrorCode::kFailure,
                    "the picture cannot be encoded as PNG: " +
                        (error.text.empty() ? std::string("out of memory") : error.text));
    }
    return out;
}

}  // namespace relief
