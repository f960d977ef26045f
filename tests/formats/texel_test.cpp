#include "formats/texel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "tests/formats/analytic_shapes.h"

namespace relief {
namespace {

constexpr MapFormat kFormats[] = {MapFormat::kFloat32, MapFormat::kFixed8, MapFormat::kFrontBackHalf,
                                  MapFormat::kCube8, MapFormat::kFrontBackFixed};

std::vector<std::byte> encode(MapFormat format, const Texel& texel) {
    std::vector<std::byte> bytes(texelSize(format), std::byte{0xcc});
    encodeTexel(format, texel, bytes);
    return bytes;
}

std::vector<std::byte> bytesOf(std::initializer_list<int> values) {
    std::vector<std::byte> bytes;
    for (const int value : values) {
        bytes.push_back(static_cast<std::byte>(value));
    }
    return bytes;
}

TEST(Texel, SizesAndNames) {
    EXPECT_EQ(texelSize(MapFormat::kFloat32), 16U);
    EXPECT_EQ(texelSize(MapFormat::kFixed8), 4U);
    EXPECT_EQ(texelSize(MapFormat::kFrontBackHalf), 8U);
    EXPECT_EQ(texelSize(MapFormat::kCube8), 4U);
    EXPECT_EQ(texelSize(MapFormat::kFrontBackFixed), 8U);
    EXPECT_STREQ(mapFormatName(MapFormat::kFloat32), "float");
    EXPECT_STREQ(mapFormatName(MapFormat::kFixed8), "fixed8");
    EXPECT_STREQ(mapFormatName(MapFormat::kFrontBackHalf), "front-back");
    EXPECT_STREQ(mapFormatName(MapFormat::kCube8), "cube");
    EXPECT_STREQ(mapFormatName(MapFormat::kFrontBackFixed), "front-back");
    EXPECT_STREQ(depthEncodingName(MapFormat::kFloat32), "float32");
    EXPECT_STREQ(depthEncodingName(MapFormat::kFixed8), "unorm16");
    EXPECT_STREQ(depthEncodingName(MapFormat::kFrontBackHalf), "half");
    EXPECT_STREQ(depthEncodingName(MapFormat::kCube8), "unorm16");
    EXPECT_STREQ(depthEncodingName(MapFormat::kFrontBackFixed), "unorm16");
    EXPECT_EQ(texelSize(MapFormat::kPatches), 8U);
    EXPECT_STREQ(mapFormatName(MapFormat::kPatches), "patches");
    EXPECT_STREQ(depthEncodingName(MapFormat::kPatches), "unorm8");
    // Patches have no texels of this kind.
    EXPECT_EQ(std::size(kFormats) + 1, static_cast<std::size_t>(kMapFormatCount));
    for (const MapFormat format : kFormats) {
        EXPECT_EQ(isFrontBack(format), texelSize(format) == 8U) << mapFormatName(format);
    }
}

TEST(Texel, EmptyIsZeroBitsButForFloat) {
    EXPECT_EQ(encode(MapFormat::kFixed8, {}), bytesOf({0, 0, 0, 0}));
    EXPECT_EQ(encode(MapFormat::kCube8, {}), bytesOf({0, 0, 0, 0}));
    EXPECT_EQ(encode(MapFormat::kFrontBackHalf, {}), bytesOf({0, 0, 0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(encode(MapFormat::kFrontBackFixed, {}), bytesOf({0, 0, 0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(encode(MapFormat::kFloat32, {}),
              bytesOf({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x80, 0xbf}));
    for (const MapFormat format : kFormats) {
        const Texel texel = decodeTexel(format, encode(format, {}));
        EXPECT_FALSE(texel.front || texel.back) << mapFormatName(format);
    }
}

TEST(Texel, ByteLayout) {
    const Surface front{0.25F, {1, 0, 0}};
    const Surface back{1.0F, {0, -1, 0}};
    // Code 1 + round(0.25 · 65534) = 16385 = 0x4001, high byte first.
    EXPECT_EQ(encode(MapFormat::kFixed8, {front, {}}), bytesOf({254, 127, 0x40, 0x01}));
    // Code 1 + round(1/√3 · 65534) = 37837 = 0x93cd.
    EXPECT_EQ(encode(MapFormat::kCube8, {back, {}}), bytesOf({127, 0, 0x93, 0xcd}));
    // Half 0.25 = 0x3400, 1 = 0x3c00; words little-endian, s in the high byte.
    EXPECT_EQ(encode(MapFormat::kFrontBackHalf, {front, back}),
              bytesOf({127, 254, 0, 127, 0, 0x34, 0, 0x3c}));
    EXPECT_EQ(encode(MapFormat::kFrontBackFixed, {front, back}),
              bytesOf({127, 254, 0, 127, 0x01, 0x40, 0xff, 0xff}));
    EXPECT_EQ(encode(MapFormat::kFrontBackFixed, {{}, Surface{0.0F, {1, 0, 0}}}),
              bytesOf({0, 0, 127, 254, 0, 0, 1, 0}));
    EXPECT_EQ(encode(MapFormat::kFloat32, {front, {}}),
              bytesOf({0, 0, 0x80, 0x3f, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x80, 0x3e}));
}

TEST(Texel, FixedDepthCodesRoundTripAndRise) {
    for (const float depth_max : {1.0F, kCubeDepthMax}) {
        float before = -1.0F;
        for (unsigned code = 1; code < 65536; ++code) {
            const float depth = decodeFixedDepth(static_cast<std::uint16_t>(code), depth_max);
            ASSERT_GT(depth, before);
            ASSERT_EQ(encodeFixedDepth(depth, depth_max), code);
            before = depth;
        }
        EXPECT_EQ(decodeFixedDepth(1, depth_max), 0.0F);
        EXPECT_NEAR(decodeFixedDepth(65535, depth_max), depth_max, 2e-7);
    }
}

TEST(Texel, FixedDepthIsHalfAStepOffAtMost) {
    for (const float depth_max : {1.0F, kCubeDepthMax}) {
        const double bound = 0.5 * depth_max / 65534.0 + 0x1p-23 * depth_max;
        for (int i = 0; i <= 1'000'000; ++i) {
            const float depth = static_cast<float>(i) * 1e-6F * depth_max;
            ASSERT_NEAR(decodeFixedDepth(encodeFixedDepth(depth, depth_max), depth_max), depth, bound);
        }
        EXPECT_EQ(encodeFixedDepth(-0.5F, depth_max), 1);
        EXPECT_EQ(encodeFixedDepth(2.0F * depth_max, depth_max), 65535);
    }
}

TEST(Texel, HalfDepthCodesRoundTripAndRise) {
    float before = 0.0F;
    for (std::uint16_t bits = 0x0400; bits <= 0x3c00; ++bits) {
        const float depth = decodeHalfDepth(bits);
        ASSERT_EQ(depth, std::ldexp(1.0F + static_cast<float>(bits & 0x3ff) / 1024.0F, (bits >> 10) - 15));
        ASSERT_GT(depth, before);
        ASSERT_EQ(encodeHalfDepth(depth), bits);
        before = depth;
    }
}

TEST(Texel, HalfDepthIsMonotoneNeverEmptyNeverSubnormal) {
    std::uint16_t before = 0;
    for (int i = 0; i <= 1'000'000; ++i) {
        const float depth = static_cast<float>(i) * 1e-6F;
        const std::uint16_t bits = encodeHalfDepth(depth);
        ASSERT_GE(bits, before);
        ASSERT_GE(bits, 0x0400);
        ASSERT_LE(bits, 0x3c00);
        if (depth >= 0x1p-14F) {
            ASSERT_NEAR(decodeHalfDepth(bits), depth, depth * 0x1p-11F);
        }
        before = bits;
    }
    EXPECT_EQ(encodeHalfDepth(-1.0F), 0x0400);
    EXPECT_EQ(encodeHalfDepth(2.0F), 0x3c00);
}

TEST(Texel, EveryFormatRoundTripsWithinItsBounds) {
    std::mt19937 random(11);
    std::normal_distribution<float> gauss;
    std::uniform_real_distribution<float> unit;
    const auto surface = [&] {
        const glm::dvec3 n(gauss(random), gauss(random), gauss(random));
        return Surface{unit(random), glm::vec3(n / std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z))};
    };
    for (const MapFormat format : kFormats) {
        const bool both = isFrontBack(format);
        const bool half = format == MapFormat::kFrontBackHalf;
        const bool exact = format == MapFormat::kFloat32;
        for (int i = 0; i < 20000; ++i) {
            Texel texel{surface(), std::nullopt};
            if (both) {
                texel.back = surface();
                if (i % 4 == 1) {
                    texel.back.reset();
                } else if (i % 4 == 2) {
                    texel.front.reset();
                }
            }
            const Texel read = decodeTexel(format, encode(format, texel));
            for (const auto& [given, got] : {std::pair(texel.front, read.front), {texel.back, read.back}}) {
                ASSERT_EQ(given.has_value(), got.has_value());
                if (!given) {
                    continue;
                }
                const double quantum =
                    exact  ? 0.0
                    : half ? std::max(static_cast<double>(given->depth) * 0x1p-11, 0x1p-14)
                           : 0.5 * (format == MapFormat::kCube8 ? kCubeDepthMax : 1.0F) / 65534.0 + 3e-7;
                ASSERT_NEAR(got->depth, given->depth, quantum);
                ASSERT_LE(test::angleInDegrees(glm::dvec3(got->normal), glm::dvec3(given->normal)),
                          exact ? 0.0 : 0.65);
            }
        }
    }
}

TEST(Texel, EveryFixedCodeDecodesToAUnitNormalAndADepthInRange) {
    for (unsigned normal = 0; normal < 65536; normal += 7) {
        for (const int depth : {1, 255, 256, 65535}) {
            const std::vector<std::byte> bytes = bytesOf(
                {static_cast<int>(normal >> 8), static_cast<int>(normal & 255), depth >> 8, depth & 255});
            for (const MapFormat format : {MapFormat::kFixed8, MapFormat::kCube8}) {
                const Texel texel = decodeTexel(format, bytes);
                ASSERT_TRUE(texel.front);
                ASSERT_NEAR(std::hypot(texel.front->normal.x, texel.front->normal.y, texel.front->normal.z),
                            1.0F, 1e-6F);
                ASSERT_GE(texel.front->depth, 0.0F);
                ASSERT_LE(texel.front->depth, kCubeDepthMax);
            }
        }
    }
}

}  // namespace
}  // namespace relief
