// SPDX-License-Identifier: Apache-2.0
// EXT_meshopt_compression: round trips through the meshoptimizer library, filters against their formulas, and hostile
// sizes.
#include "bake/import/gltf_data.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "bake/import/animated_import.h"
#include "tests/bake/import/animated_cases.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

using Json = nlohmann::json;
using Bytes = std::vector<std::byte>;

Bytes packAttributes(const void* values, std::size_t count, std::size_t stride) {
    Bytes packed(meshopt_encodeVertexBufferBound(count, stride));
    meshopt_encodeVertexVersion(0);
    packed.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(packed.data()), packed.size(),
                                             values, count, stride));
    return packed;
}

Bytes packIndices(const std::vector<std::uint32_t>& indices, bool triangles) {
    const std::size_t vertices = 1 + *std::max_element(indices.begin(), indices.end());
    Bytes packed(meshopt_encodeIndexBufferBound(indices.size(), vertices) +
                 meshopt_encodeIndexSequenceBound(indices.size(), vertices));
    meshopt_encodeIndexVersion(1);
    std::size_t (*encode)(unsigned char*, std::size_t, const unsigned*, std::size_t) =
        meshopt_encodeIndexSequence;
    if (triangles) {
        encode = meshopt_encodeIndexBuffer;
    }
    packed.resize(encode(reinterpret_cast<unsigned char*>(packed.data()), packed.size(), indices.data(),
                         indices.size()));
    return packed;
}

Result<Bytes> unpack(const Json& extension, const Bytes& packed, std::uint64_t size) {
    return unpackMeshopt(GltfValue(extension), packed, size);
}

template <class T>
std::vector<T> unpacked(const Json& extension, const Bytes& packed, std::size_t count) {
    const Result<Bytes> bytes = unpack(extension, packed, count * sizeof(T));
    EXPECT_TRUE(bytes) << (bytes ? "" : bytes.error().message);
    std::vector<T> values(count);
    if (bytes) {
        std::memcpy(values.data(), bytes->data(), bytes->size());
    }
    return values;
}

TEST(GltfMeshopt, DecodesPackedBuffers) {
    Dice dice(5);
    for (const std::size_t stride : {4U, 12U, 16U, 256U}) {
        std::vector<std::uint8_t> values(300 * stride);
        for (std::uint8_t& value : values) {
            value = static_cast<std::uint8_t>(dice.roll(256));
        }
        const Json extension = {{"mode", "ATTRIBUTES"}, {"count", 300}, {"byteStride", stride}};
        EXPECT_EQ(
            unpacked<std::uint8_t>(extension, packAttributes(values.data(), 300, stride), values.size()),
            values);
    }
    const std::vector<std::uint32_t> indices = {0, 1, 2, 2, 1, 3, 7, 3, 1, 70, 2, 9};
    const Bytes sequence = packIndices(indices, false);
    EXPECT_EQ(unpacked<std::uint32_t>({{"mode", "INDICES"}, {"count", 12}, {"byteStride", 4}}, sequence, 12),
              indices);
    EXPECT_EQ(unpacked<std::uint16_t>({{"mode", "INDICES"}, {"count", 12}, {"byteStride", 2}}, sequence, 12),
              std::vector<std::uint16_t>(indices.begin(), indices.end()));
    const auto triangles = unpacked<std::uint16_t>({{"mode", "TRIANGLES"}, {"count", 12}, {"byteStride", 2}},
                                                   packIndices(indices, true), 12);
    for (std::size_t i = 0; i < 12; i += 3) {
        // The triangle may start at another corner.
        std::vector<std::uint32_t> turned(indices.begin() + static_cast<std::ptrdiff_t>(i),
                                          indices.begin() + static_cast<std::ptrdiff_t>(i + 3));
        const auto first = std::find(turned.begin(), turned.end(), triangles[i]);
        ASSERT_NE(first, turned.end());
        std::rotate(turned.begin(), first, turned.end());
        EXPECT_TRUE(turned[1] == triangles[i + 1] && turned[2] == triangles[i + 2]) << i;
    }
}

TEST(GltfMeshopt, FiltersMatchTheSpecification) {
    // 2 to the power of the high byte, times the low 24 bits; both signed.
    const std::vector<std::uint32_t> powers = {0xFE000003, 0x02FFFFFF, 0x00000000, 0x01000007};
    EXPECT_EQ(
        unpacked<float>({{"mode", "ATTRIBUTES"}, {"filter", "EXPONENTIAL"}, {"count", 2}, {"byteStride", 8}},
                        packAttributes(powers.data(), 2, 8), 4),
        (std::vector<float>{0.75F, -4.0F, 0.0F, 14.0F}));
    // x and y on the octahedron; z is 1 − |x| − |y|. The scale is 64.
    const std::vector<std::int8_t> directions = {64, 0, 64, 9, 0, 0, 64, 8, 32, 32, 64, 7, 48, 48, 64, 6};
    const auto normals = unpacked<std::int8_t>(
        {{"mode", "ATTRIBUTES"}, {"filter", "OCTAHEDRAL"}, {"count", 4}, {"byteStride", 4}},
        packAttributes(directions.data(), 4, 4), 16);
    for (std::size_t i = 0; i < 16; i += 4) {
        glm::dvec3 p(directions[i] / 64.0, directions[i + 1] / 64.0, 0.0);
        p.z = 1 - std::abs(p.x) - std::abs(p.y);
        const double folded = std::max(-p.z, 0.0);
        p = 127.0 *
            glm::normalize(p - glm::dvec3(std::copysign(folded, p.x), std::copysign(folded, p.y), 0.0));
        EXPECT_LE(glm::distance(p, glm::dvec3(normals[i], normals[i + 1], normals[i + 2])), 1.0) << i;
        EXPECT_EQ(normals[i + 3], directions[i + 3]);
    }
    // Three components in units of √½, and the index of the omitted largest one.
    const std::vector<std::int16_t> packed = {1000, -500, 200, (2047 & ~3) | 2, 0, 0, 0, (2047 & ~3) | 3};
    const auto turns = unpacked<std::int16_t>(
        {{"mode", "ATTRIBUTES"}, {"filter", "QUATERNION"}, {"count", 2}, {"byteStride", 8}},
        packAttributes(packed.data(), 2, 8), 8);
    const glm::dvec3 turn = std::sqrt(0.5) / 2047.0 * glm::dvec3(1000, -500, 200);
    const std::array<double, 4> wanted = {turn.y, turn.z, std::sqrt(1 - glm::dot(turn, turn)), turn.x};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(turns[i], 32767 * wanted[i], 1.5) << i;
    }
    EXPECT_EQ(turns[7], 32767);
}

