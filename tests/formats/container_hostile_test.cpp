// Containers made by hand, with correct checksums and one lie each: checksums guard against accidents, the
// reader's own checks against people.
#include <flatbuffers/flatbuffers.h>
#include <gtest/gtest.h>
#include <zstd.h>

#include <cstring>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "collider_generated.h"
#include "formats/base/hash.h"
#include "formats/container.h"
#include "formats/container_reader.h"
#include "formats/inspect.h"
#include "formats/row_spans.h"
#include "formats/validate.h"
#include "tests/formats/sample_colliders.h"
#include "tests/seeds.h"

namespace relief {
namespace {

using flatbuffers::FlatBufferBuilder;
using flatbuffers::voffset_t;

struct MapRecipe {
    std::uint8_t format = 1;  // fixed8
    std::uint8_t compare = 0;
    std::uint8_t compression = 0;
    std::uint8_t decode = 0;
    std::uint32_t width = 16;
    std::uint32_t height = 16;
    std::vector<fb::Row> rows = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
    fb::Vec3 object_per_map = {1, 1, 1};
    std::vector<std::byte> stored = std::vector<std::byte>(16 * 16 * 4);
    std::optional<std::uint64_t> offset;
    std::optional<std::uint64_t> stored_size;
    std::optional<std::uint64_t> raw_size;
    std::uint64_t hash_change = 0;
    std::vector<voffset_t> omitted;
};

struct Recipe {
    fb::Vec3 bounds_min = {0, 0, 0};
    fb::Vec3 bounds_max = {1, 1, 1};
    std::string unit = "m";
    std::string mesh_name = "a.obj";
    std::string mesh_hash = "00112233445566778899aabbccddeeff";
    std::string tool_version = "relief 9.9";
    std::string options;
    std::vector<MapRecipe> maps = std::vector<MapRecipe>(2);
    std::vector<voffset_t> omitted;  // of the collider
    std::vector<voffset_t> provenance_omitted;
    bool later_fields = false;  // as a later minor version would append
    const char* identifier = "RLF1";
    std::function<void(ContainerHeader&)> header;        // before its checksum
    std::function<void(std::vector<std::byte>&)> bytes;  // after all checksums
};

/// A table under construction, its fields optional whatever the schema says.
class Table {
  public:
    Table(FlatBufferBuilder& builder, const std::vector<voffset_t>& omitted)
        : builder_(builder), omitted_(omitted), start_(builder.StartTable()) {
        builder_.ForceDefaults(true);
    }
    template <class T>
    void scalar(voffset_t field, T value) {
        if (wanted(field)) {
            builder_.AddElement<T>(field, value, T{});
        }
    }
    template <class T>
    void structure(voffset_t field, const T& value) {
        if (wanted(field)) {
            builder_.AddStruct(field, &value);
        }
    }
    template <class T>
    void offset(voffset_t field, flatbuffers::Offset<T> value) {
        if (wanted(field)) {
            builder_.AddOffset(field, value);
        }
    }
    flatbuffers::uoffset_t end() { return builder_.EndTable(start_); }

