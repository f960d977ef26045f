// PNG and PLY bytes: read back by libpng, or by hand from the format's definition.
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "runtime/files/ply.h"
#include "runtime/files/png.h"

namespace relief {
namespace {

TEST(Png, RefusesSizesThatDoNotFit) {
    const std::vector<std::uint8_t> rgb(12);
    for (const auto& [width, height] :
         {std::pair{0U, 4U}, {4U, 0U}, {2U, 3U}, {70000U, 1U}, {0xffffffffU, 0xffffffffU}}) {
        const auto bytes = encodePng(rgb, width, height);
        ASSERT_FALSE(bytes);
        EXPECT_EQ(bytes.error().code, ErrorCode::kUsage);
    }
    EXPECT_TRUE(encodePng(rgb, 2, 2));
}

TEST(Png, LibpngReadsBackWhatWasWritten) {
    constexpr std::uint32_t kWidth = 37;
    constexpr std::uint32_t kHeight = 11;
    std::vector<std::uint8_t> rgb(3 * kWidth * kHeight);
    for (std::size_t i = 0; i < rgb.size(); ++i) {
        rgb[i] = static_cast<std::uint8_t>(i * 7 + i / 256);
    }
    const std::vector<std::byte> bytes = encodePng(rgb, kWidth, kHeight).value();
    EXPECT_EQ(*encodePng(rgb, kWidth, kHeight), bytes) << "the same pixels must give the same bytes";
    const auto picture = decodePng(bytes, "'a.png'");
    ASSERT_TRUE(picture) << picture.error().message;
    EXPECT_EQ(picture->width, kWidth);
    EXPECT_EQ(picture->height, kHeight);
    ASSERT_EQ(picture->rgba.size(), 4 * kWidth * kHeight);
    for (std::size_t i = 0; i < rgb.size(); ++i) {
        EXPECT_EQ(picture->rgba[4 * (i / 3) + i % 3], rgb[i]);
        EXPECT_EQ(picture->rgba[4 * (i / 3) + 3], 255U);
    }
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        if (const auto cut = decodePng(std::span(bytes).first(i), "'a.png'"); !cut) {
            EXPECT_EQ(cut.error().code, ErrorCode::kInvalidInput);
            EXPECT_NE(cut.error().message.find("'a.png'"), std::string::npos);
        } else {
            EXPECT_GT(i, bytes.size() - 13) << "only the end mark may be missing";
        }
    }
    const std::vector<std::uint8_t> row(std::size_t{3} * (kPngReadSideMax + 1));
    EXPECT_EQ(decodePng(*encodePng(row, kPngReadSideMax + 1, 1), "'a.png'").error().code, ErrorCode::kLimit);
}

TEST(Ply, HeaderAndVerticesByHand) {
    std::vector<ParticleState> particles(2);
    particles[0].id = 0x01020304;
    particles[0].position = {1.0F, -2.0F, 0.5F};
    particles[0].velocity = {4.0F, 5.0F, 6.0F};
    particles[0].age = 0.25F;
    particles[0].lifetime = 8.0F;
    particles[0].type = 0x0a0b0c;
    particles[1].id = 3;  // lower: comes first
    const std::vector<std::byte> bytes = encodePly(particles);
    const std::string expected =
        "ply\nformat binary_little_endian 1.0\ncomment particles of relief-sim; object units, seconds\n"
        "element vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty float vx\n"
        "property float vy\nproperty float vz\nproperty float age\nproperty float lifetime\nproperty uint "
        "id\nproperty uint type\n"
        "end_header\n";
    ASSERT_EQ(bytes.size(), expected.size() + 2 * 40);
    EXPECT_EQ(std::memcmp(bytes.data(), expected.data(), expected.size()), 0);
    const auto at = [&](std::size_t offset) {
        return std::to_integer<unsigned>(bytes[expected.size() + offset]);
    };
    EXPECT_EQ(at(32), 3U);
    // 1.0F is 3f 80 00 00; the least byte comes first.
    EXPECT_EQ(at(40), 0U);
    EXPECT_EQ(at(42), 0x80U);
    EXPECT_EQ(at(43), 0x3fU);
    EXPECT_EQ(at(40 + 32), 4U);
    EXPECT_EQ(at(40 + 35), 1U);
    EXPECT_EQ(at(40 + 36), 0x0cU);
    EXPECT_EQ(at(40 + 38), 0x0aU);
}

TEST(Ply, NoParticlesAreAFileToo) {
    const std::vector<std::byte> bytes = encodePly({});
    EXPECT_TRUE(
        std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()).ends_with("end_header\n"));
}

}  // namespace
}  // namespace relief
