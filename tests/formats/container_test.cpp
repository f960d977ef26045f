// SPDX-License-Identifier: Apache-2.0
// Containers round-trip, and every flipped bit or truncation is detected. `relief check FILE`: results for sound files,
// and for the remaining maps of damaged files; container_hostile_test has a file for every issue.
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "formats/base/file_io.h"
#include "formats/container.h"
#include "formats/container_reader.h"
#include "formats/inspect.h"
#include "formats/validate.h"
#include "tests/formats/analytic_shapes.h"
#include "tests/formats/sample_colliders.h"
#include "tests/results.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

using test::oneMapOfEveryFormat;
using test::written;

TEST(Container, RoundTripsAtEveryLevelAndAlignment) {
    const Collider collider = oneMapOfEveryFormat();
    for (int level = 0; level <= 19; ++level) {
        const std::vector<std::byte> bytes = written(collider, level);
        // Each level has another alignment; some have none.
        std::vector<std::byte> shifted(static_cast<std::size_t>(level % 16));
        const std::size_t shift = shifted.size();
        shifted.insert(shifted.end(), bytes.begin(), bytes.end());
        const Collider read = required(readContainer(std::span(shifted).subspan(shift)));
        EXPECT_EQ(read, collider) << "level " << level;
        EXPECT_EQ(written(read, level), bytes);
    }
}

TEST(Container, RoundTripsSmallestMapsAndEmptyTexts) {
    Collider collider;
    collider.bounds = {glm::vec3(0.0F), glm::vec3(0.0F)};
    collider.maps.push_back(test::emptyMap(test::centeredFrame({0, 0, 0}, glm::dmat3(1.0), {1e-20, 1, 1e20}),
                                           MapFormat::kFloat32, Compare::kLess, 3, 3));
    collider.maps.push_back(
        test::emptyMap(test::CubeFrame{{0, 0, 0}, glm::dmat3(1.0), {1, 1, 1}}, Compare::kGreater, 1));
    for (const int level : {0, 9}) {
        const Collider read = required(readContainer(written(collider, level)));
        EXPECT_EQ(read, collider);
    }
}

TEST(Container, RoundTripsAnimations) {
    Collider collider = oneMapOfEveryFormat();
    for (const char byte : {'R', 'L', 'A', '1', '\xff'}) {
        collider.animation.push_back(static_cast<std::byte>(byte));
    }
    const std::vector<std::byte> bytes = written(collider, 0);
    const Collider read = required(readContainer(bytes));
    EXPECT_EQ(read, collider);
    collider.animation.resize(std::size_t{17} << 20);
    expectError(writeContainer(collider, {}), ErrorCode::kLimit);
}

TEST(Container, InfoDescribesThePayloads) {
    for (const int level : {0, 19}) {
        const Collider collider = oneMapOfEveryFormat();
        const ContainerInfo info = required(readContainerInfo(written(collider, level)));
        EXPECT_EQ(info.major, 2);
        EXPECT_EQ(info.minor, 0);
        ASSERT_EQ(info.payloads.size(), collider.maps.size());
        for (std::size_t i = 0; i < info.payloads.size(); ++i) {
            const PayloadInfo& payload = info.payloads[i];
            EXPECT_EQ(payload.packing, level != 0 ? Packing::kZstd : Packing::kNone);
            EXPECT_EQ(payload.raw_size, collider.maps[i].texelBytes());
            EXPECT_EQ(payload.stored_size < payload.raw_size, level != 0);
        }
    }
}

TEST(Container, OldVersionsAreRejectedWithTheFix) {
    std::vector<std::byte> bytes = written(oneMapOfEveryFormat());
    const auto refusedAs = [&](std::uint16_t major, std::uint16_t minor) {
        std::memcpy(bytes.data() + 12, &major, sizeof(major));
        std::memcpy(bytes.data() + 14, &minor, sizeof(minor));
        const Result<Collider> read = readContainer(bytes);
        EXPECT_FALSE(read);
        EXPECT_EQ(inspectContainer(bytes)->issues.size(), 1U)
            << "only the version is an issue, not the checksum";
        return read ? "" : read.error().message;
    };
    EXPECT_EQ(refusedAs(1, 6), "container version 1.6; this program reads version 2: bake the mesh again");
    EXPECT_EQ(refusedAs(3, 0), "container version 3.0; this program reads version 2; use a newer Relief");
}

