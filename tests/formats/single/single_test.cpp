// SPDX-License-Identifier: Apache-2.0
// relief.h against the library: hashes, distances, collisions, and what it rejects. tests/fuzz/fuzz_single.cpp compares
// them for damaged containers.
#include <gtest/gtest.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <limits>
#include <map>
#include <optional>
#include <random>

#include "formats/base/file_io.h"
#include "formats/base/hash.h"
#include "formats/collider.h"
#include "formats/container.h"
#include "formats/patch_tree.h"
#include "tests/formats/random_patches.h"
#include "tests/formats/rotation.h"
#include "tests/formats/sample_colliders.h"
#include "tests/results.h"
#include "tests/seeds.h"
#include "tests/temporary_folder.h"

namespace {

// The allocator of relief.h.
std::map<void*, std::size_t> live;
std::size_t largest = 0;
int allocations_left = std::numeric_limits<int>::max();

void* allocate(std::size_t bytes) {
    if (allocations_left-- <= 0) {
        return nullptr;
    }
    void* const pointer = std::malloc(bytes);
    live[pointer] = bytes;
    largest = std::max(largest, bytes);
    return pointer;
}

void release(void* pointer) {
    EXPECT_EQ(live.erase(pointer), 1U);
    std::free(pointer);
}

}  // namespace

#define RELIEF_IMPLEMENTATION
#define RELIEF_MALLOC(bytes) allocate(bytes)
#define RELIEF_FREE(pointer) release(pointer)
#define RELIEF_UNPACKED_MAX (1 << 16)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"
#include "formats/single/relief.h"
#pragma GCC diagnostic pop

namespace relief {
namespace {

static_assert(sizeof(relief_constants) == 80 && offsetof(relief_constants, place) == 64);

/// A collider that is open while it exists.
class Single {
  public:
    explicit Single(std::span<const std::byte> bytes, relief_decompress decompress = nullptr)
        : status(relief_open(&collider, bytes.data(), bytes.size(), decompress)) {}
    Single(const Single&) = delete;
    Single& operator=(const Single&) = delete;
    ~Single() { relief_close(&collider); }