/// Compresses all views. Buffer 0 contains the compressed data; buffer 1 is a fallback without data.
GltfCase packedFile(const GltfBuilder& builder) {
    GltfCase file = builder.file();
    std::string buffer;
    Json& json = file.document;
    for (const Json& accessor : json["accessors"]) {
        Json& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
        const std::size_t count = accessor["count"];
        const std::size_t size = view["byteLength"];
        const std::size_t stride = size / count;
        const std::string values = file.buffer.substr(view["byteOffset"], size);
        const bool index = accessor["componentType"] == 5123 && accessor["type"] == "SCALAR";
        std::vector<std::uint16_t> numbers(size);
        std::memcpy(numbers.data(), values.data(), size);
        numbers.resize(count);
        const Bytes packed = index ? packIndices({numbers.begin(), numbers.end()}, false)
                                   : packAttributes(values.data(), count, stride);
        view["extensions"]["EXT_meshopt_compression"] = {
            {"buffer", 0},          {"byteOffset", buffer.size()},
            {"count", count},       {"byteLength", packed.size()},
            {"byteStride", stride}, {"mode", index ? "INDICES" : "ATTRIBUTES"}};
        view["buffer"] = 1;
        buffer.append(reinterpret_cast<const char*>(packed.data()), packed.size());
    }
    json["buffers"] = {{{"byteLength", buffer.size()}},
                       {{"byteLength", file.buffer.size()},
                        {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    json["extensionsRequired"] = {"EXT_meshopt_compression"};
    file.buffer = buffer;
    return file;
}

TEST(GltfMeshopt, PackedFilesDecodeToTheSameMeshes) {
    const TemporaryFolder folder;
    for (const GltfBuilder& builder : {bendingBar(), robot()}) {
        const auto meshOf = [&](const GltfCase& file) {
            return required(importAnimatedInWorker(writeGltf(file, folder, "m"), {})).mesh;
        };
        EXPECT_EQ(meshOf(builder.file()), meshOf(packedFile(builder)));
    }
}

TEST(GltfMeshopt, HostileSizesAreRejectedBeforeDecoding) {
    const std::vector<float> values(300, 1.5F);
    const Bytes packed = packAttributes(values.data(), 100, 12);
    const Json right = {{"mode", "ATTRIBUTES"}, {"count", 100}, {"byteStride", 12}};
    ASSERT_TRUE(unpack(right, packed, 1200));
    const auto refuse = [&](const Json& changes, const char* says, std::uint64_t size = 1200,
                            ErrorCode code = ErrorCode::kInvalidInput) {
        SCOPED_TRACE(says);
        Json extension = right;
        extension.update(changes);
        expectError(unpack(extension, packed, size), code, says);
    };
    refuse({{"count", 101}}, "unpacks to a length that differs");
    refuse(Json::object(), "unpacks to a length that differs", 1201);
    refuse({{"byteStride", 0}}, "has a byteStride or a count that its mode, ATTRIBUTES, does not allow");
    refuse({{"byteStride", 6}}, "has a byteStride or a count");
    refuse({{"byteStride", 260}}, "has a byteStride or a count");
    refuse({{"byteStride", 4}, {"count", std::uint64_t{1} << 40}}, "has too few bytes for its count",
           std::uint64_t{1} << 42);
    refuse({{"mode", "INDICES"}, {"byteStride", 4}, {"count", 300'000}}, "has too few bytes", 1'200'000);
    refuse({{"mode", "TRIANGLES"}, {"byteStride", 4}, {"count", 299}}, "has a byteStride or a count", 1196);
    refuse({{"mode", "INDICES"}, {"byteStride", 8}, {"count", 150}}, "has a byteStride or a count");
    refuse({{"mode", "MESHLETS"}}, "has the mode 'MESHLETS'", 1200, ErrorCode::kUnsupported);
    refuse({{"filter", "COLOR"}}, "has the filter 'COLOR'", 1200, ErrorCode::kUnsupported);
    refuse({{"filter", "OCTAHEDRAL"}}, "has a filter that does not fit");
    refuse({{"filter", "QUATERNION"}}, "has a filter that does not fit");
    refuse({{"mode", "TRIANGLES"}, {"byteStride", 4}, {"count", 30}}, "meshopt cannot unpack", 120);
    for (std::size_t size = 0; size < packed.size(); ++size) {
        EXPECT_FALSE(
            unpack(right, Bytes(packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(size)), 1200))
            << size;
    }
}

}  // namespace
}  // namespace relief::test