TEST(Container, IncompressiblePayloadsAreStored) {
    Collider collider = test::readmeExample();
    for (std::size_t i = 0; i < collider.maps[0].texels.size(); ++i) {
        collider.maps[0].texels[i] = static_cast<std::byte>(i * 37 + 11);
    }
    const std::vector<std::byte> bytes = written(collider, 19);
    EXPECT_FALSE(readContainerInfo(bytes)->payloads[0].packing == Packing::kZstd);
    EXPECT_EQ(bytes, written(collider, 0));
}

TEST(Damage, NoPrefixOrFlippedBitGoesUndetected) {
    for (const int level : {0, 19}) {
        std::vector<std::byte> bytes = written(oneMapOfEveryFormat(), level);
        for (std::size_t size = 0; size < bytes.size(); ++size) {
            // An exact-size copy, so that the address sanitizer detects overruns.
            const std::vector<std::byte> prefix(bytes.begin(),
                                                bytes.begin() + static_cast<std::ptrdiff_t>(size));
            const Result<Collider> read = readContainer(prefix);
            ASSERT_FALSE(read) << size << " of " << bytes.size() << " bytes";
            ASSERT_EQ(read.error().code, ErrorCode::kInvalidInput);
            ASSERT_FALSE(readContainerInfo(prefix));
            const std::vector<Issue> issues = inspectContainer(prefix)->issues;
            const IssueCode code = size < 64 ? IssueCode::kTooShort : IssueCode::kTruncated;
            ASSERT_TRUE(std::ranges::count(issues, code, &Issue::code) == 1) << size;
        }
        // Every bit of the header; the hashes detect any bit of the remaining bytes.
        for (std::size_t bit = 0; bit < 8 * bytes.size(); bit += bit < 8 * 64 ? 1 : 7) {
            const auto mask = static_cast<std::byte>(1U << bit % 8);
            bytes[bit / 8] ^= mask;
            ASSERT_FALSE(readContainer(bytes))
                << "byte " << bit / 8 << " bit " << bit % 8 << " level " << level;
            ASSERT_TRUE(inspectContainer(bytes)->damaged()) << "byte " << bit / 8 << " bit " << bit % 8;
            bytes[bit / 8] ^= mask;
        }
    }
}

TEST(Damage, OtherFilesAndTextModeTransfersAreNamed) {
    std::vector<std::byte> bytes = written(oneMapOfEveryFormat());
    bytes.erase(bytes.begin() + 8);  // CR LF became LF
    for (const std::vector<std::byte>& file : {bytes, test::toBytes(std::string(500, 'v'))}) {
        const Result<Collider> read = readContainer(file);
        ASSERT_FALSE(read);
        EXPECT_NE(read.error().message.find("not a .relief container, or a text-mode transfer"),
                  std::string::npos)
            << read.error().message;
    }
    EXPECT_FALSE(readContainer({}));
}

struct Refusal {
    const char* words;  // expected in the message
    std::function<void(Collider&)> breakIt;
    ErrorCode code = ErrorCode::kInvalidInput;
};

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

template <class T>
void poke(DepthMap& map, std::size_t texel, std::size_t channel, T value) {
    std::memcpy(map.texels.data() + texel * texelSize(map.format) + channel * sizeof(T), &value, sizeof(T));
}

/// The index of a texel that is not empty.
std::size_t fullTexel(const DepthMap& map) {
    for (std::uint32_t i = 0; i < map.width * map.height; ++i) {
        const Texel texel = decodeTexel(map.format, map.texelAt(0, i % map.width, i / map.width));
        if (texel.front) {
            return i;
        }
    }
    ADD_FAILURE() << "the sample map is empty";
    return 0;
}

