// SPDX-License-Identifier: Apache-2.0
// PNG and PLY bytes, read back by libpng or checked by hand against the format's definition.
#include <gtest/gtest.h>

#include <string>

#include "runtime/files/ply.h"
#include "runtime/files/png.h"
#include "tests/results.h"

namespace relief {
namespace {

TEST(Png, RejectsWrongSizes) {
    const std::vector<std::uint8_t> rgb(12);
    for (const auto& [width, height] :
         {std::pair{0U, 4U}, {4U, 0U}, {2U, 3U}, {70000U, 1U}, {0xffffffffU, 0xffffffffU}}) {
        expectError(encodePng(rgb, width, height), ErrorCode::kUsage);
    }
    EXPECT_TRUE(encodePng(rgb, 2, 2));
}

TEST(Png, LibpngReadsTheFileBack) {
    constexpr std::uint32_t kWidth = 37;
    constexpr std::uint32_t kHeight = 11;
    std::vector<std::uint8_t> rgb;
    std::vector<std::uint8_t> rgba;
    for (std::size_t i = 0; i < std::size_t{3} * kWidth * kHeight; ++i) {
        rgba.push_back(rgb.emplace_back(static_cast<std::uint8_t>(i * 7 + i / 256)));
        if (i % 3 == 2) {
            rgba.push_back(255);
        }
    }
    const std::vector<std::byte> bytes = encodePng(rgb, kWidth, kHeight).value();
    EXPECT_EQ(*encodePng(rgb, kWidth, kHeight), bytes) << "the same pixels must give the same bytes";
    const auto picture = required(decodePng(bytes, "'a.png'"));
    EXPECT_EQ(picture.width, kWidth);
    EXPECT_EQ(picture.rgba, rgba);
    for (std::size_t i = 0; i + 13 < bytes.size(); ++i) {  // only the end mark may be missing
        expectError(decodePng(std::span(bytes).first(i), "'a.png'"), ErrorCode::kInvalidInput);
    }
    const std::vector<std::uint8_t> row(std::size_t{3} * (kPngReadSideMax + 1));
    EXPECT_EQ(decodePng(*encodePng(row, kPngReadSideMax + 1, 1), "'a.png'").error().code, ErrorCode::kLimit);
}

TEST(Ply, HeaderAndVerticesMatchTheFormat) {
    std::vector<ParticleState> particles(2);
    particles[0] = {.id = 0x01020304,
                    .position = {1.0F, -2.0F, 0.5F},
                    .velocity = {4.0F, 5.0F, 6.0F},
                    .age = 0.25F,
                    .lifetime = 8.0F,
                    .type = 0x0a0b0c};
    particles[1].id = 3;  // lower: comes first
    const auto ply = [](const std::vector<ParticleState>& states) {
        const std::vector<std::byte> bytes = encodePly(states);
        return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    };
    const std::string text = ply(particles);
    const std::string head =
        "ply\nformat binary_little_endian 1.0\ncomment particles of relief-sim; object units, seconds\n"
        "element vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty float vx\n"
        "property float vy\nproperty float vz\nproperty float age\nproperty float lifetime\nproperty uint "
        "id\nproperty uint type\nend_header\n";
    ASSERT_EQ(text.size(), head.size() + 2 * 40);
    EXPECT_EQ(text.substr(0, head.size()), head);
    EXPECT_EQ(text[head.size() + 32], 3);
    // Little-endian: 1.0F is 3f 80 00 00.
    EXPECT_EQ(text.substr(head.size() + 40, 4), std::string("\0\0\x80\x3f", 4));
    EXPECT_EQ(text.substr(head.size() + 72), std::string("\4\3\2\1\x0c\x0b\x0a\0", 8));
    EXPECT_TRUE(ply({}).ends_with("end_header\n")) << "a file without particles is valid";
}

}  // namespace
}  // namespace relief
