// SPDX-License-Identifier: Apache-2.0
#include "formats/texel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "tests/formats/analytic_shapes.h"

namespace relief {
namespace {

std::vector<std::byte> bytesOf(std::initializer_list<int> values) {
    std::vector<std::byte> bytes;
    for (const int value : values) {
        bytes.push_back(static_cast<std::byte>(value));
    }
    return bytes;
}

/// Expects these bytes for the texel, and the texel from these bytes.
void expectBytes(MapFormat format, const Texel& texel, std::initializer_list<int> values) {
    SCOPED_TRACE(std::string(mapFormatName(format)) + " " + depthEncodingName(format));
    std::vector<std::byte> bytes(texelSize(format), std::byte{0xcc});
    encodeTexel(format, texel, bytes);
    EXPECT_EQ(bytes, bytesOf(values));
    const Texel read = decodeTexel(format, bytesOf(values));
    for (const auto& [given, got] : {std::pair(texel.front, read.front), {texel.back, read.back}}) {
        ASSERT_EQ(given.has_value(), got.has_value());
        if (given) {
            EXPECT_NEAR(got->depth, given->depth, test::depthQuantum(format, double{given->depth}));
            EXPECT_EQ(got->normal, given->normal);
        }
    }
}

TEST(Texel, ByteLayout) {
    const Surface front{0.25F, {1, 0, 0}};
    const Surface back{1.0F, {0, -1, 0}};
    // Code 1 + round(0.25 · 65534) = 16385 = 0x4001, high byte first.
    expectBytes(MapFormat::kFixed8, {front, {}}, {254, 127, 0x40, 0x01});
    // Code 1 + round(1/√3 · 65534) = 37837 = 0x93cd.
    expectBytes(MapFormat::kCube8, {back, {}}, {127, 0, 0x93, 0xcd});
    // Half 0.25 = 0x3400, 1 = 0x3c00; words little-endian, s in the high byte.
    expectBytes(MapFormat::kFrontBackHalf, {front, back}, {127, 254, 0, 127, 0, 0x34, 0, 0x3c});
    expectBytes(MapFormat::kFrontBackHalf, {front, {}}, {127, 254, 0, 0, 0, 0x34, 0, 0});
    expectBytes(MapFormat::kFrontBackFixed, {front, back}, {127, 254, 0, 127, 0x01, 0x40, 0xff, 0xff});
    expectBytes(MapFormat::kFrontBackFixed, {{}, Surface{0.0F, {1, 0, 0}}}, {0, 0, 127, 254, 0, 0, 1, 0});
    expectBytes(MapFormat::kFloat32, {front, {}},
                {0, 0, 0x80, 0x3f, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x80, 0x3e});
    // Empty is all zero bits, except for float.
    expectBytes(MapFormat::kFixed8, {}, {0, 0, 0, 0});
    expectBytes(MapFormat::kCube8, {}, {0, 0, 0, 0});
    expectBytes(MapFormat::kFrontBackHalf, {}, {0, 0, 0, 0, 0, 0, 0, 0});
    expectBytes(MapFormat::kFrontBackFixed, {}, {0, 0, 0, 0, 0, 0, 0, 0});
    expectBytes(MapFormat::kFloat32, {}, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x80, 0xbf});
}

TEST(Texel, DepthsHaveNames) {
    const char* const names[kMapFormatCount] = {"float32", "unorm16", "half", "unorm16", "unorm16", "unorm8"};
    for (int i = 0; i < kMapFormatCount; ++i) {
        EXPECT_STREQ(depthEncodingName(static_cast<MapFormat>(i)), names[i]);
    }
}

TEST(Texel, FixedDepthCodesRoundTripMonotonicallyWithinHalfAStep) {
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
        const double bound = 0.5 * depth_max / 65534.0 + 0x1p-23 * depth_max;
        for (int i = 0; i <= 200'000; ++i) {
            const float depth = static_cast<float>(i) * 5e-6F * depth_max;
            ASSERT_NEAR(decodeFixedDepth(encodeFixedDepth(depth, depth_max), depth_max), depth, bound);
        }
        EXPECT_EQ(encodeFixedDepth(-0.5F, depth_max), 1);
        EXPECT_EQ(encodeFixedDepth(2.0F * depth_max, depth_max), 65535);
    }
}

TEST(Texel, HalfDepthCodesRoundTripMonotonicallyNeverEmptyOrSubnormal) {
    float before = 0.0F;
    for (std::uint16_t bits = 0x0400; bits <= 0x3c00; ++bits) {
        const float depth = decodeHalfDepth(bits);
        ASSERT_EQ(depth, std::ldexp(1.0F + static_cast<float>(bits & 0x3ff) / 1024.0F, (bits >> 10) - 15));
        ASSERT_GT(depth, before);
        ASSERT_EQ(encodeHalfDepth(depth), bits);
        before = depth;
    }
    std::uint16_t bits_before = 0x0400;
    for (int i = 0; i <= 200'000; ++i) {
        const float depth = static_cast<float>(i) * 5e-6F;
        const std::uint16_t bits = encodeHalfDepth(depth);
        ASSERT_GE(bits, bits_before);
        ASSERT_LE(bits, 0x3c00);
        if (depth >= 0x1p-14F) {
            ASSERT_NEAR(decodeHalfDepth(bits), depth, depth * 0x1p-11F);
        }
        bits_before = bits;
    }
    EXPECT_EQ(encodeHalfDepth(-1.0F), 0x0400);
    EXPECT_EQ(encodeHalfDepth(2.0F), 0x3c00);
}

}  // namespace
}  // namespace relief
