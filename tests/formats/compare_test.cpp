// Pairs of colliders made by hand, with one known difference each; and random ones against statistics by
// sorting.
#include "formats/compare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "formats/normal_index.h"
#include "tests/formats/analytic_shapes.h"
#include "tests/formats/sample_colliders.h"

namespace relief {
namespace {

/// Bytes of a texel, as formats/README.md has them: written here once more.
void setCode(DepthMap& map, std::size_t texel, std::size_t end, std::uint16_t code) {
    std::byte* at = &map.texels[texel * texelSize(map.format)];
    if (isFrontBack(map.format)) {
        std::memcpy(at + 4 + 2 * end, &code, 2);
        return;
    }
    at[2] = static_cast<std::byte>(code >> 8);
    at[3] = static_cast<std::byte>(code & 0xff);
}

void setNormal(DepthMap& map, std::size_t texel, std::size_t end, NormalIndex normal) {
    std::byte* at = &map.texels[texel * texelSize(map.format)];
    if (isFrontBack(map.format)) {
        const std::uint16_t packed = packNormal(normal);
        std::memcpy(at + 2 * end, &packed, 2);
        return;
    }
    at[0] = static_cast<std::byte>(normal.s);
    at[1] = static_cast<std::byte>(normal.t);
}

void setFloat(DepthMap& map, std::size_t texel, const glm::vec3& normal, float depth) {
    const float channels[4] = {normal.x, normal.y, normal.z, depth};
    std::memcpy(&map.texels[texel * sizeof(channels)], channels, sizeof(channels));
}

constexpr std::uint16_t kHalf = 0x3800;  // 0.5 as a half; in fixed point another depth

/// Every texel holds one surface an end: the code kHalf, or 0.5, with normal +z.
DepthMap fullMap(MapFormat format) {
    const auto compare = isFrontBack(format) ? Compare::kBoth : Compare::kLess;
    DepthMap map = format == MapFormat::kCube8
                       ? test::emptyMap(test::CubeFrame{{0, 0, 0}, glm::dmat3(1.0), {1, 1, 1}}, compare, 5)
                       : test::emptyMap(test::centeredFrame({0, 0, 0}, glm::dmat3(1.0), {2, 2, 2}), format,
                                        compare, 6, 5);
    for (std::size_t i = 0; i < map.texels.size() / texelSize(format); ++i) {
        if (format == MapFormat::kFloat32) {
            setFloat(map, i, {0, 0, 1}, 0.5F);
            continue;
        }
        for (std::size_t end = 0; end < (isFrontBack(format) ? 2U : 1U); ++end) {
            setCode(map, i, end, kHalf);
            setNormal(map, i, end, {127, 127});
        }
    }
    return map;
}

Collider colliderOf(DepthMap map) {
    Collider collider;
    collider.bounds = {{-1, -1, -1}, {1, 1, 1}};
    collider.maps.push_back(std::move(map));
    return collider;
}

constexpr MapFormat kFormats[] = {MapFormat::kFloat32, MapFormat::kFixed8, MapFormat::kFrontBackHalf,
                                  MapFormat::kCube8, MapFormat::kFrontBackFixed};

std::size_t texelsOf(const DepthMap& map) {
    return map.texels.size() / texelSize(map.format);
}

TEST(Compare, TheSameHasNoDifference) {
    for (const MapFormat format : kFormats) {
        const Collider a = colliderOf(fullMap(format));
        const ColliderDifference d = compareColliders(a, a);
        EXPECT_FALSE(d.structureDiffers());
        EXPECT_FALSE(d.texelsDiffer());
        ASSERT_EQ(d.maps.size(), 1U);
        EXPECT_TRUE(d.maps[0].compared);
        EXPECT_EQ(d.maps[0].texels, format == MapFormat::kCube8 ? 6U * 25U : 30U);
        EXPECT_EQ(d.maps[0].front.both, d.maps[0].texels);
        EXPECT_EQ(d.maps[0].front.depth, DifferenceStatistics());
        EXPECT_EQ(d.maps[0].front.normal, DifferenceStatistics());
        EXPECT_EQ(d.maps[0].back.both, isFrontBack(format) ? d.maps[0].texels : 0U);
        EXPECT_EQ(d.total.both, d.maps[0].front.both + d.maps[0].back.both);
    }
    const ColliderDifference all = compareColliders(test::oneMapOfEveryFormat(), test::oneMapOfEveryFormat());
    EXPECT_FALSE(all.structureDiffers() || all.texelsDiffer());
    EXPECT_EQ(all.total.ends, 56U + 56U + 2U * 64U + 6U * 16U + 2U * 64U);
    EXPECT_GT(all.total.both, 20U);
    EXPECT_LT(all.total.both, all.total.ends) << "some texels are empty";
}

TEST(Compare, DepthInCodesOfTheEncoding) {
    for (const MapFormat format : kFormats) {
        if (format == MapFormat::kFloat32) {
            continue;
        }
        for (const std::size_t end : {0U, 1U}) {
            if (end == 1 && !isFrontBack(format)) {
                continue;
            }
            SCOPED_TRACE(std::string(mapFormatName(format)) + " " + depthEncodingName(format));
            const Collider a = colliderOf(fullMap(format));
            Collider b = a;
            setCode(b.maps[0], 3, end, kHalf + 7);
            setCode(b.maps[0], texelsOf(b.maps[0]) - 1, end, kHalf - 256);
            const ColliderDifference d = compareColliders(a, b);
            EXPECT_FALSE(d.structureDiffers());
            EXPECT_EQ(d.maps[0].texels_differing, 2U);
            const EndDifference& changed = end == 0 ? d.maps[0].front : d.maps[0].back;
            const EndDifference& other = end == 0 ? d.maps[0].back : d.maps[0].front;
            EXPECT_EQ(changed.depth.differing, 2U);
            EXPECT_EQ(changed.depth.max, 256.0);
            EXPECT_DOUBLE_EQ(changed.depth.mean, 263.0 / static_cast<double>(d.maps[0].texels));
            // Of 150 texels 1.5 may lie above the percentile, so that the largest but one is it; of 30 none.
            EXPECT_EQ(changed.depth.percentile_99, format == MapFormat::kCube8 ? 7.0 : 256.0);
            EXPECT_EQ(changed.normal.differing, 0U);
            EXPECT_EQ(changed.beyond, 2U);
            EXPECT_EQ(other.depth.differing, 0U);
            EXPECT_EQ(other.beyond, 0U);
            EXPECT_EQ(compareColliders(a, b, {6.9, 0.0}).total.beyond, 2U);
            EXPECT_EQ(compareColliders(a, b, {7.0, 0.0}).total.beyond, 1U) << "the limit itself is allowed";
            EXPECT_EQ(compareColliders(a, b, {256.0, 0.0}).total.beyond, 0U);
        }
    }
    EXPECT_STREQ(depthUnit(MapFormat::kFrontBackHalf), "ulp");
    EXPECT_STREQ(depthUnit(MapFormat::kFrontBackFixed), "1/65534");
}

TEST(Compare, FloatDepthInCodesOfFixedPoint) {
    const Collider a = colliderOf(fullMap(MapFormat::kFloat32));
    Collider b = a;
    setFloat(b.maps[0], 8, {0, 0, 1}, 0.5F + 0.25F);
    EXPECT_DOUBLE_EQ(compareColliders(a, b).total.depth.max, 0.25 * 65534.0);
    setFloat(b.maps[0], 8, {0, 0, 1}, std::bit_cast<float>(std::bit_cast<std::uint32_t>(0.5F) + 1));
    const ColliderDifference ulp = compareColliders(a, b);
    EXPECT_EQ(ulp.total.depth.differing, 1U) << "the last bit of a float is a difference, too";
    EXPECT_NEAR(ulp.total.depth.max, 65534.0 * std::pow(2.0, -24), 1e-9);
    EXPECT_EQ(ulp.total.beyond, 1U);
}

TEST(Compare, NormalsInDegrees) {
    struct Case {
        NormalIndex normal;
        double degrees;
    };
    // From +z, (127, 127): to an axis, to −z, to u = 64/127 on the way to +x.
    const Case cases[] = {{{254, 127}, 90.0},
                          {{127, 0}, 90.0},
                          {{0, 0}, 180.0},
                          {{191, 127}, std::atan2(64.0, 63.0) * 180.0 / std::numbers::pi}};
    for (const MapFormat format : kFormats) {
        if (format == MapFormat::kFloat32) {
            continue;
        }
        for (const Case& one : cases) {
            for (std::size_t end = 0; end < (isFrontBack(format) ? 2U : 1U); ++end) {
                const Collider a = colliderOf(fullMap(format));
                Collider b = a;
                setNormal(b.maps[0], 11, end, one.normal);
                const ColliderDifference d = compareColliders(a, b);
                const EndDifference& changed = end == 0 ? d.maps[0].front : d.maps[0].back;
                EXPECT_EQ(changed.normal.differing, 1U);
                EXPECT_NEAR(changed.normal.max, one.degrees, 1e-4);
                EXPECT_NEAR(changed.normal.mean, one.degrees / static_cast<double>(d.maps[0].texels), 1e-4);
                EXPECT_EQ(changed.depth.differing, 0U);
                EXPECT_EQ(changed.beyond, 1U);
                EXPECT_EQ(compareColliders(a, b, {0.0, one.degrees + 0.001}).total.beyond, 0U);
                EXPECT_EQ(compareColliders(a, b, {1e6, one.degrees - 0.001}).total.beyond, 1U);
            }
        }
    }
    const Collider a = colliderOf(fullMap(MapFormat::kFloat32));
    Collider b = a;
    const double small = 0.01 * std::numbers::pi / 180.0;
    setFloat(b.maps[0], 2, {static_cast<float>(std::sin(small)), 0.0F, static_cast<float>(std::cos(small))},
             0.5F);
    EXPECT_NEAR(compareColliders(a, b).total.normal.max, 0.01, 1e-5) << "small angles keep their digits";
}

// Other bytes that every reader takes for the same: the four corners of the square of normals are all −z, and
// nobody reads the normal of an empty texel.
TEST(Compare, BytesThatNoReaderTellsApart) {
    Collider a = colliderOf(fullMap(MapFormat::kFixed8));
    setNormal(a.maps[0], 4, 0, {0, 0});
    setCode(a.maps[0], 5, 0, 0);
    Collider b = a;
    setNormal(b.maps[0], 4, 0, {254, 254});
    setNormal(b.maps[0], 5, 0, {1, 2});
    const ColliderDifference d = compareColliders(a, b);
    EXPECT_EQ(d.maps[0].texels_differing, 2U);
    EXPECT_TRUE(d.texelsDiffer());
    EXPECT_EQ(d.total.beyond, 0U);
    EXPECT_EQ(d.total.coverage(), 0U);
    EXPECT_EQ(d.total.normal.differing, 0U);
}

TEST(Compare, CoverageOfEachEnd) {
    Collider a = colliderOf(fullMap(MapFormat::kFrontBackFixed));
    Collider b = a;
    setCode(a.maps[0], 1, 0, 0);
    setCode(b.maps[0], 2, 1, 0);
    setCode(b.maps[0], 3, 1, 0);
    setCode(a.maps[0], 9, 1, 0);  // empty in both
    setCode(b.maps[0], 9, 1, 0);
    const ColliderDifference d = compareColliders(a, b);
    EXPECT_EQ(d.maps[0].front.only_a, 0U);
    EXPECT_EQ(d.maps[0].front.only_b, 1U);
    EXPECT_EQ(d.maps[0].front.both, 29U);
    EXPECT_EQ(d.maps[0].back.only_a, 2U);
    EXPECT_EQ(d.maps[0].back.only_b, 0U);
    EXPECT_EQ(d.maps[0].back.both, 27U);
    EXPECT_EQ(d.total.ends, 60U);
    EXPECT_EQ(d.total.coverage(), 3U);
    EXPECT_DOUBLE_EQ(d.total.coveragePercent(), 5.0);
    EXPECT_EQ(d.total.beyond, 0U) << "a surface that one of them lacks has no depth to compare";
    Collider c = colliderOf(fullMap(MapFormat::kFloat32));
    Collider e = c;
    setFloat(e.maps[0], 7, {0, 0, 0}, -1.0F);
    EXPECT_EQ(compareColliders(c, e).total.only_a, 1U);
}

std::vector<std::string> names(const std::vector<Difference>& differences) {
    std::vector<std::string> list;
    for (const Difference& one : differences) {
        list.push_back(one.what);
    }
    return list;
}

TEST(Compare, StructureIsNamed) {
    using Names = std::vector<std::string>;
    const Collider a = test::oneMapOfEveryFormat();
    Collider b = a;
    b.unit = "";
    b.bounds.max.y = 0.9375F;
    b.maps.pop_back();
    b.maps[0].decode = Decode::kPlane;
    b.maps[0].encloses = false;
    b.maps[0].object_to_map.row[1].w += 0.5F;
    b.maps[0].object_per_map.z *= 1.0001F;
    b.maps[1].compare = Compare::kGreater;
    b.maps[1].empty_is_outside = false;
    b.maps[2].format = MapFormat::kFrontBackFixed;
    b.maps[3] = colliderOf(fullMap(MapFormat::kCube8)).maps[0];
    b.provenance.mesh_hash = "";
    b.provenance.options += ",x";
    const ColliderDifference d = compareColliders(a, b);
    EXPECT_EQ(names(d.structure), (Names{"maps", "bounds", "unit"}));
    EXPECT_EQ(d.structure[0], (Difference{"maps", "5", "4"}));
    EXPECT_EQ(d.structure[1].b, "(-0.125, -0.375, -1.125) to (1.125, 0.9375, 0.125)");
    EXPECT_EQ(d.structure[2], (Difference{"unit", "'m'", "''"}));
    EXPECT_EQ(names(d.provenance), (Names{"mesh_hash", "options"}));
    ASSERT_EQ(d.maps.size(), 4U);
    EXPECT_EQ(names(d.maps[0].structure),
              (Names{"decode", "object_to_map row 1", "object_per_map", "encloses"}));
    EXPECT_TRUE(d.maps[0].compared) << "texels of the same format and size can be";
    EXPECT_EQ(names(d.maps[1].structure), (Names{"compare", "empty_is_outside"}));
    EXPECT_EQ(d.maps[2].structure[0], (Difference{"format", "front-back (half)", "front-back (unorm16)"}));
    EXPECT_FALSE(d.maps[2].compared);
    EXPECT_EQ(d.maps[3].structure[0], (Difference{"size", "4x4", "5x5"}));
    EXPECT_FALSE(d.maps[3].compared);
    EXPECT_EQ(d.maps[3].front, EndDifference());
    EXPECT_TRUE(d.structureDiffers());

    Collider only_from = a;
    only_from.provenance.tool_version = "relief 0.2.0";
    EXPECT_FALSE(compareColliders(a, only_from).structureDiffers());
    EXPECT_EQ(names(compareColliders(a, only_from).provenance), Names{"tool_version"});
}

/// A map with random surfaces, some empty.
Collider randomCollider(MapFormat format, std::mt19937& random, const Collider* base) {
    Collider collider = base != nullptr ? *base : colliderOf(fullMap(format));
    DepthMap& map = collider.maps[0];
    const auto share = [&] { return static_cast<double>(random()) / 4294967296.0; };
    for (std::size_t i = 0; i < texelsOf(map); ++i) {
        for (std::size_t end = 0; end < (isFrontBack(format) ? 2U : 1U); ++end) {
            if (base != nullptr && share() < 0.7) {
                continue;
            }
            const bool empty = share() < 0.2;
            if (format == MapFormat::kFloat32) {
                const auto angle = static_cast<float>(share() * 6.0);
                setFloat(map, i, empty ? glm::vec3(0.0F) : glm::vec3(std::cos(angle), std::sin(angle), 0.0F),
                         empty ? -1.0F : static_cast<float>(share()));
                continue;
            }
            setCode(map, i, end, empty ? 0 : static_cast<std::uint16_t>(0x2000 + random() % 0x1c00));
            setNormal(map, i, end,
                      {static_cast<std::uint8_t>(random() % 255), static_cast<std::uint8_t>(random() % 255)});
        }
    }
    return collider;
}

/// By sorting all amounts, zeros too. Mean and maximum of floats, hence the tolerance.
void expectStatistics(const DifferenceStatistics& actual, std::vector<double> amounts) {
    std::sort(amounts.begin(), amounts.end());
    double sum = 0.0;
    std::uint64_t differing = 0;
    for (const double amount : amounts) {
        sum += amount;
        differing += amount > 0.0 ? 1 : 0;
    }
    EXPECT_EQ(actual.differing, differing);
    EXPECT_NEAR(actual.max, amounts.back(), 1e-6 * (1.0 + amounts.back()));
    EXPECT_NEAR(actual.mean, sum / static_cast<double>(amounts.size()), 1e-6 * (1.0 + actual.mean));
    const auto rank = static_cast<std::size_t>(std::ceil(0.99 * static_cast<double>(amounts.size())));
    EXPECT_NEAR(actual.percentile_99, amounts[rank - 1], 1e-6 * (1.0 + amounts[rank - 1]));
}

TEST(Compare, RandomPairsAgainstSortingAndMirrored) {
    std::mt19937 random(7);
    for (int round = 0; round < 40; ++round) {
        for (const MapFormat format : kFormats) {
            const Collider a = randomCollider(format, random, nullptr);
            const Collider b = randomCollider(format, random, &a);
            const ColliderDifference d = compareColliders(a, b, {100.0, 20.0});
            std::vector<double> depths;
            std::vector<double> normals;
            std::uint64_t beyond = 0;
            for (std::size_t i = 0; i < texelsOf(a.maps[0]); ++i) {
                const std::size_t size = texelSize(format);
                const Texel ta = decodeTexel(format, std::span(a.maps[0].texels).subspan(i * size, size));
                const Texel tb = decodeTexel(format, std::span(b.maps[0].texels).subspan(i * size, size));
                for (const auto& [sa, sb] : {std::pair(ta.front, tb.front), std::pair(ta.back, tb.back)}) {
                    if (!sa || !sb) {
                        continue;
                    }
                    // Where halves are, an ulp is 2^(exponent) / 1024: counted by packing the depths again.
                    const double depth =
                        format == MapFormat::kFrontBackHalf
                            ? std::abs(int{encodeHalfDepth(sa->depth)} - int{encodeHalfDepth(sb->depth)})
                        : format == MapFormat::kFloat32
                            ? 65534.0 * std::abs(double{sa->depth} - double{sb->depth})
                            : std::abs(int{encodeFixedDepth(
                                           sa->depth, format == MapFormat::kCube8 ? kCubeDepthMax : 1.0F)} -
                                       int{encodeFixedDepth(
                                           sb->depth, format == MapFormat::kCube8 ? kCubeDepthMax : 1.0F)});
                    const glm::dvec3 na(sa->normal);
                    const glm::dvec3 nb(sb->normal);
                    const double chord = glm::length(na - nb);
                    const double sum = glm::length(na + nb);
                    const double degrees = 2.0 * std::atan2(chord, sum) * 180.0 / std::numbers::pi;
                    depths.push_back(depth);
                    normals.push_back(degrees);
                    beyond += depth > 100.0 || degrees > 20.0 ? 1 : 0;
                }
            }
            ASSERT_FALSE(depths.empty());
            EXPECT_EQ(d.total.both, depths.size());
            EXPECT_EQ(d.total.beyond, beyond);
            expectStatistics(d.total.depth, depths);
            expectStatistics(d.total.normal, normals);

            const ColliderDifference mirrored = compareColliders(b, a, {100.0, 20.0});
            EXPECT_EQ(mirrored.maps[0].texels_differing, d.maps[0].texels_differing);
            for (const auto& [there, back] :
                 {std::pair(d.maps[0].front, mirrored.maps[0].front),
                  std::pair(d.maps[0].back, mirrored.maps[0].back), std::pair(d.total, mirrored.total)}) {
                EndDifference swapped = back;
                std::swap(swapped.only_a, swapped.only_b);
                EXPECT_EQ(there, swapped);
            }
        }
    }
}

}  // namespace
}  // namespace relief