    relief_collider collider;
    relief_status status;
};

Collider colliderOf(DepthMap map) {
    Collider collider;
    collider.bounds = {glm::vec3(-1.0F), glm::vec3(2.0F)};
    collider.maps.push_back(std::move(map));
    return collider;
}

/// Random patches in a random place.
Collider placedPatches(std::mt19937& random) {
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    DepthMap map = test::randomPatches(random);
    const glm::dmat3 turned =
        test::rotation(glm::dvec3(unit(random), unit(random), 1.0), 180.0 * double{unit(random)});
    const float scale = std::exp2(4.0F * unit(random));
    for (int k = 0; k < 3; ++k) {
        const glm::vec3 row = glm::vec3(turned[k]) / scale;
        map.object_to_map.row[k] = {row.x, row.y, row.z, 3.0F * unit(random)};
    }
    map.object_per_map = glm::vec3(scale);
    return colliderOf(std::move(map));
}

/// A point in object space whose image in map space is random in and around the roots.
glm::vec3 pointNear(const DepthMap& map, std::mt19937& random) {
    std::uniform_real_distribution<double> unit(-0.02, 1.02);
    const glm::dvec3 roots(patchTreeSize(map.texels).roots);
    glm::dvec3 p(0.0);
    for (int k = 0; k < 3; ++k) {
        const glm::dvec4 row(map.object_to_map.row[k]);
        const double scale = map.object_per_map[k];
        p += glm::dvec3(row) * (scale * scale * (unit(random) * roots[k] - row.w));
    }
    return p;
}

/// Names the kind of leaf at a point: "patch 2 3 union" is a face diagonal (2 axes) of 3² heights in a union.
std::string leafAt(const DepthMap& map, const glm::vec3& p) {
    const glm::vec3 at = map.object_to_map.apply(p);
    if (!votePatches(map.texels, at)) {
        return "no root";
    }
    const PatchLeaf leaf = patchLeafAt(map.texels, at);
    if (leaf.beside) {
        return leaf.inside ? "octant inside" : "octant outside";
    }
    if (leaf.record.kind() != PatchRecord::Kind::kPatch) {
        return leaf.inside ? "inside" : "outside";
    }
    const bool pair = leaf.record.isPair();
    const PatchRecord patch = pair ? patchTexel(map.texels, leaf.record.first()) : leaf.record;
    return "patch " + std::to_string(patch.frame().diagonal + 1) + " " + std::to_string(patch.side()) +
           (!pair                          ? ""
            : (leaf.record.low & 16U) != 0 ? " intersection"
                                           : " union");
}

/// Equal bit by bit.
bool same(const glm::vec3& a, const glm::vec3& b) {
    return std::memcmp(&a.x, &b.x, sizeof(a)) == 0;
}

TEST(SingleHash, EqualsThatOfLibxxhash) {
    std::mt19937 random(test::seedFrom(1));
    std::vector<std::byte> bytes(70'000);
    for (std::byte& one : bytes) {
        one = static_cast<std::byte>(random());
    }
    const auto expectSame = [&](std::size_t first, std::size_t size) {
        const auto part = std::span(bytes).subspan(first, size);
        EXPECT_EQ(rlf_xxh3(reinterpret_cast<const unsigned char*>(part.data()), size), xxh3_64(part)) << size;
    };
    for (std::size_t size = 0; size <= 2000; ++size) {
        expectSame(size % 13, size);
    }
    for (const std::size_t size : {4096, 4097, 65535, 65536, 65537, 69'999}) {
        expectSame(1, size);
    }
}

TEST(Single, HasTheFieldOfTheLibrary) {
    std::mt19937 random(test::seedFrom(2));
    std::map<std::string, int> points;
    int differing = 0;
    for (int i = 0; i < 20; ++i) {
        Collider collider = placedPatches(random);
        collider.unit = i == 0 ? "" : "sixteen letters!";
        collider.maps[0].encloses = i % 2 == 0;
        const Single single(test::written(collider, i % 3), ZSTD_decompress);
        ASSERT_EQ(single.status, RELIEF_OK) << relief_message(single.status);
        EXPECT_EQ(collider.unit, single.collider.unit);
        EXPECT_EQ(single.collider.bounds_min[2], -1.0F);
        EXPECT_EQ(single.collider.bounds_max[0], 2.0F);
        for (int k = 0; k < 5'000; ++k) {
            const glm::vec3 p = pointNear(collider.maps[0], random);
            ++points[leafAt(collider.maps[0], p)];
            const FieldSample expected = evaluate(collider, p);
            glm::vec3 normal(1.0F);
            const float distance = relief_distance(&single.collider, &p.x, &normal.x);
            differing += distance == expected.distance && same(normal, expected.normal) ? 0 : 1;
            EXPECT_EQ(relief_distance(&single.collider, &p.x, nullptr), distance);
        }
    }
    EXPECT_EQ(differing, 0);
    // No root, four leaves without patches; three axes and three sizes, in a leaf, a union and an intersection.
    EXPECT_EQ(points.size(), 5U + 3 * 3 * 3);
    for (const auto& [leaf, count] : points) {
        EXPECT_GT(count, 5) << leaf;
    }
    EXPECT_TRUE(live.empty());
}

TEST(Single, PointsWithoutAPlaceAreFarOutside) {
    std::mt19937 random(test::seedFrom(3));
    const Single single(test::written(placedPatches(random)));
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    for (const float x : {1e9F, -1e30F, kInfinity, -kInfinity, kNan}) {
        for (int axis = 0; axis < 3; ++axis) {
            glm::vec3 p(0.1F);
            p[axis] = x;
            glm::vec3 normal(1.0F);
            EXPECT_EQ(relief_distance(&single.collider, &p.x, &normal.x), RELIEF_FAR_OUTSIDE);
            EXPECT_EQ(normal, glm::vec3(0.0F));
        }
    }
    relief_collider closed = {};
    const float p[3] = {0, 0, 0};
    EXPECT_EQ(relief_distance(&closed, p, nullptr), RELIEF_FAR_OUTSIDE);
}

TEST(Single, CollidesByTheFormula) {
    std::mt19937 random(test::seedFrom(4));
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    const Collider collider = placedPatches(random);
    const Single single(test::written(collider));
    const float size = collider.maps[0].object_per_map.x;
    int hits = 0;
    int inwards = 0;
    for (int i = 0; i < 20'000; ++i) {
        const glm::vec3 p = pointNear(collider.maps[0], random);
        const glm::vec3 v(unit(random), unit(random), unit(random));
        const float radius = 0.2F * size * std::abs(unit(random));
        const float restitution = i % 3 == 0 ? 0.0F : std::abs(unit(random));
        const float friction = i % 5 == 0 ? 1.0F : std::abs(unit(random));
        const FieldSample field = evaluate(collider, p);
        if (field.distance == kFarOutside) {
            continue;  // a ball may reach the root cells: the next test
        }
        glm::vec3 moved = p;
        glm::vec3 turned = v;
        const int hit = relief_collide(&single.collider, &moved.x, &turned.x, radius, restitution, friction);
        ASSERT_EQ(hit != 0, field.distance < radius);
        if (hit == 0) {
            ASSERT_TRUE(same(moved, p) && same(turned, v));
            continue;
        }
        ++hits;
        const float near = 1e-5F * (1.0F + std::abs(field.distance) + radius);
        ASSERT_LT(glm::distance(moved, p + (radius - field.distance) * field.normal), near);
        const float along = glm::dot(v, field.normal);
        if (along >= 0.0F) {
            ASSERT_TRUE(same(turned, v));
            continue;
        }
        ++inwards;
        const glm::vec3 tangent = v - along * field.normal;
        ASSERT_LT(glm::distance(turned, (1.0F - friction) * tangent - restitution * along * field.normal),
                  1e-5F);
    }
    EXPECT_GT(inwards, 2000);
    EXPECT_GT(hits, inwards + 2000);
}

TEST(Single, BallsTouchASurfaceBeyondTheRootCells) {
    // One root with a patch: outside above x = ½.
    const PatchHeights heights = PatchHeights::of(std::array{0.5, 0.5, 0.5, 0.5}, 2);
    DepthMap map;
    map.format = MapFormat::kPatches;
    map.decode = Decode::kPlane;
    map.width = 2;
    map.height = 1;
    map.object_to_map = {{{1.0F, 0.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 1.0F, 0.0F}}};
    map.object_per_map = glm::vec3(1.0F);
    appendPatchTexel(map.texels, {1U | 1U << 16U, 1U});
    appendPatchTexel(map.texels, PatchRecord::patch({}, false, heights, 0));
    const Collider collider = colliderOf(std::move(map));
    const Single single(test::written(collider));
    for (const float radius : {0.0F, 0.2F, 0.7F, 2.0F}) {
        for (const float x : {-3.0F, -0.3F, 0.2F, 0.49F, 0.6F, 0.9F, 1.1F, 1.4F, 2.6F}) {
            // The patch looks along x.
            glm::vec3 p(x, 0.5F, 0.5F);
            glm::vec3 v(-1.0F, 0.0F, 0.0F);
            const bool near = x >= 0.0F && x < 1.0F ? true : std::max(-x, x - 1.0F) < radius;
            const bool touches = near && x - 0.5F < radius;
            ASSERT_EQ(relief_collide(&single.collider, &p.x, &v.x, radius, 1.0F, 0.0F) != 0, touches)
                << x << ' ' << radius;
            ASSERT_NEAR(p.x, touches ? 0.5F + radius : x, 1e-5F);
            ASSERT_NEAR(v.x, touches ? 1.0F : -1.0F, 1e-5F);
        }
    }
}

TEST(Single, RejectsEveryTruncationAndExtension) {
    std::mt19937 random(test::seedFrom(5));
    std::vector<std::byte> bytes = test::written(placedPatches(random));
    ASSERT_EQ(Single(bytes).status, RELIEF_OK);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        const std::vector<std::byte> part(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
        ASSERT_EQ(Single(part).status, size == 0 ? RELIEF_NOT_A_CONTAINER : RELIEF_DAMAGED) << size;
    }
    bytes.push_back(std::byte{0});
    EXPECT_EQ(Single(bytes).status, RELIEF_DAMAGED);
}

TEST(Single, RejectsEveryChangedByte) {
    std::mt19937 random(test::seedFrom(6));
    std::vector<std::byte> bytes = test::written(placedPatches(random));
    for (std::byte& one : bytes) {
        one ^= std::byte{0x10};
        ASSERT_NE(Single(bytes).status, RELIEF_OK);
        one ^= std::byte{0x10};
    }
}

/// Replaces every occurrence of a text and corrects the checksums.
std::vector<std::byte> replaced(std::vector<std::byte> bytes, std::string_view from, std::string_view to) {
    const auto old = std::as_bytes(std::span(from));
    const auto with = std::as_bytes(std::span(to));
    EXPECT_EQ(old.size(), with.size());
    int count = 0;
    for (auto at = bytes.begin(); (at = std::search(at, bytes.end(), old.begin(), old.end())) != bytes.end();
         ++count) {
        at = std::copy(with.begin(), with.end(), at);
    }
    EXPECT_GT(count, 0) << from;
    test::fixChecksums(bytes);
    return bytes;
}

/// Expects that relief.h accepts a container of one map of patches if and only if the library does.
bool isAccepted(const std::vector<std::byte>& bytes) {
    const bool accepted = readContainer(bytes).has_value();
    EXPECT_EQ(Single(bytes, ZSTD_decompress).status == RELIEF_OK, accepted);
    return accepted;
}

TEST(Single, JudgesEveryByteAsTheLibraryDoes) {
    int accepted = 0;
    int rejected = 0;
    for (const char* name : {"plain", "materials", "zstd"}) {
        const auto file = required(readFile(
            std::string(RELIEF_SOURCE_DIR "/tests/fuzz/corpus/container/patches_") + name + ".relief"));
        std::uint64_t metadata_size = 0;
        std::memcpy(&metadata_size, file.data() + 40, sizeof(metadata_size));
        const std::size_t payload = (64 + metadata_size + 63) / 64 * 64;
        const auto hashOf = [&](const std::vector<std::byte>& bytes) {
            const std::uint64_t hash = xxh3_64(std::span(bytes).subspan(payload));
            return std::string(reinterpret_cast<const char*>(&hash), sizeof(hash));
        };
        const std::string hash = hashOf(file);
        ASSERT_TRUE(isAccepted(file));
        for (std::size_t i = 0; i < file.size(); ++i) {
            const auto old = static_cast<unsigned>(file[i]);
            for (const unsigned value : {0U, 1U, 9U, 0x2fU, 0x80U, 0xffU, old + 1U, old ^ 0x40U}) {
                std::vector<std::byte> bytes = file;
                bytes[i] = static_cast<std::byte>(value & 0xffU);
                if (bytes[i] == file[i]) {
                    continue;
                }
                if (i < 56) {  // the size of the metadata may be wrong
                    const std::uint64_t header_hash = xxh3_64(std::span(bytes).first(56));
                    std::memcpy(bytes.data() + 56, &header_hash, sizeof(header_hash));
                } else if (i < payload) {
                    test::fixChecksums(bytes);
                } else {
                    bytes = replaced(bytes, hash, hashOf(bytes));
                }
                ++(isAccepted(bytes) ? accepted : rejected);
                ASSERT_FALSE(HasFailure()) << name << ": byte " << i << " is " << value;
            }
        }
    }
    EXPECT_GT(accepted, 2000);
    EXPECT_GT(rejected, 2000);
}

TEST(Single, JudgesTextsAndMaterialsAsTheLibraryDoes) {
    std::mt19937 random(test::seedFrom(12));
    Collider collider = placedPatches(random);
    collider.unit = "metre";
    collider.provenance.options = {{"name", "value"}, {"split\xc3", "\xbc"}};
    collider.materials = test::someMaterials();
    collider.materials.list.resize(2);
    collider.materials.list[0].name = "first";
    collider.materials.list[1].name = "other";
    collider.materials.sides.clear();
    // Three levels, of 1, 8 and 12 nodes.
    collider.materials.nodes.assign(21, {});
    collider.materials.nodes[0].head = 0xffU | 1U << 8U;
    collider.materials.nodes[1].head = 0xffU | 9U << 8U;
    collider.materials.nodes[2].head = 0x0fU | 17U << 8U;
    const std::vector<std::byte> good = test::written(collider);
    ASSERT_TRUE(isAccepted(good));
    EXPECT_TRUE(isAccepted(replaced(good, "metre",
                                    "m\xc3\xa8"
                                    "tr")));
    EXPECT_TRUE(isAccepted(replaced(good, "metre", "\xf4\x8f\xbf\xbfm")));
    EXPECT_TRUE(isAccepted(replaced(good, "metre",
                                    "\xe2\x80\xae"
                                    "re")));  // only names of materials must not
    for (const char* bad :
         {"metr\x1f", "metr\x7f", "met\xc2\x9f", "met\xc0\xaf", "me\xe0\x9f\xbf", "me\xed\xa0\x80",
          "m\xf0\x8f\xbf\xbf", "m\xf4\x90\x80\x80", "m\xf5\x80\x80\x80", "metr\xc3", "met\xe2\x80"}) {
        EXPECT_FALSE(isAccepted(replaced(good, "metre", bad)));
    }
    EXPECT_FALSE(isAccepted(replaced(good, "split\xc3", "split_")));
    EXPECT_FALSE(isAccepted(replaced(good, "value", "valu\xc3")));
    EXPECT_FALSE(isAccepted(replaced(good, "other", "first")));
    for (const char* bad : {"\xe2\x80\xaa..", "..\xe2\x80\xae", "\xe2\x81\xa6..", ".\xe2\x81\xa9."}) {
        EXPECT_FALSE(isAccepted(replaced(good, "other", bad)));
    }
    EXPECT_TRUE(isAccepted(replaced(good, "other", "..\xe2\x81\xaa")));

    // A chain of nodes is one level too deep.
    const auto textOf = [](const std::vector<MaterialNode>& nodes) {
        return std::string(reinterpret_cast<const char*>(nodes.data()), nodes.size() * sizeof(MaterialNode));
    };
    std::vector<MaterialNode> chain(21);
    for (std::uint32_t i = 0; i < 20; ++i) {
        chain[i].head = 1U | (i + 1) << 8U;
    }
    EXPECT_FALSE(isAccepted(replaced(good, textOf(collider.materials.nodes), textOf(chain))));
    chain[18].head = 3U | 19U << 8U;
    chain[19].head = 0;
    EXPECT_TRUE(isAccepted(replaced(good, textOf(collider.materials.nodes), textOf(chain))));
    chain[18].head = 7U | 19U << 8U;  // a node that does not exist
    EXPECT_FALSE(isAccepted(replaced(good, textOf(collider.materials.nodes), textOf(chain))));
}

TEST(Single, StatesWhyItRejectsAContainer) {
    std::mt19937 random(test::seedFrom(7));
    const Collider collider = placedPatches(random);
    EXPECT_EQ(Single(test::toBytes("# Blender v2.79\nv 0 0 0\n")).status, RELIEF_NOT_A_CONTAINER);

    std::vector<std::byte> version_3 = test::written(collider);
    version_3[12] = std::byte{3};
    EXPECT_EQ(Single(version_3).status, RELIEF_WRONG_VERSION);

    std::vector<std::byte> later_minor = test::written(collider);
    later_minor[14] = std::byte{7};
    test::fixChecksums(later_minor);
    EXPECT_EQ(Single(later_minor).status, RELIEF_OK);

    EXPECT_EQ(Single(test::written(test::readmeExample())).status, RELIEF_UNSUPPORTED);
    EXPECT_EQ(Single(test::written(test::oneMapOfEveryFormat())).status, RELIEF_UNSUPPORTED);
    Collider two = collider;
    two.maps.push_back(collider.maps[0]);
    EXPECT_EQ(Single(test::written(two)).status, RELIEF_UNSUPPORTED);

    // Zeros, which compress well, fill the last row.
    const std::vector<std::byte> compressed = test::written(collider, 9);
    ASSERT_LT(compressed.size(), test::written(collider).size());
    EXPECT_EQ(Single(compressed).status, RELIEF_COMPRESSED);
    EXPECT_EQ(Single(compressed, ZSTD_decompress).status, RELIEF_OK);
    const auto fails = [](void*, std::size_t, const void*, std::size_t) { return std::size_t{0}; };
    EXPECT_EQ(Single(compressed, fails).status, RELIEF_INVALID);
}

TEST(Single, ReadsMaterialsOnlyToValidateThem) {
    std::mt19937 random(test::seedFrom(8));
    Collider collider = placedPatches(random);
    collider.materials = test::someMaterials();
    EXPECT_EQ(Single(test::written(collider)).status, RELIEF_OK);
    // Many equal nodes, so that they are stored compressed.
    Materials& materials = collider.materials;
    materials.nodes.assign(1 + 8 + 64, {});
    for (std::uint32_t i = 0; i < 9; ++i) {
        materials.nodes[i].head = 0xffU | (1 + 8 * i) << 8U;
    }
    EXPECT_EQ(Single(test::written(collider, 9), ZSTD_decompress).status, RELIEF_OK);
    EXPECT_TRUE(live.empty());
}

TEST(Single, AllocatesInProportionToTheFile) {
    std::mt19937 random(test::seedFrom(9));
    Collider collider = placedPatches(random);
    const std::vector<std::byte> small = test::written(collider);
    largest = 0;
    ASSERT_EQ(Single(small).status, RELIEF_OK);
    EXPECT_LE(largest, small.size() + 16'384);

    // Zeros after the tree: a bomb of 16 MB.
    DepthMap& map = collider.maps[0];
    map.width = 2048;
    map.height = 1024;
    map.texels.resize(map.texelBytes());
    const std::vector<std::byte> bomb = test::written(collider, 19);
    ASSERT_LT(bomb.size(), 100'000U);
    largest = 0;
    EXPECT_EQ(Single(bomb, ZSTD_decompress).status, RELIEF_TOO_LARGE);
    EXPECT_EQ(largest, 0U);
    EXPECT_TRUE(live.empty());
}

TEST(Single, ReportsThatMemoryIsFull) {
    std::mt19937 random(test::seedFrom(10));
    const std::vector<std::byte> bytes = test::written(placedPatches(random));
    allocations_left = 0;
    const Single single(bytes);
    allocations_left = std::numeric_limits<int>::max();
    EXPECT_EQ(single.status, RELIEF_OUT_OF_MEMORY);
    EXPECT_EQ(single.collider.texels, nullptr);
}

TEST(Single, LoadsFiles) {
    std::mt19937 random(test::seedFrom(11));
    const std::vector<std::byte> bytes = test::written(placedPatches(random));
    const test::TemporaryFolder folder;
    const auto status = [&](const std::string& path) {
        relief_collider collider;
        const relief_status result = relief_load(&collider, path.c_str(), nullptr);
        EXPECT_EQ(collider.texels != nullptr, result == RELIEF_OK);
        relief_close(&collider);
        return result;
    };
    const std::string good =
        folder.write("good.relief", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    EXPECT_EQ(status(good), RELIEF_OK);
    EXPECT_EQ(status(folder.write("empty.relief", "")), RELIEF_NOT_A_CONTAINER);
    EXPECT_EQ(status(folder.path() / "missing.relief"), RELIEF_CANNOT_READ);
    EXPECT_NE(status(folder.path()), RELIEF_OK);
    const std::filesystem::path huge = folder.write("huge.relief", "");
    std::filesystem::resize_file(huge, std::uintmax_t{1} << 30U);  // sparse
    largest = 0;
    EXPECT_EQ(status(huge), RELIEF_TOO_LARGE);
    EXPECT_EQ(largest, 0U);
    EXPECT_TRUE(live.empty());
}

TEST(Single, MessagesAreDifferentLines) {
    std::map<std::string, int> messages;
    for (int status = RELIEF_OK; status <= RELIEF_OUT_OF_MEMORY; ++status) {
        const std::string message = relief_message(static_cast<relief_status>(status));
        EXPECT_EQ(message.find('\n'), std::string::npos);
        EXPECT_NE(message, "unknown status");
        ++messages[message];
    }
    EXPECT_EQ(messages.size(), RELIEF_OUT_OF_MEMORY + 1U);
}

}  // namespace
}  // namespace relief
