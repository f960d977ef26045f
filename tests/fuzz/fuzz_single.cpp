// SPDX-License-Identifier: Apache-2.0
// Containers in relief.h: it accepts what the library accepts, if the container is one map of patches, and gives the same
// distances and normals, bit by bit.
#include <zstd.h>

#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "formats/collider.h"
#include "formats/container.h"
#include "tests/fuzz/target.h"

#define RELIEF_IMPLEMENTATION
#define RELIEF_UNPACKED_MAX (1 << 20)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"
#include "formats/single/relief.h"
#pragma GCC diagnostic pop

namespace {

/// As those of relief.h.
constexpr relief::ContainerLimits kLimits{.memory = RELIEF_UNPACKED_MAX};

bool haveSameBits(const float* a, const float* b, std::size_t count) {
    return std::memcmp(a, b, count * sizeof(float)) == 0;
}

void compareAt(const relief_collider& single, const relief::Collider& collider, const glm::vec3& p) {
    const relief::FieldSample expected = relief::evaluate(collider, p);
    glm::vec3 normal(1.0F);
    const float distance = relief_distance(&single, &p.x, &normal.x);
    mustHold(haveSameBits(&distance, &expected.distance, 1), "distances are the same");
    mustHold(haveSameBits(&normal.x, &expected.normal.x, 3), "normals are the same");
}

/// Returns the point of object space at a point of map space.
glm::vec3 fromMap(const relief::DepthMap& map, const glm::dvec3& at) {
    glm::dvec3 p(0.0);
    for (int k = 0; k < 3; ++k) {
        const glm::dvec4 row(map.object_to_map.row[k]);
        const double scale = map.object_per_map[k];
        p += glm::dvec3(row) * (scale * scale * (at[k] - row.w));
    }
    return glm::vec3(p);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // An odd address: relief.h must not require an alignment.
    std::vector<std::byte> bytes(1 + size);
    std::memcpy(bytes.data() + 1, data, size);
    const auto given = std::span(bytes).subspan(1);
    relief_collider single;
    const relief_status status = relief_open(&single, given.data(), given.size(), ZSTD_decompress);
    mustBeLine(relief_message(status));
    mustHold((status == RELIEF_OK) == (single.texels != nullptr), "only an open collider has texels");

    const auto collider = relief::readContainer(given, kLimits);
    if (!collider) {
        mustHold(status != RELIEF_OK, "relief.h rejects what the library rejects");
        return 0;
    }
    if (collider->maps.size() != 1 || !collider->hasPatches()) {
        mustHold(status == RELIEF_UNSUPPORTED, "relief.h supports only one map of patches");
        return 0;
    }
    mustHold(status == RELIEF_OK, "relief.h accepts what the library accepts");
    mustHold(collider->unit == single.unit && haveSameBits(single.bounds_min, &collider->bounds.min.x, 3) &&
                 haveSameBits(single.bounds_max, &collider->bounds.max.x, 3),
             "unit and bounds are the same");

    const relief::DepthMap& map = collider->maps.front();
    const std::size_t texel_bytes = std::size_t{RELIEF_WIDTH} * static_cast<std::size_t>(single.height) * 8;
    mustHold(texel_bytes >= map.texels.size() &&
                 std::memcmp(single.texels, map.texels.data(), map.texels.size()) == 0,
             "texels are the same");
    relief_collider uncompressed;
    const relief_status without = relief_open(&uncompressed, given.data(), given.size(), nullptr);
    mustHold(without == RELIEF_OK || without == RELIEF_COMPRESSED, "only compression needs a decompressor");
    relief_close(&uncompressed);
    const auto* const constants = single.constants.size;
    for (int i = 0; i < 64; ++i) {
        const glm::dvec3 at(i % 4, i / 4 % 4, i / 16);
        const glm::dvec3 in_map = (at / 2.9 - 0.011) * glm::dvec3(constants[1], constants[2], constants[3]);
        compareAt(single, *collider, fromMap(map, in_map));
    }
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const float far : {1e30F, -3e38F, 0.0F, kInfinity, std::numeric_limits<float>::quiet_NaN()}) {
        compareAt(single, *collider, glm::vec3(far, 1.0F, -far));
    }
    relief_close(&single);
    relief_close(&single);
    mustHold(single.texels == nullptr, "a closed collider has no texels");
    return 0;
}
