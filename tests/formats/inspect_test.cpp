// `relief check FILE`: every issue code by a file that has it, every flipped bit, every truncation, and what
// is said of the maps that are left.
#include "formats/inspect.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <regex>
#include <set>

#include "formats/base/file_io.h"
#include "formats/base/hash.h"
#include "formats/container.h"
#include "formats/container_reader.h"
#include "tests/formats/analytic_shapes.h"
#include "tests/formats/sample_colliders.h"

namespace relief {
namespace {

using Bytes = std::vector<std::byte>;
using test::written;

Inspection inspected(const Bytes& bytes, const ContainerLimits& limits = {}) {
    const Result<Inspection> inspection = inspectContainer(bytes, limits);
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

std::set<IssueCode> codesOf(const Inspection& inspection) {
    std::set<IssueCode> codes;
    for (const Issue& issue : inspection.issues) {
        codes.insert(issue.code);
    }
    return codes;
}

template <class T>
void put(Bytes& bytes, std::size_t at, T value) {
    std::memcpy(bytes.data() + at, &value, sizeof(value));
}

/// The worked example of the README, whose page says what lies where, changed and with checksums that fit.
Bytes patched(const std::function<void(Bytes&)>& change) {
    Bytes bytes = written(test::readmeExample());
    change(bytes);
    test::mendChecksums(bytes);
    return bytes;
}

Bytes patched(std::size_t at, std::uint32_t value) {
    return patched([&](Bytes& bytes) { put(bytes, at, value); });
}

/// As `patched`, and the file's size in the header is that of the bytes.
Bytes resized(std::size_t size) {
    return patched([&](Bytes& bytes) {
        bytes.resize(size, std::byte{1});
        put<std::uint64_t>(bytes, 24, size);
    });
}

/// A sphere of radius 1 in a box of side `side`, seen along +z.
DepthMap sphereMap(double side, MapFormat format = MapFormat::kFixed8) {
    const auto sphere = test::makeSphere({0, 0, 0}, 1.0);
    return test::makeMap(*sphere, test::centeredFrame({0, 0, 0}, glm::dmat3(1.0), {side, side, side}), format,
                         Compare::kLess, 32, 32);
}

Collider soundCollider() {
    Collider collider;
    collider.bounds = {glm::vec3(-1.0F), glm::vec3(1.0F)};
    collider.unit = "m";
    collider.provenance = {
        "sphere.obj", "00112233445566778899aabbccddeeff", 12, "relief 0.1.0", {{"map", "fixed8"}}};
    collider.maps.push_back(sphereMap(2.5));
    return collider;
}

Bytes changed(const std::function<void(Collider&)>& change) {
    Collider collider = soundCollider();
    change(collider);
    return written(collider);
}

struct Case {
    IssueCode code;
    Bytes bytes;
    ContainerLimits limits = {};
};

/// For every code a file that has it; what else it has is its own.
std::vector<Case> casesOfEveryCode() {
    const Bytes good = written(test::readmeExample());
    const auto flipped = [&](std::size_t at) {
        Bytes bytes = good;
        bytes[at] ^= std::byte{1};
        return bytes;
    };
    const auto prefix = [&](std::size_t size) { return Bytes(good.begin(), good.begin() + size); };
    Bytes trailing = good;
    trailing.push_back(std::byte{0});
    // Metadata that ends where the file does, without room for all of it.
    Bytes no_room = prefix(200);
    put<std::uint64_t>(no_room, 24, 200);
    Bytes zstd = written(soundCollider(), 3);
    zstd[readContainerInfo(zstd)->payloads[0].offset] ^= std::byte{0x40};  // its magic number
    return {
        {IssueCode::kTooShort, prefix(63)},
        {IssueCode::kSignature, flipped(3)},
        {IssueCode::kMajorVersion, flipped(12)},
        {IssueCode::kHeaderChecksum, flipped(56)},
        {IssueCode::kHeaderField, patched(20, 1)},
        {IssueCode::kTruncated, prefix(good.size() - 1)},
        {IssueCode::kTrailingBytes, trailing},
        {IssueCode::kMetadataLimit, patched([](Bytes& bytes) {
             bytes.resize(64 + kContainerMetadataMax + 1);
             put<std::uint64_t>(bytes, 40, kContainerMetadataMax + 1);
         })},
        {IssueCode::kMetadataPlace, no_room},
        {IssueCode::kMetadataChecksum, flipped(48)},
        {IssueCode::kMetadataTable, patched(0x44, 0)},
        {IssueCode::kMapLimit, good, {.maps = 0}},
        {IssueCode::kNoMap, patched(0x80, 0)},
        {IssueCode::kBounds, patched(0x5c, 0x7fc00000)},
        {IssueCode::kUnit, patched(0x8c, 0x00000007)},
        {IssueCode::kProvenance, patched(0xd4, 0x58585858)},
        {IssueCode::kMaterials,
         [] {
             Collider collider = soundCollider();
             collider.materials.list = {{"oak, dark"}, {"oak, pale"}};
             Bytes bytes = written(collider);
             const std::string name = "oak, pale";
             const auto at = std::search(bytes.begin(), bytes.end(), name.begin(), name.end(),
                                         [](std::byte b, char c) { return b == std::byte(c); });
             const Bytes other = test::toBytes("oak, dark");
             std::copy(other.begin(), other.end(), at);
             test::mendChecksums(bytes);
             return bytes;
         }()},
        {IssueCode::kFrame, patched(0x164, 2)},
        {IssueCode::kMapSizeLimit, patched(0x164, 16385)},
        {IssueCode::kPayloadSize, patched(0x1b8, 40)},
        {IssueCode::kTexelLimit, good, {.texel_bytes = 35}},
        {IssueCode::kPayloadPlace, patched(0x1a8, 448)},
        {IssueCode::kPayloadEnd, patched(0x1a8, 576)},
        {IssueCode::kPadding, flipped(0x1c8)},
        {IssueCode::kBytesBehind, resized(good.size() + 1)},
        {IssueCode::kPayloadChecksum, flipped(0x210)},
        {IssueCode::kPayloadUnpack, zstd},
        {IssueCode::kTexels,
         [] {
             Collider collider = soundCollider();
             collider.maps[0] = sphereMap(2.5, MapFormat::kFloat32);
             Bytes bytes = written(collider);
             put(bytes, bytes.size() - 16, 7.0F);  // the last texel, empty, gets a normal
             return bytes;
         }()},
        {IssueCode::kLaterMinor,
         patched([](Bytes& bytes) { put<std::uint16_t>(bytes, 14, kContainerMinor + 1); })},
        {IssueCode::kNoMeshHash, changed([](Collider& c) { c.provenance.mesh_hash.clear(); })},
        {IssueCode::kNoToolVersion, changed([](Collider& c) { c.provenance.options.clear(); })},
        {IssueCode::kNoTriangles, changed([](Collider& c) { c.provenance.triangles = 0; })},
        {IssueCode::kNothingCovered,
         changed([](Collider& c) { std::ranges::fill(c.maps[0].texels, std::byte{0}); })},
    };
}

/// The rows of the README's table: codes and their severities.
std::vector<std::pair<IssueCode, std::string>> codesOfTheReadme() {
    const Result<Bytes> file = readFile(RELIEF_SOURCE_DIR "/formats/README.md");
    EXPECT_TRUE(file);
    const std::string text(reinterpret_cast<const char*>(file->data()), file->size());
    const std::regex row("\\| RLF-([0-9]{4}) \\| ([a-z]+) \\| [^|\n]+ \\|\n");
    std::vector<std::pair<IssueCode, std::string>> rows;
    for (std::sregex_iterator match(text.begin(), text.end(), row), end; match != end; ++match) {
        rows.emplace_back(static_cast<IssueCode>(std::stoi((*match)[1])), (*match)[2]);
    }
    return rows;
}

TEST(Inspect, EveryCodeHasAFileThatShowsIt) {
    std::set<IssueCode> shown;
    for (const Case& one : casesOfEveryCode()) {
        const Inspection inspection = inspected(one.bytes, one.limits);
        const Issue issue{one.code, -1, {}, {}};
        EXPECT_TRUE(codesOf(inspection).contains(one.code)) << issue.id() << " is not among\n"
                                                            << listed(inspection);
        const Result<Collider> read = readContainer(one.bytes, one.limits);
        EXPECT_EQ(inspection.damaged(), !read) << issue.id() << "\n" << listed(inspection);
        if (issue.severity() != Severity::kWarning) {
            EXPECT_TRUE(inspection.damaged()) << issue.id();
            EXPECT_EQ(inspection.errorCode(), read ? ErrorCode::kFailure : read.error().code) << issue.id();
        }
        shown.insert(one.code);
    }
    for (const auto& [code, severity] : codesOfTheReadme()) {
        EXPECT_TRUE(shown.erase(code) > 0) << "no file shows " << Issue{code, -1, {}, {}}.id();
    }
    EXPECT_TRUE(shown.empty()) << "the README lacks " << Issue{*shown.begin(), -1, {}, {}}.id();
}

TEST(Inspect, AWarningComesAlone) {
    for (const Case& one : casesOfEveryCode()) {
        const Issue issue{one.code, -1, {}, {}};
        const Inspection inspection = inspected(one.bytes, one.limits);
        if (issue.severity() == Severity::kWarning) {
            EXPECT_EQ(inspection.issues.size(), 1U) << listed(inspection);
        }
    }
}

TEST(Inspect, CodesOfTheReadmeAscendAndHaveTheirSeverity) {
    const auto rows = codesOfTheReadme();
    EXPECT_EQ(rows.size(), 33U);
    EXPECT_TRUE(std::ranges::is_sorted(rows));
    for (const auto& [code, severity] : rows) {
        const Issue issue{code, -1, {}, {}};
        EXPECT_EQ(wordOf(issue.severity()), severity) << issue.id();
    }
}

TEST(Inspect, SoundFilesHaveNothingToSay) {
    for (const int level : {0, 3}) {
        for (const Collider& collider : {soundCollider(), test::readmeExample()}) {
            const Inspection inspection = inspected(written(collider, level));
            EXPECT_TRUE(inspection.issues.empty()) << listed(inspection);
            EXPECT_EQ(inspection.header, PartState::kSound);
            EXPECT_EQ(inspection.metadata, PartState::kSound);
            ASSERT_EQ(inspection.maps.size(), 1U);
            EXPECT_EQ(inspection.maps[0].state, PartState::kSound);
        }
    }
    const Inspection one_texel = inspected(written(test::readmeExample()));
    EXPECT_DOUBLE_EQ(one_texel.maps[0].coverage.value(), 1.0 / 9.0);
}

TEST(Inspect, EveryFlippedBitIsNoticed) {
    for (const Bytes& good : {written(test::readmeExample()), written(test::oneMapOfEveryFormat(), 3)}) {
        Bytes bytes = good;
        for (std::size_t i = 0; i < bytes.size(); ++i) {
            for (int bit = 0; bit < 8; ++bit) {
                bytes[i] ^= std::byte(1 << bit);
                const Inspection inspection = inspected(bytes);
                ASSERT_TRUE(inspection.damaged()) << "byte " << i << ", bit " << bit;
                bytes[i] ^= std::byte(1 << bit);
            }
        }
    }
}

TEST(Inspect, EveryTruncationIsNoticed) {
    const Bytes good = written(test::oneMapOfEveryFormat());
    for (std::size_t size = 0; size < good.size(); ++size) {
        const Inspection inspection = inspected(Bytes(good.begin(), good.begin() + static_cast<long>(size)));
        ASSERT_TRUE(inspection.damaged()) << size;
        ASSERT_TRUE(codesOf(inspection).contains(size < 64 ? IssueCode::kTooShort : IssueCode::kTruncated))
            << size << "\n"
            << listed(inspection);
    }
}

TEST(Inspect, AgreesWithTheReaderOnMetadataOfAnyValues) {
    const Bytes good = written(test::oneMapOfEveryFormat());
    ContainerHeader header;
    std::memcpy(&header, good.data(), sizeof(header));
    for (std::size_t i = 64; i < 64 + header.metadata_size; ++i) {
        for (const int change : {0x01, 0x10, 0x80, 0xff}) {
            Bytes bytes = good;
            bytes[i] ^= std::byte(change);
            test::mendChecksums(bytes);
            const Inspection inspection = inspected(bytes);
            ASSERT_EQ(inspection.damaged(), !readContainer(bytes)) << "byte " << i << "\n"
                                                                   << listed(inspection);
        }
    }
}

std::vector<PartState> statesOf(const Inspection& inspection) {
    std::vector<PartState> states;
    for (const MapInspection& map : inspection.maps) {
        states.push_back(map.state);
    }
    return states;
}

TEST(Inspect, SaysWhatIsLeftOfADamagedFile) {
    Collider collider = soundCollider();
    collider.maps.push_back(sphereMap(3.0));
    collider.maps.push_back(sphereMap(3.5));
    const Bytes good = written(collider);
    const Result<ContainerInfo> info = readContainerInfo(good);
    ASSERT_TRUE(info);
    const auto at = [&](std::size_t map) { return static_cast<std::size_t>(info->payloads[map].offset); };
    using enum PartState;

    Bytes bytes = good;
    bytes[at(1) + 7] ^= std::byte{4};
    Inspection inspection = inspected(bytes);
    EXPECT_EQ(statesOf(inspection), (std::vector{kSound, kDamaged, kSound})) << listed(inspection);
    EXPECT_EQ(inspection.metadata, kSound);
    ASSERT_EQ(inspection.issues.size(), 1U) << listed(inspection);
    EXPECT_EQ(inspection.issues[0].map, 1);
    EXPECT_EQ(inspection.issues[0].offset, at(1));

    // The last map is cut off.
    bytes.assign(good.begin(), good.begin() + static_cast<long>(at(2) + 1));
    inspection = inspected(bytes);
    EXPECT_EQ(statesOf(inspection), (std::vector{kSound, kSound, kUnreadable})) << listed(inspection);
    EXPECT_EQ(inspection.header, kSound);

    // A header that is wrong says nothing against metadata that its own checksum vouches for.
    bytes = good;
    bytes[57] ^= std::byte{4};
    inspection = inspected(bytes);
    EXPECT_EQ(inspection.header, kDamaged);
    EXPECT_EQ(inspection.metadata, kSound);
    EXPECT_EQ(statesOf(inspection), (std::vector{kSound, kSound, kSound})) << listed(inspection);

    // Damaged metadata: the payloads are as they were written, but who knows what they are of.
    bytes = good;
    bytes[48] ^= std::byte{4};
    inspection = inspected(bytes);
    EXPECT_EQ(inspection.metadata, kDamaged);
    EXPECT_EQ(statesOf(inspection), (std::vector{kUnverified, kUnverified, kUnverified}))
        << listed(inspection);

    // Two faults are two issues.
    bytes = good;
    bytes[at(0)] ^= std::byte{1};
    bytes[at(2)] ^= std::byte{1};
    inspection = inspected(bytes);
    EXPECT_EQ(inspection.count(Severity::kError), 2U) << listed(inspection);
    EXPECT_EQ(statesOf(inspection), (std::vector{kDamaged, kSound, kDamaged}));
}

}  // namespace
}  // namespace relief