const std::vector<Refusal>& refusals() {
    static const std::vector<Refusal> all = {
        {"there are no maps", [](auto& c) { c.maps.clear(); }},
        {"bounds are not finite", [](auto& c) { c.bounds.max.y = kInfinity; }},
        {"bounds are not finite", [](auto& c) { c.bounds.min.x = kNotANumber; }},
        {"exceeds bounds.max", [](auto& c) { c.bounds.min.z = 9.0F; }},
        {"exceeds bounds.max", [](auto& c) { c.bounds = {}; }},
        {"mesh_name contains '/'", [](auto& c) { c.provenance.mesh_name = "../x.obj"; }},
        {"mesh_name has 256 bytes", [](auto& c) { c.provenance.mesh_name.assign(256, 'a'); }},
        {"mesh_name is not UTF-8", [](auto& c) { c.provenance.mesh_name = "a\xff"; }},
        {"mesh_hash is neither", [](auto& c) { c.provenance.mesh_hash = "0123"; }},
        {"mesh_hash is neither", [](auto& c) { c.provenance.mesh_hash.assign(32, 'G'); }},
        {"unit has 17 bytes", [](auto& c) { c.unit.assign(17, 'm'); }},
        {"unit is not UTF-8", [](auto& c) { c.unit = std::string("m\0", 2); }},
        {"tool_version is not UTF-8", [](auto& c) { c.provenance.tool_version = "a\nb"; }},
        {"tool_version has", [](auto& c) { c.provenance.tool_version.assign(65, 'a'); }},
        {"options is not UTF-8",
         [](auto& c) {
             c.provenance.options = {{"map", "\x1b[2J"}};
         }},
        {"options has",
         [](auto& c) {
             c.provenance.options = {{"map", std::string(1 << 20, 'a')}};
         }},
        {"map 0: its format 6 is unknown", [](auto& c) { c.maps[0].format = static_cast<MapFormat>(6); }},
        {"map 2: its decode 2 is unknown", [](auto& c) { c.maps[2].decode = static_cast<Decode>(2); }},
        {"map 0: its compare 3 is unknown", [](auto& c) { c.maps[0].compare = static_cast<Compare>(3); }},
        {"does not match its format", [](auto& c) { c.maps[1].compare = Compare::kBoth; }},
        {"does not match its format", [](auto& c) { c.maps[2].compare = Compare::kLess; }},
        {"does not match its format", [](auto& c) { c.maps[4].compare = Compare::kGreater; }},
        {"map 3: its size 4x5 is not square", [](auto& c) { c.maps[3].height = 5; }},
        {"map 3: its size 0x0 is below 1x1", [](auto& c) { c.maps[3].width = c.maps[3].height = 0; }},
        {"map 1: its size 2x8 is below 3x3", [](auto& c) { c.maps[1].width = 2; }},
        {"map 1: its size 16385x8 exceeds", [](auto& c) { c.maps[1].width = 16385; }, ErrorCode::kLimit},
        {"map 1: it has 224 bytes of texels", [](auto& c) { c.maps[1].height = 9; }},
        {"map 1: it has 225 bytes of texels", [](auto& c) { c.maps[1].texels.push_back({}); }},
        {"object_to_map row 2 is not finite",
         [](auto& c) { c.maps[0].object_to_map.row[2].x = kNotANumber; }},
        {"object_to_map row 0 is not finite", [](auto& c) { c.maps[0].object_to_map.row[0].w = kInfinity; }},
        {"object_to_map row 1 is zero",
         [](auto& c) { c.maps[0].object_to_map.row[1] = glm::vec4(0, 0, 0, 1); }},
        {"rows 0 and 1 are not orthogonal",
         [](auto& c) { c.maps[0].object_to_map.row[1] = 3.0F * c.maps[0].object_to_map.row[0]; }},
        {"rows 1 and 2 are not orthogonal",
         [](auto& c) { c.maps[0].object_to_map.row[2] += 3e-4F * c.maps[0].object_to_map.row[1]; }},
        {"rows 0 and 2 are not orthogonal",
         [](auto& c) { c.maps[4].object_to_map.row[0] += 0.1F * c.maps[4].object_to_map.row[2]; }},
        {"object_per_map (0, ", [](auto& c) { c.maps[3].object_per_map.x = 0.0F; }},
        {"is not positive and finite", [](auto& c) { c.maps[0].object_per_map.z = -1.0F; }},
        {"is not positive and finite", [](auto& c) { c.maps[0].object_per_map.y = kNotANumber; }},
        {"is not positive and finite", [](auto& c) { c.maps[0].object_per_map.y = kInfinity; }},
        {"object_per_map.z is 2.0", [](auto& c) { c.maps[0].object_per_map.z = 2.01F; }},
        {"map 0: texel (0, 0) is empty", [](auto& c) { poke(c.maps[0], 0, 0, 1.0F); }},
        {"neither -1 nor in 0...1", [](auto& c) { poke(c.maps[0], fullTexel(c.maps[0]), 3, 1.5F); }},
        {"neither -1 nor in 0...1", [](auto& c) { poke(c.maps[0], fullTexel(c.maps[0]), 3, -0.5F); }},
        {"not finite", [](auto& c) { poke(c.maps[0], fullTexel(c.maps[0]), 3, kNotANumber); }},
        {"not finite", [](auto& c) { poke(c.maps[0], 0, 1, kInfinity); }},
        {"not of unit length", [](auto& c) { poke(c.maps[0], fullTexel(c.maps[0]), 0, 1.5F); }},
        {"map 2: texel (0, 0) has a half-float", [](auto& c) { poke<std::uint16_t>(c.maps[2], 0, 2, 1); }},
        {"half-float depth", [](auto& c) { poke<std::uint16_t>(c.maps[2], 0, 2, 0x03ff); }},
        {"half-float depth", [](auto& c) { poke<std::uint16_t>(c.maps[2], 0, 3, 0x3c01); }},
        {"half-float depth", [](auto& c) { poke<std::uint16_t>(c.maps[2], 0, 2, 0x8400); }},
        {"1025 maps exceed", [](auto& c) { c.maps.assign(1025, c.maps[3]); }, ErrorCode::kLimit},
    };
    return all;
}

