// SPDX-License-Identifier: Apache-2.0
// Hand-made containers with correct checksums and one false value each: checksums detect accidents, the reader's
// validation detects attacks. Every issue code of formats/README.md has a file here that triggers it.
#include <flatbuffers/flatbuffers.h>
#include <gtest/gtest.h>
#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <optional>
#include <random>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "collider_generated.h"
#include "formats/base/file_io.h"
#include "formats/base/hash.h"
#include "formats/container.h"
#include "formats/container_reader.h"
#include "formats/inspect.h"
#include "formats/validate.h"
#include "tests/formats/sample_colliders.h"
#include "tests/results.h"

namespace relief {
namespace {

using flatbuffers::FlatBufferBuilder;
using flatbuffers::voffset_t;
using Bytes = std::vector<std::byte>;

const Bytes kRaw(16 * 16 * 4, std::byte{0x7f});

struct MapRecipe {
    std::uint8_t format = 1;  // fixed8
    std::uint8_t compare = 0;
    std::uint8_t compression = 0;
    std::uint8_t decode = 0;
    std::uint32_t width = 16;
    std::uint32_t height = 16;
    std::vector<fb::Row> rows = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
    fb::Vec3 object_per_map = {1, 1, 1};
    Bytes stored = kRaw;
    std::optional<std::uint64_t> offset;
    std::optional<std::uint64_t> stored_size;
    std::optional<std::uint64_t> raw_size;
    std::uint64_t hash_change = 0;
};

struct Recipe {
    fb::Vec3 bounds_min = {0, 0, 0};
    fb::Vec3 bounds_max = {1, 1, 1};
    std::string unit = "m";
    std::string mesh_name = "a.obj";
    std::string mesh_hash = "00112233445566778899aabbccddeeff";
    std::string tool_version = "relief 9.9";
    std::uint64_t triangles = 12;
    std::string option = "fixed8";  // the value of "map"; empty: there are no options
    std::vector<MapRecipe> maps = std::vector<MapRecipe>(2);
    bool later_fields = false;  // fields that a later minor version could append
    const char* identifier = "RLF2";
    std::function<void(ContainerHeader&)> header;  // before its checksum
    std::function<void(Bytes&)> bytes;             // after all checksums
};

constexpr voffset_t kLaterField = 4 + 2 * 30;

Bytes metadataOf(const Recipe& recipe, const std::vector<fb::Payload>& payloads) {
    FlatBufferBuilder builder;
    std::vector<flatbuffers::Offset<fb::Map>> maps;
    for (std::size_t i = 0; i < recipe.maps.size(); ++i) {
        const MapRecipe& map = recipe.maps[i];
        const fb::Transform object_to_map(map.rows[0], map.rows[1], map.rows[2]);
        fb::MapBuilder table(builder);
        table.add_format(static_cast<fb::Format>(map.format));
        table.add_compare(static_cast<fb::Compare>(map.compare));
        table.add_width(map.width);
        table.add_height(map.height);
        table.add_object_to_map(&object_to_map);
        table.add_object_per_map(&map.object_per_map);
        table.add_encloses(true);
        table.add_empty_is_outside(true);
        table.add_compression(static_cast<fb::Compression>(map.compression));
        table.add_payload(&payloads[i]);
        table.add_decode(static_cast<fb::Decode>(map.decode));
        if (recipe.later_fields) {
            builder.AddElement<std::uint64_t>(kLaterField, 77, 0);
        }
        maps.push_back(table.Finish());
    }
    const auto map_vector = builder.CreateVector(maps);
    std::vector<flatbuffers::Offset<fb::Option>> options;
    if (!recipe.option.empty()) {
        options.push_back(
            fb::CreateOption(builder, builder.CreateString("map"), builder.CreateString(recipe.option)));
    }
    const auto provenance = fb::CreateProvenance(
        builder, builder.CreateString(recipe.mesh_name), builder.CreateString(recipe.mesh_hash),
        recipe.triangles, builder.CreateString(recipe.tool_version), builder.CreateVector(options));
    const auto unit = builder.CreateString(recipe.unit);
    fb::ColliderBuilder collider(builder);
    collider.add_bounds_min(&recipe.bounds_min);
    collider.add_bounds_max(&recipe.bounds_max);
    collider.add_unit(unit);
    collider.add_provenance(provenance);
    collider.add_maps(map_vector);
    if (recipe.later_fields) {
        builder.AddOffset(kLaterField, unit);
    }
    builder.Finish(collider.Finish(), recipe.identifier);
    const auto bytes = std::as_bytes(std::span(builder.GetBufferPointer(), builder.GetSize()));
    return {bytes.begin(), bytes.end()};
}

Bytes fileOf(const Recipe& recipe) {
    std::vector<fb::Payload> payloads(recipe.maps.size());
    const std::size_t metadata_size = metadataOf(recipe, payloads).size();
    Bytes bytes(64 + metadata_size);
    for (std::size_t i = 0; i < recipe.maps.size(); ++i) {
        const MapRecipe& map = recipe.maps[i];
        bytes.resize((bytes.size() + 63) / 64 * 64);
        const std::uint64_t raw_size = std::uint64_t{map.width} * map.height * 4;
        payloads[i] =
            fb::Payload(map.offset.value_or(bytes.size()), map.stored_size.value_or(map.stored.size()),
                        map.raw_size.value_or(raw_size), xxh3_64(map.stored) ^ map.hash_change);
        bytes.insert(bytes.end(), map.stored.begin(), map.stored.end());
    }
    const Bytes metadata = metadataOf(recipe, payloads);
    EXPECT_EQ(metadata.size(), metadata_size);
    std::copy(metadata.begin(), metadata.end(), bytes.begin() + 64);
    ContainerHeader header;
    header.file_size = bytes.size();
    header.metadata_size = metadata.size();
    header.metadata_hash = xxh3_64(metadata);
    if (recipe.header) {
        recipe.header(header);
    }
    header.header_hash = header.computeHash();
    std::memcpy(bytes.data(), &header, sizeof(header));
    if (recipe.bytes) {
        recipe.bytes(bytes);
    }
    return bytes;
}

template <class F>
Recipe with(F change) {
    Recipe recipe;
    change(recipe);
    return recipe;
}

/// A file with one field missing from one of the metadata tables.
Bytes without(const std::function<const void*(const fb::Collider&)>& table_of, voffset_t field) {
    Bytes bytes = fileOf({});
    const std::byte* metadata = bytes.data() + sizeof(ContainerHeader);
    const void* table = table_of(*flatbuffers::GetRoot<fb::Collider>(metadata));
    const std::ptrdiff_t at = static_cast<const std::byte*>(table) - bytes.data() -
                              flatbuffers::ReadScalar<flatbuffers::soffset_t>(table) + field;
    EXPECT_NE(flatbuffers::ReadScalar<voffset_t>(bytes.data() + at), 0);
    flatbuffers::WriteScalar<voffset_t>(bytes.data() + at, 0);
    test::fixChecksums(bytes);
    return bytes;
}

ErrorCode errorOf(IssueCode code) {
    using enum IssueCode;
    const std::set<IssueCode> limits = {kMetadataLimit, kMapLimit, kMapSizeLimit, kTexelLimit};
    return code == kMajorVersion   ? ErrorCode::kUnsupported
           : limits.contains(code) ? ErrorCode::kLimit
                                   : ErrorCode::kInvalidInput;
}

/// Codes expected so far.
std::set<IssueCode>& shownCodes() {
    static std::set<IssueCode> codes;
    return codes;
}

/// Expects an issue with this code and map, and the same error from the readers.
void expectIssue(const Bytes& bytes, IssueCode code, int map = -1, const ContainerLimits& limits = {}) {
    const Issue expected{code, map, {}, {}};
    SCOPED_TRACE(expected.id());
    shownCodes().insert(code);
    const Inspection inspection = required(inspectContainer(bytes, limits));
    std::string listed;
    bool found = false;
    for (const Issue& issue : inspection.issues) {
        listed += issue.id() + " map " + std::to_string(issue.map) + ": " + issue.message + "\n";
        found = found || (issue.code == code && issue.map == map);
    }
    EXPECT_TRUE(found) << listed;
    const Result<Collider> read = readContainer(bytes, limits);
    EXPECT_EQ(inspection.damaged(), !read) << listed;
    if (expected.severity() == Severity::kWarning) {
        EXPECT_TRUE(read);
        EXPECT_EQ(inspection.issues.size(), 1U) << listed;
        return;
    }
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, errorOf(code)) << read.error().message;
    EXPECT_EQ(inspection.errorCode(), errorOf(code)) << listed;
    EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
}

/// Applies the change to the second of two maps.
void expectMapIssue(IssueCode code, const std::function<void(MapRecipe&)>& change) {
    expectIssue(fileOf(with([&](auto& r) { change(r.maps[1]); })), code, 1);
}

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

Bytes compress(const Bytes& raw) {
    Bytes bytes(ZSTD_compressBound(raw.size()));
    bytes.resize(ZSTD_compress(bytes.data(), bytes.size(), raw.data(), raw.size(), 3));
    return bytes;
}

/// The second of two maps is compressed, with the given frame.
Recipe zstdRecipe(const Bytes& frame) {
    return with([&](auto& r) {
        r.maps[1].compression = 1;
        r.maps[1].stored = frame;
    });
}

TEST(Crafted, UnchangedRecipeIsValid) {
    for (const Recipe& recipe : {Recipe{}, zstdRecipe(compress(kRaw))}) {
        const Collider read = required(readContainer(fileOf(recipe)));
        ASSERT_EQ(read.maps.size(), 2U);
        EXPECT_EQ(read.maps[1].texels, kRaw);
    }
}

TEST(Crafted, LaterMinorVersionsAreRead) {
    for (const std::uint16_t minor : {std::uint16_t{1}, std::uint16_t{7}, std::uint16_t{65535}}) {
        const Bytes bytes = fileOf(with([&](auto& r) {
            r.header = [=](ContainerHeader& h) { h.minor = minor; };
            r.later_fields = true;
        }));
        const Result<Collider> read = readContainer(bytes);
        ASSERT_TRUE(read) << read.error().message;
        EXPECT_EQ(readContainerInfo(bytes)->minor, minor);
    }
}

void expectHeaderFaults() {
    using enum IssueCode;
    const std::pair<IssueCode, std::function<void(ContainerHeader&)>> faults[] = {
        {kMajorVersion, [](auto& h) { h.major = 1; }},
        {kMajorVersion, [](auto& h) { h.major = 0; }},
        {kHeaderField, [](auto& h) { h.header_size = 72; }},
        {kHeaderField, [](auto& h) { h.reserved = 1; }},
        {kHeaderField, [](auto& h) { h.metadata_offset = 128; }},
        {kHeaderField, [](auto& h) { h.metadata_offset = ~std::uint64_t{0}; }},
        {kTruncated, [](auto& h) { h.file_size += 1; }},
        {kTruncated, [](auto& h) { h.file_size = ~std::uint64_t{0}; }},
        {kTrailingBytes, [](auto& h) { h.file_size -= 1; }},
        {kTrailingBytes, [](auto& h) { h.file_size = 0; }},
        {kMetadataLimit, [](auto& h) { h.metadata_size = ~std::uint64_t{0}; }},
        {kMetadataPlace, [](auto& h) { h.metadata_size = 1 << 24; }},
        {kMetadataChecksum, [](auto& h) { h.metadata_hash ^= 1; }},
        {kLaterMinor, [](auto& h) { h.minor = kContainerMinor + 1; }},
    };
    for (const auto& [code, fault] : faults) {
        Recipe recipe;
        recipe.header = fault;
        expectIssue(fileOf(recipe), code);
    }
    const Bytes good = fileOf({});
    expectIssue({good.begin(), good.begin() + 63}, kTooShort);
    for (const auto& [at, code] : {std::pair(3, kSignature), {56, kHeaderChecksum}}) {
        Bytes bytes = good;
        bytes[static_cast<std::size_t>(at)] ^= std::byte{1};
        expectIssue(bytes, code);
    }
    // A later major version may change everything else, so its error comes first.
    expectIssue(fileOf(with([](auto& r) {
                    r.header = [](auto& h) { h.major = 256; };
                    r.bytes = [](Bytes& b) { b[60] ^= std::byte{1}; };
                })),
                kMajorVersion);
}

void expectMetadataFaults() {
    using enum IssueCode;
    // container_test covers all rules for values: reader and writer share them.
    const std::pair<IssueCode, std::function<void(Recipe&)>> faults[] = {
        {kMetadataTable, [](auto& r) { r.identifier = "RLF1"; }},
        {kNoMap, [](auto& r) { r.maps.clear(); }},
        {kBounds,
         [](auto& r) {
             r.bounds_max = {1, kNaN, 1};
         }},
        {kUnit, [](auto& r) { r.unit = "a unit of great length"; }},
        {kProvenance, [](auto& r) { r.mesh_name = std::string("a\0.obj", 6); }},
        {kProvenance, [](auto& r) { r.mesh_hash = "00112233445566778899AABBCCDDEEFF"; }},
        {kProvenance, [](auto& r) { r.tool_version = "\x1b]0;owned\x07"; }},
        {kProvenance, [](auto& r) { r.option.assign((1 << 20) + 1, 'o'); }},
        {kNoMeshHash, [](auto& r) { r.mesh_hash.clear(); }},
        {kNoToolVersion, [](auto& r) { r.option.clear(); }},
        {kNoToolVersion, [](auto& r) { r.tool_version.clear(); }},
        {kNoTriangles, [](auto& r) { r.triangles = 0; }},
    };
    for (const auto& [code, fault] : faults) {
        expectIssue(fileOf(with(fault)), code);
    }
    for (const std::uint64_t size : {0, 1, 3, 7, 8, 12, 40}) {
        Bytes bytes = fileOf({});
        std::memcpy(bytes.data() + 40, &size, sizeof(size));
        test::fixChecksums(bytes);
        expectIssue(bytes, kMetadataTable);
    }
    const auto collider = [](const fb::Collider& c) -> const void* { return &c; };
    const auto provenance = [](const fb::Collider& c) -> const void* { return c.provenance(); };
    const auto map = [](const fb::Collider& c) -> const void* { return c.maps()->Get(1); };
    for (const voffset_t field :
         {fb::Collider::VT_BOUNDS_MIN, fb::Collider::VT_BOUNDS_MAX, fb::Collider::VT_UNIT,
          fb::Collider::VT_PROVENANCE, fb::Collider::VT_MAPS}) {
        expectIssue(without(collider, field), kMetadataTable);
    }
    for (const voffset_t field :
         {fb::Provenance::VT_MESH_NAME, fb::Provenance::VT_MESH_HASH, fb::Provenance::VT_TOOL_VERSION}) {
        expectIssue(without(provenance, field), kMetadataTable);
    }
    for (const voffset_t field :
         {fb::Map::VT_OBJECT_TO_MAP, fb::Map::VT_OBJECT_PER_MAP, fb::Map::VT_PAYLOAD}) {
        expectIssue(without(map, field), kMetadataTable);
    }
    // Two materials with the same name.
    Collider with_materials = test::readmeExample();
    with_materials.materials.list = {{"oak, dark"}, {"oak, pale"}};
    Bytes bytes = test::written(with_materials);
    const Bytes name = test::toBytes("oak, pale");
    const Bytes other = test::toBytes("oak, dark");
    std::copy(other.begin(), other.end(), std::search(bytes.begin(), bytes.end(), name.begin(), name.end()));
    test::fixChecksums(bytes);
    expectIssue(bytes, kMaterials);
    // A part of a material node.
    with_materials.materials = test::someMaterials();
    bytes = test::written(with_materials);
    const fb::Materials* materials = fb::GetCollider(bytes.data() + sizeof(ContainerHeader))->materials();
    const std::uint32_t size = materials->nodes()->size() - 1;
    ASSERT_EQ(materials->nodes_size(), size + 1) << "uncompressed";
    const auto offset = reinterpret_cast<const std::byte*>(materials->nodes()) - bytes.data();
    std::memcpy(bytes.data() + offset, &size, sizeof(size));
    auto* table = reinterpret_cast<flatbuffers::Table*>(const_cast<fb::Materials*>(materials));
    table->SetField<std::uint32_t>(fb::Materials::VT_NODES_SIZE, size, 0);
    test::fixChecksums(bytes);
    expectIssue(bytes, kMaterials);
}

void expectPayloadFaults() {
    using enum IssueCode;
    const std::uint64_t first = readContainerInfo(fileOf({}))->payloads[0].offset;
    const std::pair<IssueCode, std::function<void(MapRecipe&)>> faults[] = {
        {kFrame, [](auto& m) { m.format = 6; }},
        {kFrame, [](auto& m) { m.format = 255; }},
        {kFrame, [](auto& m) { m.format = 4; }},  // "less" of a front-back map
        {kFrame, [](auto& m) { m.compare = 3; }},
        {kFrame, [](auto& m) { m.decode = 2; }},
        {kFrame, [](auto& m) { m.rows[2] = m.rows[0]; }},
        {kMapSizeLimit, [](auto& m) { m.width = 0xffffffff; }},
        {kPayloadSize, [](auto& m) { m.compression = 2; }},
        {kPayloadSize, [](auto& m) { m.compression = 1; }},  // compressed, but not smaller
        {kPayloadSize, [](auto& m) { m.raw_size = 1023; }},
        {kPayloadSize, [](auto& m) { m.raw_size = ~std::uint64_t{0}; }},
        {kPayloadSize, [](auto& m) { m.stored_size = 1023; }},
        {kPayloadSize, [](auto& m) { m.stored_size = ~std::uint64_t{0}; }},
        {kPayloadSize, [](auto& m) { m.height = 17; }},
        {kPayloadSize,  // 1 GiB from 100 bytes: below the smallest zstd frame
         [](auto& m) {
             m.compression = 1;
             m.width = m.height = 16384;
             m.stored.resize(100);
         }},
        {kPayloadPlace, [&](auto& m) { m.offset = first; }},
        {kPayloadPlace, [&](auto& m) { m.offset = first + 1024 + 1; }},
        {kPayloadPlace, [&](auto& m) { m.offset = first + 1024 + 64; }},
        {kPayloadPlace, [](auto& m) { m.offset = 0; }},
        {kPayloadPlace, [](auto& m) { m.offset = ~std::uint64_t{0} - 63; }},
        {kPayloadEnd,
         [](auto& m) {
             m.height = 17;
             m.stored_size = 16 * 17 * 4;
         }},
        {kPayloadChecksum, [](auto& m) { m.hash_change = 1; }},
        {kNothingCovered, [](auto& m) { std::ranges::fill(m.stored, std::byte{0}); }},
    };
    for (const auto& [code, fault] : faults) {
        expectMapIssue(code, fault);
    }
    expectIssue(fileOf(with([](auto& r) { r.maps[0].offset = 64; })), kPayloadPlace, 0);
    // Bytes that belong to no section.
    expectIssue(fileOf(with([](auto& r) {
                    r.bytes = [](Bytes& b) {
                        b.resize(b.size() + 64);
                        const std::uint64_t size = b.size();
                        std::memcpy(b.data() + 24, &size, sizeof(size));
                        test::fixChecksums(b);
                    };
                })),
                kBytesAfterPayload);
    expectIssue(fileOf(with([&](auto& r) { r.bytes = [&](Bytes& b) { b[first - 1] = std::byte{1}; }; })),
                kPadding, 0);
}

void expectLimits() {
    const Bytes bytes = fileOf({});
    EXPECT_TRUE(readContainer(bytes, {2, 2048}));
    expectIssue(bytes, IssueCode::kMapLimit, -1, {1, 2048});
    expectIssue(bytes, IssueCode::kTexelLimit, 1, {2, 2047});
    // Each map is below the limit, but their sum exceeds it.
    const Result<Collider> read = readContainer(fileOf(with([](auto& r) {
        for (MapRecipe& map : r.maps) {
            map.compression = 1;
            map.width = map.height = 16384;
            map.stored.resize(40'000);
        }
        r.maps.push_back(r.maps[0]);
    })));
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, ErrorCode::kLimit) << read.error().message;
}

void expectZstdFaults() {
    const Bytes frame = compress(kRaw);
    std::vector<Bytes> faults = {frame, frame, {frame.begin(), frame.end() - 1}, Bytes(100), {}};
    faults[0].push_back(std::byte{0});
    faults[1].insert(faults[1].end(), frame.begin(), frame.end());
    faults.push_back(compress(Bytes(1023)));
    faults.push_back(compress(Bytes(1025)));
    // 16 MiB that must not be decompressed.
    faults.push_back(compress(Bytes(std::size_t{16} << 20)));
    ASSERT_LT(faults.back().size(), 1024U);
    // A skippable frame, and a frame without a content size.
    const std::uint32_t skippable[] = {0x184d2a50, 4, 0};
    const auto words = std::as_bytes(std::span(skippable));
    faults.emplace_back(words.begin(), words.end());
    ZSTD_CCtx* context = ZSTD_createCCtx();
    ZSTD_CCtx_setParameter(context, ZSTD_c_contentSizeFlag, 0);
    Bytes unstated(2000);
    unstated.resize(ZSTD_compress2(context, unstated.data(), unstated.size(), kRaw.data(), kRaw.size()));
    ZSTD_freeCCtx(context);
    faults.push_back(unstated);
    // Frames that claim 1024 bytes but contain more or fewer: the two bytes at 5 store the size minus 256.
    for (const std::size_t size : {1025, 1023, 60'000}) {
        Bytes fault = compress(Bytes(size));
        const std::uint16_t claim = 1024 - 256;
        std::memcpy(fault.data() + 5, &claim, sizeof(claim));
        faults.push_back(fault);
    }
    for (std::size_t i = 0; i < faults.size(); ++i) {
        SCOPED_TRACE(i);
        expectIssue(fileOf(zstdRecipe(faults[i])), IssueCode::kPayloadUnpack, 1);
    }
}

/// A missing decode field means the default, projected. Fixed-point front-back texels may have any bits; half floats
/// may not.
void expectTexelFaults() {
    Recipe recipe = with([](auto& r) {
        MapRecipe& map = r.maps[1];
        map.format = 4;
        map.compare = 2;
        map.decode = 1;
        map.raw_size = 16 * 16 * 8;
        map.stored.assign(16 * 16 * 8, std::byte{0xff});
    });
    const Collider fixed = required(readContainer(fileOf(recipe)));
    EXPECT_EQ(fixed.maps[0].decode, Decode::kProjected);
    EXPECT_EQ(fixed.maps[1].decode, Decode::kPlane);
    EXPECT_EQ(fixed.maps[1].format, MapFormat::kFrontBackFixed);
    recipe.maps[1].format = 2;
    expectIssue(fileOf(recipe), IssueCode::kTexels, 1);
}

TEST(Crafted, EveryFaultHasAnIssueInTheReadme) {
    expectHeaderFaults();
    expectMetadataFaults();
    expectPayloadFaults();
    expectLimits();
    expectZstdFaults();
    expectTexelFaults();
    const Bytes file = required(readFile(RELIEF_SOURCE_DIR "/formats/README.md"));
    const std::string text(reinterpret_cast<const char*>(file.data()), file.size());
    const std::regex row("\\| RLF-([0-9, ]+) \\| ([a-z]+) \\| ([^|\n]+) \\|\n");
    std::vector<IssueCode> listed;
    for (std::sregex_iterator match(text.begin(), text.end(), row), end; match != end; ++match) {
        const std::string codes = match->str(1);
        const std::string rules = match->str(3);
        for (std::size_t at = 0; at < codes.size(); at += 6) {
            listed.push_back(static_cast<IssueCode>(std::stoi(codes.substr(at, 4))));
            EXPECT_EQ(wordOf(Issue{listed.back(), -1, {}, {}}.severity()), match->str(2)) << match->str();
        }
        EXPECT_EQ(std::count(rules.begin(), rules.end(), ';'), std::count(codes.begin(), codes.end(), ','))
            << match->str();
    }
    EXPECT_EQ(listed, std::vector<IssueCode>(shownCodes().begin(), shownCodes().end()));
}

/// A file may claim 32768 times its size. With limits.memory, a reader accepts the larger of 16 times the size and
/// limits.memory.
TEST(Crafted, TexelsAreLimitedByTheFileSize) {
    Recipe recipe;
    recipe.maps.resize(1);
    recipe.maps[0].compression = 1;
    recipe.maps[0].width = recipe.maps[0].height = 1024;
    recipe.maps[0].stored = compress(Bytes(std::size_t{4} << 20));
    const Bytes bomb = fileOf(recipe);
    ASSERT_LT(bomb.size(), 1024U);
    ContainerLimits limits;
    EXPECT_TRUE(readContainer(bomb, limits));
    limits.memory = std::uint64_t{4} << 20;
    EXPECT_TRUE(readContainer(bomb, limits));
    EXPECT_FALSE(inspectContainer(bomb, limits)->damaged());
    --limits.memory;
    expectIssue(bomb, IssueCode::kTexelLimit, 0, limits);
    EXPECT_FALSE(readContainerInfo(bomb, limits));
    // Uncompressed texels are never too large for their file.
    limits.memory = 0;
    EXPECT_TRUE(readContainer(fileOf({}), limits));
}

/// A collider that was read is valid, and can be written and read again.
void expectSoundOrRefused(const Bytes& bytes, int& read_count) {
    const Result<Collider> read = readContainer(bytes);
    const Result<ContainerInfo> info = readContainerInfo(bytes);
    ASSERT_EQ(inspectContainer(bytes)->damaged(), !read);
    if (!read) {
        ASSERT_FALSE(read.error().message.empty());
        ASSERT_EQ(read.error().message.find('\n'), std::string::npos);
        return;
    }
    ++read_count;
    ASSERT_TRUE(info);
    const Result<void> valid = validate(*read);
    ASSERT_TRUE(valid) << valid.error().message;
    const Bytes again = required(writeContainer(*read));
    const Collider second = required(readContainer(again));
    ASSERT_EQ(second, *read);
    for (const glm::vec3 p : {glm::vec3(0.0F), glm::vec3(0.5F, 0.25F, -0.5F), glm::vec3(-3e38F)}) {
        ASSERT_FALSE(std::isnan(evaluate(*read, p).distance));
    }
}

Collider withMaterials() {
    Collider collider = test::oneMapOfEveryFormat();
    collider.materials = test::someMaterials();
    return collider;
}

TEST(Mutated, EveryMetadataBitWithFixedChecksums) {
    const Bytes bytes = *writeContainer(withMaterials());
    ContainerHeader header;
    std::memcpy(&header, bytes.data(), sizeof(header));
    int read_count = 0;
    for (std::size_t bit = 0; bit < header.metadata_size * 8; ++bit) {
        Bytes flipped = bytes;
        flipped[64 + bit / 8] ^= static_cast<std::byte>(1 << bit % 8);
        test::fixChecksums(flipped);
        ASSERT_NO_FATAL_FAILURE(expectSoundOrRefused(flipped, read_count)) << "bit " << bit;
    }
    EXPECT_GT(read_count, 100)
        << "flips in names and bounds are valid; rejecting every file would test nothing";
}

TEST(Mutated, EveryZstdFrameBitWithFixedChecksums) {
    Bytes raw(kRaw.size());
    std::mt19937 random(3);
    for (std::size_t i = 100; i < 400; ++i) {
        raw[i] = static_cast<std::byte>(random() % 7);
    }
    const Bytes frame = compress(raw);
    int read_count = 0;
    for (std::size_t bit = 0; bit < frame.size() * 8; ++bit) {
        Bytes flipped = frame;
        flipped[bit / 8] ^= static_cast<std::byte>(1 << bit % 8);
        ASSERT_NO_FATAL_FAILURE(expectSoundOrRefused(fileOf(zstdRecipe(flipped)), read_count))
            << "bit " << bit;
    }
}

}  // namespace
}  // namespace relief
