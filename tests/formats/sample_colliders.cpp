// SPDX-License-Identifier: Apache-2.0
#include "tests/formats/sample_colliders.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "formats/base/hash.h"
#include "formats/container.h"
#include "formats/container_reader.h"
#include "tests/formats/analytic_shapes.h"
#include "tests/formats/random_patches.h"

namespace relief::test {

Collider oneMapOfEveryFormat() {
    const auto sphere = makeSphere({0.5, 0.25, -0.5}, 0.6);
    const OrthographicFrame frame =
        centeredFrame({0.5, 0.25, -0.5}, rotation({1, 2, 3}, 40.0), {3.0, 3.5, 2.0});
    Collider collider;
    collider.bounds = {{-0.125F, -0.375F, -1.125F}, {1.125F, 0.875F, 0.125F}};
    collider.unit = "m";
    collider.provenance = {"Kugel – 球.obj",
                           "0123456789abcdef0123456789abcdef",
                           1'234'567'890'123,
                           "relief 0.1.0",
                           {{"map", "float:dir=+x,size=8x7"}}};
    collider.maps.push_back(makeMap(*sphere, frame, MapFormat::kFloat32, Compare::kGreater, 8, 7));
    collider.maps.push_back(makeMap(*sphere, frame, MapFormat::kFixed8, Compare::kLess, 7, 8));
    collider.maps.push_back(makeMap(*sphere, frame, MapFormat::kFrontBackHalf, Compare::kBoth, 8, 8));
    collider.maps.push_back(makeMap(*makeSphere({0.9, 0.25, -0.5}, 0.3),
                                    CubeFrame{{0.5, 0.25, -0.5}, rotation({1, 0, 0}, 10.0), {1.0, 1.1, 1.2}},
                                    Compare::kLess, 4));
    collider.maps.push_back(makeMap(*sphere, frame, MapFormat::kFrontBackFixed, Compare::kBoth, 8, 8));
    std::mt19937 random(17);
    collider.maps.push_back(randomPatches(random));
    collider.maps[1].encloses = false;
    collider.maps[3].empty_is_outside = false;
    collider.maps[1].decode = Decode::kPlane;
    collider.maps[3].decode = Decode::kPlane;
    collider.maps[4].decode = Decode::kPlane;
    return collider;
}

Materials someMaterials() {
    Materials made;
    made.list = {
        {"oak", 0.5F, 0.25F, 0.0F, 0.5F}, {"stone", 1.0F, 0.0F, 2.0F, 0.25F}, {"", 1.0F, 0.0F, 0.0F, 0.25F}};
    made.sides = {{4, 1, 2}};
    made.origin = glm::vec3(-2.0F);
    made.size = 4.0F;
    made.nodes.resize(2);
    made.nodes[0].head = 1U << 8U | 0x80U;
    made.nodes[0].leaves = {3, 0, 0, 0, 0, 0, 0, 0};
    made.nodes[1].leaves = {2, 1, 1, 1, 1, 1, 1, 1};
    return made;
}

Collider readmeExample() {
    Collider collider;
    collider.bounds = {{-0.5F, -0.5F, -0.5F}, {0.5F, 0.5F, 0.5F}};
    collider.unit = "m";
    collider.provenance = {
        "cube.obj", "00112233445566778899aabbccddeeff", 12, "relief 0.1.0", {{"map", "fixed8"}}};
    // [−2, 2]² × [−1, 1], seen along +z: the middle texel stores the plane z = −½.
    const OrthographicFrame frame = centeredFrame({0, 0, 0}, glm::dmat3(1.0), {4, 4, 2});
    DepthMap map = emptyMap(frame, MapFormat::kFixed8, Compare::kLess, 3, 3);
    encodeTexel(map.format, {Surface{0.25F, {0, 0, -1}}, std::nullopt}, map.texelAt(0, 1, 1));
    collider.maps.push_back(map);
    return collider;
}

std::vector<std::byte> written(const Collider& collider, int level) {
    Result<std::vector<std::byte>> bytes = writeContainer(collider, {level});
    EXPECT_TRUE(bytes) << bytes.error().message;
    return bytes ? *bytes : std::vector<std::byte>();
}

void fixChecksums(std::vector<std::byte>& bytes) {
    ContainerHeader header;
    std::memcpy(&header, bytes.data(), sizeof(header));
    const std::span<const std::byte> all(bytes);
    header.metadata_hash = xxh3_64(all.subspan(header.metadata_offset, header.metadata_size));
    header.header_hash = header.computeHash();
    std::memcpy(bytes.data(), &header, sizeof(header));
}

std::vector<std::byte> toBytes(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

}  // namespace relief::test