TEST(Writer, RejectsEverythingThatTheReaderRejects) {
    for (const Refusal& refusal : refusals()) {
        Collider collider = oneMapOfEveryFormat();
        refusal.breakIt(collider);
        const Result<std::vector<std::byte>> bytes = writeContainer(collider);
        ASSERT_FALSE(bytes) << refusal.words;
        EXPECT_EQ(bytes.error().code, refusal.code) << bytes.error().message;
        EXPECT_NE(bytes.error().message.find(refusal.words), std::string::npos)
            << "\"" << bytes.error().message << "\" does not contain \"" << refusal.words << "\"";
    }
}

TEST(Writer, RejectsUnknownCompressionLevels) {
    for (const int level : {-1, 20, 1000}) {
        expectError(writeContainer(oneMapOfEveryFormat(), {level}), ErrorCode::kUsage);
    }
}

TEST(Validate, LimitsMapSizeOnBothAxes) {
    DepthMap map = oneMapOfEveryFormat().maps[0];
    for (std::uint32_t DepthMap::*const side : {&DepthMap::width, &DepthMap::height}) {
        DepthMap large = map;
        large.*side = kMapSizeMax;
        EXPECT_TRUE(validateFrame(large));
        ++(large.*side);
        ASSERT_FALSE(validateFrame(large));
        EXPECT_EQ(validateFrame(large).error().code, ErrorCode::kLimit);
        large.*side = kMapSizeMin - 1;
        EXPECT_FALSE(validateFrame(large));
    }
}