  private:
    [[nodiscard]] bool wanted(voffset_t field) const {
        return std::find(omitted_.begin(), omitted_.end(), field) == omitted_.end();
    }
    FlatBufferBuilder& builder_;
    const std::vector<voffset_t>& omitted_;
    flatbuffers::uoffset_t start_;
};

constexpr voffset_t kLaterField = 4 + 2 * 30;

std::vector<std::byte> metadataOf(const Recipe& recipe, const std::vector<fb::Payload>& payloads) {
    FlatBufferBuilder builder;
    std::vector<flatbuffers::Offset<fb::Map>> maps;
    for (std::size_t i = 0; i < recipe.maps.size(); ++i) {
        const MapRecipe& map = recipe.maps[i];
        Table table(builder, map.omitted);
        table.scalar(fb::Map::VT_FORMAT, map.format);
        table.scalar(fb::Map::VT_COMPARE, map.compare);
        table.scalar(fb::Map::VT_WIDTH, map.width);
        table.scalar(fb::Map::VT_HEIGHT, map.height);
        table.structure(fb::Map::VT_OBJECT_TO_MAP, fb::Transform(map.rows[0], map.rows[1], map.rows[2]));
        table.structure(fb::Map::VT_OBJECT_PER_MAP, map.object_per_map);
        table.scalar<std::uint8_t>(fb::Map::VT_ENCLOSES, 1);
        table.scalar<std::uint8_t>(fb::Map::VT_EMPTY_IS_OUTSIDE, 1);
        table.scalar(fb::Map::VT_COMPRESSION, map.compression);
        table.structure(fb::Map::VT_PAYLOAD, payloads[i]);
        table.scalar(fb::Map::VT_DECODE, map.decode);
        if (recipe.later_fields) {
            table.scalar<std::uint64_t>(kLaterField, 77);
        }
        maps.emplace_back(table.end());
    }
    const auto map_vector = builder.CreateVector(maps);
    const auto mesh_name = builder.CreateString(recipe.mesh_name);
    const auto mesh_hash = builder.CreateString(recipe.mesh_hash);
    const auto tool_version = builder.CreateString(recipe.tool_version);
    const auto options = builder.CreateString(recipe.options);
    Table provenance(builder, recipe.provenance_omitted);
    provenance.offset(fb::Provenance::VT_MESH_NAME, mesh_name);
    provenance.offset(fb::Provenance::VT_MESH_HASH, mesh_hash);
    provenance.scalar<std::uint64_t>(fb::Provenance::VT_TRIANGLES, 12);
    provenance.offset(fb::Provenance::VT_TOOL_VERSION, tool_version);
    provenance.offset(fb::Provenance::VT_OPTIONS_TEXT, options);
    const flatbuffers::Offset<fb::Provenance> provenance_at(provenance.end());
    const auto unit = builder.CreateString(recipe.unit);
    Table collider(builder, recipe.omitted);
    collider.structure(fb::Collider::VT_BOUNDS_MIN, recipe.bounds_min);
    collider.structure(fb::Collider::VT_BOUNDS_MAX, recipe.bounds_max);
    collider.offset(fb::Collider::VT_UNIT, unit);
    collider.offset(fb::Collider::VT_PROVENANCE, provenance_at);
    collider.offset(fb::Collider::VT_MAPS, map_vector);
    if (recipe.later_fields) {
        collider.offset(kLaterField, unit);
    }
    builder.Finish(flatbuffers::Offset<fb::Collider>(collider.end()), recipe.identifier);
    const auto bytes = std::as_bytes(std::span(builder.GetBufferPointer(), builder.GetSize()));
    return {bytes.begin(), bytes.end()};
}

std::vector<std::byte> fileOf(const Recipe& recipe) {
    std::vector<fb::Payload> payloads(recipe.maps.size());
    const std::size_t metadata_size = metadataOf(recipe, payloads).size();
    std::vector<std::byte> bytes(64 + metadata_size);
    for (std::size_t i = 0; i < recipe.maps.size(); ++i) {
        const MapRecipe& map = recipe.maps[i];
        bytes.resize((bytes.size() + 63) / 64 * 64);
        const std::uint64_t raw_size = std::uint64_t{map.width} * map.height * 4;
        payloads[i] =
            fb::Payload(map.offset.value_or(bytes.size()), map.stored_size.value_or(map.stored.size()),
                        map.raw_size.value_or(raw_size), xxh3_64(map.stored) ^ map.hash_change);
        bytes.insert(bytes.end(), map.stored.begin(), map.stored.end());
    }
    const std::vector<std::byte> metadata = metadataOf(recipe, payloads);
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

void expectRefused(const Recipe& recipe, const std::string& words,
                   ErrorCode code = ErrorCode::kInvalidInput) {
    const Result<Collider> read = readContainer(fileOf(recipe));
    ASSERT_FALSE(read) << words;
    EXPECT_EQ(read.error().code, code) << read.error().message;
    EXPECT_NE(read.error().message.find(words), std::string::npos)
        << "\"" << read.error().message << "\" does not say \"" << words << "\"";
}

template <class F>
Recipe with(F change) {
    Recipe recipe;
    change(recipe);
    return recipe;
}

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

std::vector<std::byte> compress(const std::vector<std::byte>& raw) {
    std::vector<std::byte> bytes(ZSTD_compressBound(raw.size()));
    bytes.resize(ZSTD_compress(bytes.data(), bytes.size(), raw.data(), raw.size(), 3));
    return bytes;
}

/// The second map of two, compressed, its frame as given.
Recipe zstdRecipe(const std::vector<std::byte>& frame) {
    return with([&](Recipe& r) {
        r.maps[1].compression = 1;
        r.maps[1].stored = frame;
    });
}

const std::vector<std::byte> kRaw(16 * 16 * 4);

TEST(Crafted, TheRecipeItselfIsRead) {
    const Result<Collider> plain = readContainer(fileOf({}));
    ASSERT_TRUE(plain) << plain.error().message;
    EXPECT_EQ(plain->maps.size(), 2U);
    const Result<Collider> zstd = readContainer(fileOf(zstdRecipe(compress(kRaw))));
    ASSERT_TRUE(zstd) << zstd.error().message;
    EXPECT_EQ(zstd->maps[1].texels, kRaw);
}

TEST(Crafted, Versions) {
    const auto version = [](std::uint16_t major, std::uint16_t minor) {
        return with([&](Recipe& r) {
            r.header = [=](ContainerHeader& h) {
                h.major = major;
                h.minor = minor;
            };
            r.later_fields = minor != 0;
        });
    };
    for (const std::uint16_t minor : {std::uint16_t{1}, std::uint16_t{7}, std::uint16_t{65535}}) {
        const Result<Collider> read = readContainer(fileOf(version(1, minor)));
        ASSERT_TRUE(read) << read.error().message;
        EXPECT_EQ(readContainerInfo(fileOf(version(1, minor)))->minor, minor);
    }
    expectRefused(version(2, 3), "container version 2.3, this program reads version 1",
                  ErrorCode::kUnsupported);
    expectRefused(version(0, 9), "container version 0.9", ErrorCode::kUnsupported);
    // A later major version may lay out all the rest differently: it is named first.
    expectRefused(with([](Recipe& r) {
                      r.header = [](ContainerHeader& h) { h.major = 256; };
                      r.bytes = [](std::vector<std::byte>& b) { b[60] ^= std::byte{1}; };
                  }),
                  "container version 256.6", ErrorCode::kUnsupported);
}

TEST(Crafted, HeaderFields) {
    const auto header = [](std::function<void(ContainerHeader&)> change) {
        return with([&](Recipe& r) { r.header = std::move(change); });
    };
    const char* fields = "header_size, reserved or metadata_offset";
    expectRefused(header([](ContainerHeader& h) { h.header_size = 72; }), fields);
    expectRefused(header([](ContainerHeader& h) { h.reserved = 1; }), fields);
    expectRefused(header([](ContainerHeader& h) { h.metadata_offset = 128; }), fields);
    expectRefused(header([](ContainerHeader& h) { h.metadata_offset = ~std::uint64_t{0}; }), fields);
    expectRefused(header([](ContainerHeader& h) { h.file_size += 1; }), "truncated");
    expectRefused(header([](ContainerHeader& h) { h.file_size = ~std::uint64_t{0}; }), "truncated");
    expectRefused(header([](ContainerHeader& h) { h.file_size -= 1; }), "1 bytes more than the header says");
    expectRefused(header([](ContainerHeader& h) { h.file_size = 0; }), "more than the header says");
    expectRefused(header([](ContainerHeader& h) { h.metadata_size = ~std::uint64_t{0}; }), "metadata_size",
                  ErrorCode::kLimit);
    expectRefused(header([](ContainerHeader& h) { h.metadata_size = 1 << 24; }), "reaches beyond the end");
    expectRefused(header([](ContainerHeader& h) { h.metadata_hash ^= 1; }),
                  "the checksum of the metadata is wrong, at byte 48");
}

TEST(Crafted, MetadataThatIsNoTable) {
    const char* words = "no FlatBuffers table of a collider";
    expectRefused(with([](Recipe& r) { r.identifier = "RLF2"; }), words);
    for (const std::uint64_t size : {0, 1, 3, 7, 8, 12, 40}) {
        std::vector<std::byte> bytes = fileOf({});
        std::memcpy(bytes.data() + 40, &size, sizeof(size));
        test::mendChecksums(bytes);
        const Result<Collider> read = readContainer(bytes);
        ASSERT_FALSE(read);
        EXPECT_NE(read.error().message.find(words), std::string::npos) << read.error().message;
    }
    for (const voffset_t field :
         {fb::Collider::VT_BOUNDS_MIN, fb::Collider::VT_BOUNDS_MAX, fb::Collider::VT_UNIT,
          fb::Collider::VT_PROVENANCE, fb::Collider::VT_MAPS}) {
        expectRefused(with([&](Recipe& r) { r.omitted = {field}; }), words);
    }
    for (const voffset_t field : {fb::Provenance::VT_MESH_NAME, fb::Provenance::VT_MESH_HASH,
                                  fb::Provenance::VT_TOOL_VERSION, fb::Provenance::VT_OPTIONS_TEXT}) {
        expectRefused(with([&](Recipe& r) { r.provenance_omitted = {field}; }), words);
    }
    for (const voffset_t field :
         {fb::Map::VT_OBJECT_TO_MAP, fb::Map::VT_OBJECT_PER_MAP, fb::Map::VT_PAYLOAD}) {
        expectRefused(with([&](Recipe& r) { r.maps[1].omitted = {field}; }), words);
    }
}

TEST(Crafted, Description) {
    expectRefused(with([](Recipe& r) { r.maps.clear(); }), "there is no map");
    expectRefused(with([](Recipe& r) { r.bounds_min = {2, 0, 0}; }), "lies beyond bounds.max");
    expectRefused(with([](Recipe& r) { r.bounds_max = {1, kNaN, 1}; }), "bounds are not finite");
    expectRefused(with([](Recipe& r) { r.unit = "a unit of great length"; }), "unit has 22 bytes");
    expectRefused(with([](Recipe& r) { r.mesh_name = "/etc/passwd"; }), "mesh_name has a '/'");
    expectRefused(with([](Recipe& r) { r.mesh_name = std::string("a\0.obj", 6); }), "mesh_name is not UTF-8");
    expectRefused(with([](Recipe& r) { r.mesh_hash = "00112233445566778899AABBCCDDEEFF"; }), "mesh_hash");
    expectRefused(with([](Recipe& r) { r.tool_version = "\x1b]0;owned\x07"; }), "tool_version is not UTF-8");
    expectRefused(with([](Recipe& r) { r.options.assign((1 << 20) + 1, 'o'); }), "options has 1048577 bytes");
}

TEST(Crafted, Frames) {
    expectRefused(with([](Recipe& r) { r.maps[1].format = 6; }), "map 1: its format 6 is unknown");
    expectRefused(with([](Recipe& r) { r.maps[1].format = 255; }), "map 1: its format 255 is unknown");
    expectRefused(with([](Recipe& r) { r.maps[1].decode = 2; }), "map 1: its decode 2 is unknown");
    expectRefused(with([](Recipe& r) { r.maps[0].decode = 255; }), "map 0: its decode 255 is unknown");
    expectRefused(with([](Recipe& r) { r.maps[1].format = 4; }),
                  "\"less\" does not go with its format \"front-back\"");
    expectRefused(with([](Recipe& r) { r.maps[1].compare = 4; }), "map 1: its compare 4 is unknown");
    expectRefused(with([](Recipe& r) { r.maps[1].compare = 3; }), "does not go with its format");
    expectRefused(with([](Recipe& r) { r.maps[1].compare = 2; }),
                  "\"both\" does not go with its format \"fixed8\"");
    expectRefused(with([](Recipe& r) { r.maps[1].compression = 3; }), "map 1: its compression 3 is unknown");
    expectRefused(with([](Recipe& r) { r.maps[1].compression = 2; }),
                  "map 1: its compression \"rows\" does not go with its format \"fixed8\"");
    expectRefused(with([](Recipe& r) { r.maps[1].width = 0; }), "map 1: its size 0x16 is below");
    expectRefused(with([](Recipe& r) { r.maps[1].height = 2; }), "map 1: its size 16x2 is below");
    expectRefused(with([](Recipe& r) { r.maps[1].width = 0xffffffff; }), "4294967295x16 is beyond",
                  ErrorCode::kLimit);
    expectRefused(with([](Recipe& r) {
                      r.maps[1].format = 3;
                      r.maps[1].height = 17;
                  }),
                  "not square");
    expectRefused(with([](Recipe& r) { r.maps[1].rows[1] = {0, kNaN, 0, 0}; }), "row 1 is not finite");
    expectRefused(with([](Recipe& r) { r.maps[1].rows[1] = {0, 0, 0, 1}; }), "row 1 is zero");
    expectRefused(with([](Recipe& r) { r.maps[1].rows[2] = r.maps[1].rows[0]; }),
                  "rows 0 and 2 are not orthogonal");
    expectRefused(with([](Recipe& r) { r.maps[1].object_per_map = {1, 1, 0}; }), "not positive and finite");
    expectRefused(with([](Recipe& r) { r.maps[1].object_per_map = {1, 1, -1}; }), "not positive and finite");
    expectRefused(with([](Recipe& r) {
                      r.maps[1].object_per_map = {1, 1, 2};
                  }),
                  "where object_to_map gives 1");
}

TEST(Crafted, DecodeAndFixedFrontBack) {
    // Decode without a field is the projected one; fixed-point front-back texels may hold any bits.
    const Recipe without = with([](Recipe& r) {
        r.maps[1].decode = 1;
        r.maps[0].omitted = {fb::Map::VT_DECODE};
    });
    const Result<Collider> read = readContainer(fileOf(without));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->maps[0].decode, Decode::kProjected);
    EXPECT_EQ(read->maps[1].decode, Decode::kPlane);

    Recipe recipe = with([](Recipe& r) {
        MapRecipe& map = r.maps[1];
        map.format = 4;
        map.compare = 2;
        map.decode = 1;
        map.raw_size = 16 * 16 * 8;
        map.stored.assign(16 * 16 * 8, std::byte{0xff});
    });
    const Result<Collider> fixed = readContainer(fileOf(recipe));
    ASSERT_TRUE(fixed) << fixed.error().message;
    EXPECT_EQ(fixed->maps[1].format, MapFormat::kFrontBackFixed);
    recipe.maps[1].format = 2;
    expectRefused(recipe, "map 1: texel (0, 0) has a half-float depth");
}

TEST(Crafted, PayloadSizesAndPlaces) {
    const auto second = [](std::function<void(MapRecipe&)> change) {
        return with([&](Recipe& r) { change(r.maps[1]); });
    };
    const std::uint64_t first = [] { return readContainerInfo(fileOf({}))->payloads[0].offset; }();
    expectRefused(second([](MapRecipe& m) { m.raw_size = 1023; }), "raw_size is 1023");
    expectRefused(second([](MapRecipe& m) { m.raw_size = ~std::uint64_t{0}; }),
                  "raw_size is 18446744073709551615");
    expectRefused(second([](MapRecipe& m) { m.stored_size = 1023; }), "stored_size 1023 does not go with");
    expectRefused(second([](MapRecipe& m) { m.stored_size = ~std::uint64_t{0}; }), "does not go with");
    expectRefused(second([&](MapRecipe& m) { m.offset = first; }), "map 1: its payload's offset is");
    expectRefused(second([&](MapRecipe& m) { m.offset = first + 1024 + 1; }),
                  "map 1: its payload's offset is");
    expectRefused(second([&](MapRecipe& m) { m.offset = first + 1024 + 64; }),
                  "map 1: its payload's offset is");
    expectRefused(second([](MapRecipe& m) { m.offset = 0; }), "map 1: its payload's offset is 0");
    expectRefused(second([](MapRecipe& m) { m.offset = ~std::uint64_t{0} - 63; }),
                  "map 1: its payload's offset is");
    expectRefused(second([](MapRecipe& m) { m.hash_change = 1; }),
                  "map 1: the checksum of its payload is wrong");
    expectRefused(second([](MapRecipe& m) { m.height = 17; }),
                  "map 1: its stored_size 1024 does not go with");
    expectRefused(second([](MapRecipe& m) {
                      m.height = 17;
                      m.stored_size = 16 * 17 * 4;
                  }),
                  "map 1: its payload of 1088 bytes reaches beyond the end");
    expectRefused(with([](Recipe& r) { r.maps[0].offset = 64; }), "map 0: its payload's offset is 64");
    // Bytes that belong to nothing.
    expectRefused(with([](Recipe& r) {
                      r.bytes = [](std::vector<std::byte>& b) {
                          b.resize(b.size() + 64);
                          const std::uint64_t size = b.size();
                          std::memcpy(b.data() + 24, &size, sizeof(size));
                          test::mendChecksums(b);
                      };
                  }),
                  "64 bytes follow the last payload");
    expectRefused(
        with([&](Recipe& r) { r.bytes = [&](std::vector<std::byte>& b) { b[first - 1] = std::byte{1}; }; }),
        "padding before its payload is not zero");
}

TEST(Crafted, Limits) {
    const std::vector<std::byte> bytes = fileOf({});
    EXPECT_TRUE(readContainer(bytes, {2, 2048}));
    const Result<Collider> maps = readContainer(bytes, {1, 2048});
    ASSERT_FALSE(maps);
    EXPECT_EQ(maps.error().code, ErrorCode::kLimit);
    EXPECT_NE(maps.error().message.find("2 maps are more than the limit of 1"), std::string::npos);
    const Result<Collider> texels = readContainer(bytes, {2, 2047});
    ASSERT_FALSE(texels);
    EXPECT_EQ(texels.error().code, ErrorCode::kLimit);
    EXPECT_NE(texels.error().message.find("map 1: with it"), std::string::npos);
    // Each map below the limit, all together beyond it.
    expectRefused(with([](Recipe& r) {
                      for (MapRecipe& map : r.maps) {
                          map.compression = 1;
                          map.width = map.height = 16384;
                          map.stored.resize(40'000);
                      }
                      r.maps.push_back(r.maps[0]);
                  }),
                  "map 2: with it, the texels take more than the limit of 2147483648", ErrorCode::kLimit);
}

/// A file may claim 32768 times its size; a reader that has limits.memory takes 16 times as much, or so many bytes.
TEST(Crafted, TexelsAreWorthTheirFile) {
    const auto packed = [](std::uint32_t side) {
        Recipe recipe;
        recipe.maps.resize(1);
        recipe.maps[0].compression = 1;
        recipe.maps[0].width = recipe.maps[0].height = side;
        recipe.maps[0].stored = compress(std::vector<std::byte>(std::size_t{4} * side * side));
        return fileOf(recipe);
    };
    const std::vector<std::byte> bomb = packed(1024);  // 4 MiB
    ASSERT_LT(bomb.size(), 1024U);
    ContainerLimits limits;
    EXPECT_TRUE(readContainer(bomb, limits));
    limits.memory = std::uint64_t{4} << 20;
    EXPECT_TRUE(readContainer(bomb, limits));
    EXPECT_FALSE(inspectContainer(bomb, limits)->damaged());
    --limits.memory;
    const Result<Collider> refused = readContainer(bomb, limits);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::kLimit);
    EXPECT_NE(refused.error().message.find("4194304 bytes"), std::string::npos) << refused.error().message;
    EXPECT_NE(refused.error().message.find("--max-memory"), std::string::npos) << refused.error().message;
    EXPECT_FALSE(readContainerInfo(bomb, limits));
    const Result<Inspection> inspection = inspectContainer(bomb, limits);
    ASSERT_TRUE(inspection);
    EXPECT_EQ(inspection->errorCode(), ErrorCode::kLimit);
    // Unpacked texels are worth their file.
    limits.memory = 0;
    EXPECT_TRUE(readContainer(fileOf({}), limits));
}

TEST(Crafted, ZstdFrames) {
    const std::vector<std::byte> frame = compress(kRaw);
    const char* one_frame = "not exactly one zstd frame";

    std::vector<std::byte> longer = frame;
    longer.push_back(std::byte{0});
    expectRefused(zstdRecipe(longer), one_frame);
    std::vector<std::byte> twice = frame;
    twice.insert(twice.end(), frame.begin(), frame.end());
    expectRefused(zstdRecipe(twice), one_frame);
    expectRefused(zstdRecipe({frame.begin(), frame.end() - 1}), one_frame);

    const char* content = "no zstd frame that states a content of 1024 bytes";
    expectRefused(zstdRecipe(std::vector<std::byte>(100)), content);
    expectRefused(zstdRecipe(compress(std::vector<std::byte>(1023))), content);
    expectRefused(zstdRecipe(compress(std::vector<std::byte>(1025))), content);
    expectRefused(zstdRecipe({}), content);
    std::vector<std::byte> skippable(12);
    const std::uint32_t skippable_head[] = {0x184d2a50, 4};
    std::memcpy(skippable.data(), skippable_head, sizeof(skippable_head));
    expectRefused(zstdRecipe(skippable), content);

    // A stream that does not state its content.
    ZSTD_CCtx* context = ZSTD_createCCtx();
    ZSTD_CCtx_setParameter(context, ZSTD_c_contentSizeFlag, 0);
    std::vector<std::byte> unstated(2000);
    unstated.resize(ZSTD_compress2(context, unstated.data(), unstated.size(), kRaw.data(), kRaw.size()));
    ZSTD_freeCCtx(context);
    expectRefused(zstdRecipe(unstated), content);

    // A content of 1025 or 1023 bytes that claims 1024: two bytes at 5, the size less 256.
    for (const std::size_t size : {1025, 1023, 900'000}) {
        std::vector<std::byte> lie = compress(std::vector<std::byte>(std::min<std::size_t>(size, 60'000)));
        const std::uint16_t claim = 1024 - 256;
        std::memcpy(lie.data() + 5, &claim, sizeof(claim));
        expectRefused(zstdRecipe(lie), "decompress");
    }
    // A frame that is longer than what it holds is stored for no reason.
    expectRefused(with([](Recipe& r) { r.maps[1].compression = 1; }),
                  "stored_size 1024 does not go with its raw_size");
}

/// The second map of two, 16 x 16 front-back texels, in rows: the texels of one span of row 3, and what is wrong with it.
Recipe rowsRecipe(const std::function<void(std::vector<std::byte>&)>& spoil) {
    return with([&](Recipe& r) {
        std::vector<std::byte> stored(16 * 4);
        stored[3 * 4] = std::byte{5};
        stored[3 * 4 + 2] = std::byte{7};
        stored.resize(16 * 4 + 2 * 8, std::byte{1});
        spoil(stored);
        r.maps[1].format = 4;
        r.maps[1].compare = 2;
        r.maps[1].compression = 2;
        r.maps[1].raw_size = 16 * 16 * 8;
        r.maps[1].stored = stored;
    });
}

TEST(Crafted, Rows) {
    const Result<Collider> sound = readContainer(fileOf(rowsRecipe([](auto&) {})));
    ASSERT_TRUE(sound) << sound.error().message;
    EXPECT_EQ(texelsOf(rowSpans(sound->maps[1])), 2U);
    EXPECT_EQ(sound->maps[1].texelAt(0, 5, 3)[7], std::byte{1});

    const char* sizes = "its rows have 16 bytes of texels, its payload ";
    expectRefused(rowsRecipe([](auto& b) { b.pop_back(); }), sizes);
    expectRefused(rowsRecipe([](auto& b) { b.resize(b.size() + 8, std::byte{1}); }), sizes);
    expectRefused(rowsRecipe([](auto& b) { b.resize(16 * 4); }), sizes);
    expectRefused(rowsRecipe([](auto& b) { b.resize(16 * 4 - 1); }), "cannot hold its 16 rows");
    expectRefused(rowsRecipe([](auto& b) { b.clear(); }), "cannot hold its 16 rows");
    expectRefused(rowsRecipe([](auto& b) { b[3 * 4] = std::byte{8}; }),
                  "row 3 of its packed texels goes from 8 to 7");
    expectRefused(rowsRecipe([](auto& b) { b[3 * 4 + 2] = std::byte{17}; }), "goes from 5 to 17 of 16");
    expectRefused(rowsRecipe([](auto& b) { b[4 * 4] = b[4 * 4 + 2] = std::byte{9}; }),
                  "goes from 9 to 9 of 16");
    const char* empty = "row 3 of its packed texels begins or ends with an empty texel";
    expectRefused(rowsRecipe([](auto& b) { std::fill_n(b.begin() + 64, 8, std::byte{0}); }), empty);
    expectRefused(rowsRecipe([](auto& b) { std::fill_n(b.begin() + 72, 8, std::byte{0}); }), empty);
    // As long as the texels themselves: stored in rows for no reason.
    expectRefused(rowsRecipe([](auto& b) { b.resize(2048); }),
                  "stored_size 2048 does not go with its raw_size");
    // 2 GiB from one byte less than the rows of that map take.
    expectRefused(with([](Recipe& r) {
                      r.maps[1].format = 4;
                      r.maps[1].compare = 2;
                      r.maps[1].compression = 2;
                      r.maps[1].width = r.maps[1].height = 16384;
                      r.maps[1].raw_size = std::uint64_t{1} << 31U;
                      r.maps[1].stored.resize(65'535);
                  }),
                  "65535 stored bytes cannot hold the 2147483648 that they claim");
}

TEST(Crafted, BombsAreRefusedBeforeAnythingIsAllocated) {
    // 1 GiB from 100 bytes: less than a zstd frame could be.
    expectRefused(with([](Recipe& r) {
                      r.maps[1].compression = 1;
                      r.maps[1].width = r.maps[1].height = 16384;
                      r.maps[1].stored.resize(100);
                  }),
                  "100 stored bytes cannot hold the 1073741824 that they claim");
    // A true frame of 64 MiB of zeros as the content of 1024 bytes: some 2 KiB that must not be unpacked.
    expectRefused(zstdRecipe({}), "zstd");
    std::vector<std::byte> bomb = compress(std::vector<std::byte>(std::size_t{16} << 20));
    ASSERT_LT(bomb.size(), 1024U);
    expectRefused(zstdRecipe(bomb), "no zstd frame that states a content of 1024 bytes");
}

/// Whatever is read keeps every invariant, and can be written and read again.
void expectSoundOrRefused(const std::vector<std::byte>& bytes, int& read_count) {
    const Result<Collider> read = readContainer(bytes);
    const Result<ContainerInfo> info = readContainerInfo(bytes);
    if (!read) {
        ASSERT_FALSE(read.error().message.empty());
        ASSERT_EQ(read.error().message.find('\n'), std::string::npos);
        return;
    }
    ++read_count;
    ASSERT_TRUE(info);
    const Result<void> valid = validate(*read);
    ASSERT_TRUE(valid) << valid.error().message;
    const Result<std::vector<std::byte>> again = writeContainer(*read);
    ASSERT_TRUE(again) << again.error().message;
    const Result<Collider> second = readContainer(*again);
    ASSERT_TRUE(second) << second.error().message;
    ASSERT_EQ(*second, *read);
    for (const glm::vec3 p : {glm::vec3(0.0F), glm::vec3(0.5F, 0.25F, -0.5F), glm::vec3(-3e38F)}) {
        ASSERT_FALSE(std::isnan(evaluate(*read, p).distance));
    }
}

TEST(Mutated, EveryBitOfTheMetadataWithMendedChecksums) {
    const std::vector<std::byte> bytes = *writeContainer(test::oneMapOfEveryFormat());
    ContainerHeader header;
    std::memcpy(&header, bytes.data(), sizeof(header));
    int read_count = 0;
    for (std::size_t bit = 0; bit < header.metadata_size * 8; ++bit) {
        std::vector<std::byte> flipped = bytes;
        flipped[64 + bit / 8] ^= static_cast<std::byte>(1 << bit % 8);
        test::mendChecksums(flipped);
        ASSERT_NO_FATAL_FAILURE(expectSoundOrRefused(flipped, read_count)) << "bit " << bit;
    }
    EXPECT_GT(read_count, 100) << "names and bounds may change; a reader that refuses all tests nothing";
}

TEST(Mutated, RandomDamageWithMendedChecksums) {
    const std::vector<std::byte> bytes = *writeContainer(test::oneMapOfEveryFormat(), {5});
    ContainerHeader header;
    std::memcpy(&header, bytes.data(), sizeof(header));
    std::mt19937 random(test::seedFrom(4711));
    const std::uint32_t words[] = {0, 1, 0x7f, 0x80, 0xff, 0x7fffffff, 0x80000000, 0xffffffff, 0x7fc00000};
    int read_count = 0;
    for (int i = 0; i < 20'000; ++i) {
        std::vector<std::byte> damaged = bytes;
        for (auto k = 1 + random() % 3; k > 0; --k) {
            const std::size_t at = 64 + random() % (header.metadata_size - 4);
            if (random() % 2 == 0) {
                damaged[at] = static_cast<std::byte>(random());
            } else {
                std::memcpy(damaged.data() + at, &words[random() % std::size(words)], 4);
            }
        }
        test::mendChecksums(damaged);
        ASSERT_NO_FATAL_FAILURE(expectSoundOrRefused(damaged, read_count)) << "round " << i;
    }
    EXPECT_GT(read_count, 20);
}

TEST(Mutated, EveryBitOfAZstdFrameWithMendedChecksums) {
    std::vector<std::byte> raw = kRaw;
    std::mt19937 random(3);
    for (std::size_t i = 100; i < 400; ++i) {
        raw[i] = static_cast<std::byte>(random() % 7);
    }
    const std::vector<std::byte> frame = compress(raw);
    int read_count = 0;
    for (std::size_t bit = 0; bit < frame.size() * 8; ++bit) {
        std::vector<std::byte> flipped = frame;
        flipped[bit / 8] ^= static_cast<std::byte>(1 << bit % 8);
        ASSERT_NO_FATAL_FAILURE(expectSoundOrRefused(fileOf(zstdRecipe(flipped)), read_count))
            << "bit " << bit;
    }
}

}  // namespace
}  // namespace relief
