// SPDX-License-Identifier: Apache-2.0
// The PNG reader of the web build against libpng.
#include <gtest/gtest.h>
#include <png.h>

#include <random>

#include "runtime/files/png.h"
#include "tests/results.h"

namespace relief {

/// The function of runtime/web/png_web.cpp, renamed to coexist with the libpng version.
Result<RgbaPicture> decodePngWeb(std::span<const std::byte> bytes, std::string_view name);

namespace {

constexpr std::uint32_t kWidth = 61;
constexpr std::uint32_t kHeight = 43;

/// Smooth samples, so that every filter is used, with some noise.
std::vector<std::uint8_t> samples(std::size_t bytes) {
    std::mt19937 random(7);
    std::vector<std::uint8_t> out(bytes);
    for (std::size_t i = 0; i < bytes; ++i) {
        out[i] = static_cast<std::uint8_t>(i / 5 + i / 301 * 3 + random() % 4);
    }
    return out;
}

/// Encoded by libpng.
/// \param format  PNG_FORMAT_…
std::vector<std::byte> encoded(png_uint_32 format) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = kWidth;
    image.height = kHeight;
    image.format = format;
    image.colormap_entries = 16;
    std::vector<std::uint8_t> pixels = samples(PNG_IMAGE_SIZE(image));
    if ((format & PNG_FORMAT_FLAG_COLORMAP) != 0) {
        for (std::uint8_t& index : pixels) {
            index &= 15;
        }
    }
    const std::vector<std::uint8_t> colors = samples(PNG_IMAGE_COLORMAP_SIZE(image));
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image) + 1000;
    std::vector<std::byte> out(size);
    EXPECT_NE(png_image_write_to_memory(&image, out.data(), &size, 0, pixels.data(), 0, colors.data()), 0)
        << image.message;
    out.resize(size);
    return out;
}

class PngWeb : public testing::TestWithParam<png_uint_32> {};

TEST_P(PngWeb, MatchesLibpng) {
    const std::vector<std::byte> bytes = encoded(GetParam());
    const auto web = required(decodePngWeb(bytes, "a.png"));
    EXPECT_EQ(web.width, kWidth);
    EXPECT_EQ(web.height, kHeight);
    EXPECT_EQ(web.rgba, required(decodePng(bytes, "a.png")).rgba);
}

TEST_P(PngWeb, SurvivesDamage) {
    const std::vector<std::byte> good = encoded(GetParam());
    std::mt19937 random(3);
    std::size_t refused = 0;
    for (int i = 0; i < 1000; ++i) {
        std::vector<std::byte> bytes = good;
        for (int k = 0; k < 3; ++k) {
            bytes[random() % bytes.size()] = static_cast<std::byte>(random());
        }
        if (i % 4 == 0) {
            bytes.resize(random() % bytes.size());
        }
        const auto picture = decodePngWeb(bytes, "a.png");
        refused += picture ? 0 : 1;
        if (picture) {
            EXPECT_EQ(picture->rgba.size(), std::size_t{4} * picture->width * picture->height);
        } else {
            EXPECT_TRUE(picture.error().message.starts_with("a.png ")) << picture.error().message;
        }
    }
    EXPECT_GT(refused, 250U);
}

INSTANTIATE_TEST_SUITE_P(Formats, PngWeb,
                         testing::Values(PNG_FORMAT_GRAY, PNG_FORMAT_GA, PNG_FORMAT_RGB, PNG_FORMAT_RGBA,
                                         PNG_FORMAT_RGB_COLORMAP, PNG_FORMAT_RGBA_COLORMAP));

TEST(PngWeb, RejectsIncompletePngs) {
    std::vector<std::byte> bytes = encoded(PNG_FORMAT_RGB);
    EXPECT_FALSE(decodePngWeb({}, "a.png"));
    EXPECT_FALSE(decodePngWeb(std::span(bytes).first(50), "a.png"));
    bytes[17] = std::byte{1};  // wider than any picture
    EXPECT_FALSE(decodePngWeb(bytes, "a.png"));
}

}  // namespace
}  // namespace relief