TEST(Validate, AcceptsAnyHandednessAndScaleButNoShear) {
    DepthMap map = oneMapOfEveryFormat().maps[0];
    map.object_to_map.row[0] *= -1.0F;
    EXPECT_TRUE(validateFrame(map));
    // Rows of any length may be up to 1e-4 off a right angle.
    for (const auto& [cosine, valid] :
         {std::pair(0.9e-4F, true), {-0.9e-4F, true}, {1.2e-4F, false}, {-1.2e-4F, false}}) {
        map.object_to_map.row[0] = {1e-3F, cosine * 1e-3F, 0, 7};
        map.object_to_map.row[1] = {0, 1e5F, 0, -3};
        map.object_to_map.row[2] = {0, 0, 1, 0};
        map.object_per_map = {1e3F, 1e-5F, 1};
        EXPECT_EQ(validateFrame(map).has_value(), valid) << cosine;
    }
    // A sheared frame whose rows have the lengths of the columns of its inverse.
    map.object_to_map.row[0] = {1, 1, 0, 0};
    map.object_to_map.row[1] = {0, 1, 0, 0};
    map.object_per_map = {1, std::sqrt(2.0F), 1};
    EXPECT_FALSE(validateFrame(map));
    for (const float scale : {1e-30F, 1e-10F, 1e10F, 1e30F}) {
        map.object_to_map = {};
        for (glm::vec4& row : map.object_to_map.row) {
            row *= scale;
        }
        map.object_per_map = glm::vec3(1.0F / scale);
        EXPECT_TRUE(validateFrame(map)) << scale;
    }
}

TEST(Validate, PlainTextIsUtf8WithoutControls) {
    for (const char* text : {"", "bunny.obj", "Kugel – 球 🐇", "\xed\x9f\xbf", "\xf4\x8f\xbf\xbf"}) {
        EXPECT_TRUE(isPlainText(text)) << text;
    }
    for (const char* text : {"a\tb", "\x7f", "\xc2\x80", "\xc0\x80", "\xc1\xbf", "\xe0\x80\xaf",
                             "\xed\xa0\x80", "\xf0\x80\x80\x80", "\xf4\x90\x80\x80", "\xf8\x88\x80\x80\x80",
                             "\x80", "\xc3", "\xe7\x90", "\xc3(", "\xff"}) {
        EXPECT_FALSE(isPlainText(text)) << testing::PrintToString(text);
    }
    EXPECT_FALSE(isPlainText(std::string("\0", 1)));
}

TEST(Files, SaveAndLoadNameTheFile) {
    const test::TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "a.relief";
    ASSERT_TRUE(saveCollider(path, oneMapOfEveryFormat(), {3}));
    const Collider read = required(loadCollider(path));
    EXPECT_EQ(read, oneMapOfEveryFormat());
    const auto expectNamed = [](const auto& result, ErrorCode code, const char* name) {
        ASSERT_FALSE(result);
        EXPECT_EQ(result.error().code, code);
        EXPECT_NE(result.error().message.find(name), std::string::npos);
    };
    expectNamed(loadCollider(folder.path() / "b.relief"), ErrorCode::kIo, "b.relief");
    ASSERT_TRUE(writeFile(path, test::toBytes("solid cube")));
    expectNamed(loadCollider(path), ErrorCode::kInvalidInput, "a.relief");
    ASSERT_TRUE(writeFile(folder.path() / "w.json", test::toBytes("{}")));
    expectNamed(loadCollider(folder.path() / "w.json"), ErrorCode::kInvalidInput,
                "name one of the containers");
    Collider broken = oneMapOfEveryFormat();
    broken.maps[0].width = 0;
    expectNamed(saveCollider(path, broken), ErrorCode::kInvalidInput, "a.relief");
    EXPECT_EQ(*readFile(path), test::toBytes("solid cube")) << "the old file stays";
}

using Bytes = std::vector<std::byte>;
using test::written;

Inspection inspected(const Bytes& bytes) {
    const Result<Inspection> inspection = inspectContainer(bytes);
    EXPECT_TRUE(inspection);
    return inspection.value_or(Inspection{});
}

std::string listed(const Inspection& inspection) {
    std::string text;
    for (const Issue& issue : inspection.issues) {
        text += issue.id() + " map " + std::to_string(issue.map) + ": " + issue.message + "\n";
    }
    return text;
}

std::vector<PartState> statesOf(const Inspection& inspection) {
    std::vector<PartState> states;
    for (const MapInspection& map : inspection.maps) {
        states.push_back(map.state);
    }
    return states;
}

TEST(Inspect, SoundFilesHaveNoIssues) {
    for (const int level : {0, 3}) {
        for (const Collider& collider : {test::oneMapOfEveryFormat(), test::readmeExample()}) {
            const Inspection inspection = inspected(written(collider, level));
            EXPECT_TRUE(inspection.issues.empty()) << listed(inspection);
            EXPECT_EQ(inspection.header, PartState::kSound);
            EXPECT_EQ(inspection.metadata, PartState::kSound);
            EXPECT_EQ(statesOf(inspection), std::vector(collider.maps.size(), PartState::kSound));
        }
    }
    const Inspection one_texel = inspected(written(test::readmeExample()));
    EXPECT_DOUBLE_EQ(one_texel.maps[0].coverage.value(), 1.0 / 9.0);
}

TEST(Inspect, ListsTheIntactMapsOfADamagedFile) {
    Collider collider = test::readmeExample();
    collider.maps.resize(3, collider.maps[0]);
    const Bytes good = written(collider);
    const ContainerInfo info = required(readContainerInfo(good));
    const auto at = [&](std::size_t map) { return static_cast<std::size_t>(info.payloads[map].offset); };
    using enum PartState;

    Bytes bytes = good;
    bytes[at(1) + 7] ^= std::byte{4};
    Inspection inspection = inspected(bytes);
    EXPECT_EQ(statesOf(inspection), (std::vector{kSound, kDamaged, kSound})) << listed(inspection);
    EXPECT_EQ(inspection.metadata, kSound);
    ASSERT_EQ(inspection.issues.size(), 1U) << listed(inspection);
    EXPECT_EQ(inspection.issues[0].map, 1);
    EXPECT_EQ(inspection.issues[0].offset, at(1));

    // The last map is truncated.
    bytes.assign(good.begin(), good.begin() + static_cast<long>(at(2) + 1));
    inspection = inspected(bytes);
    EXPECT_EQ(statesOf(inspection), (std::vector{kSound, kSound, kUnreadable})) << listed(inspection);
    EXPECT_EQ(inspection.header, kSound);

    // A damaged header does not invalidate metadata whose own checksum matches.
    bytes = good;
    bytes[57] ^= std::byte{4};
    inspection = inspected(bytes);
    EXPECT_EQ(inspection.header, kDamaged);
    EXPECT_EQ(inspection.metadata, kSound);
    EXPECT_EQ(statesOf(inspection), (std::vector{kSound, kSound, kSound})) << listed(inspection);

    // Damaged metadata: the payloads are intact, but cannot be assigned to maps.
    bytes = good;
    bytes[48] ^= std::byte{4};
    inspection = inspected(bytes);
    EXPECT_EQ(inspection.metadata, kDamaged);
    EXPECT_EQ(statesOf(inspection), (std::vector{kUnverified, kUnverified, kUnverified}))
        << listed(inspection);

    // Two faults give two issues.
    bytes = good;
    bytes[at(0)] ^= std::byte{1};
    bytes[at(2)] ^= std::byte{1};
    inspection = inspected(bytes);
    EXPECT_EQ(inspection.count(Severity::kError), 2U) << listed(inspection);
    EXPECT_EQ(statesOf(inspection), (std::vector{kDamaged, kSound, kDamaged}));
}

}  // namespace
}  // namespace relief::test
