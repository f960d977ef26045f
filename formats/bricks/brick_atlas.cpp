// SPDX-License-Identifier: Apache-2.0
#include "formats/bricks/brick_atlas.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <glm/vector_relational.hpp>

#include "formats/base/file_io.h"
#include "formats/base/finite.h"

namespace relief {
namespace {

static_assert(std::endian::native == std::endian::little, "the file has the byte order of memory");

constexpr std::array<char, 8> kMagic{'B', 'R', 'I', 'C', 'K', 'S', '0', '1'};
constexpr std::uint32_t kSideMax = 65536;  // cubes along an axis, and voxels per brick

struct Header {
    std::array<char, 8> magic = kMagic;
    std::uint64_t bytes = 0;
    std::uint64_t codes = 0;
    std::array<float, 13> floats{};        // box, origin, cube_size, range
    std::array<std::uint32_t, 7> sizes{};  // cubes, cells, bits
};
static_assert(sizeof(Header) == 8 * 3 + 4 * 20);

Header headerOf(const BrickAtlas& atlas) {
    Header header;
    header.bytes = atlas.bytes;
    header.codes = atlas.codes.size();
    const std::array<glm::vec3, 4> vectors{atlas.box.min, atlas.box.max, atlas.origin, atlas.cube_size};
    for (std::size_t i = 0; i < 12; ++i) {
        header.floats[i] = vectors[i / 3][static_cast<int>(i % 3)];
    }
    header.floats[12] = atlas.range;
    header.sizes = {atlas.cubes.x, atlas.cubes.y, atlas.cubes.z, atlas.cells.x,
                    atlas.cells.y, atlas.cells.z, atlas.bits};
    return header;
}

/// Copies the header. Returns false for values that no writer produces.
bool readHeader(const Header& header, BrickAtlas& atlas) {
    std::array<glm::vec3, 4> vectors;
    for (std::size_t i = 0; i < 12; ++i) {
        vectors[i / 3][static_cast<int>(i % 3)] = header.floats[i];
    }
    atlas.box = {vectors[0], vectors[1]};
    atlas.origin = vectors[2];
    atlas.cube_size = vectors[3];
    atlas.range = header.floats[12];
    const auto& s = header.sizes;
    atlas.cubes = {s[0], s[1], s[2]};
    atlas.cells = {s[3], s[4], s[5]};
    atlas.bits = s[6];
    atlas.bytes = header.bytes;
    return header.magic == kMagic && std::all_of(vectors.begin(), vectors.end(), isFinite) &&
           glm::all(glm::lessThanEqual(vectors[0], vectors[1])) &&
           glm::all(glm::greaterThan(vectors[3], glm::vec3(0.0F))) && atlas.range > 0.0F &&
           atlas.range <= 1e30F &&
           std::all_of(s.begin(), s.begin() + 6, [](auto n) { return n >= 1 && n <= kSideMax; }) &&
           (atlas.bits == 8 || atlas.bits == 16);
}

template <class Value>
void append(std::vector<std::byte>& bytes, const Value* values, std::size_t count) {
    const auto* from = reinterpret_cast<const std::byte*>(values);
    bytes.insert(bytes.end(), from, from + count * sizeof(Value));
}

}  // namespace

Result<BrickAtlas> loadBrickAtlas(const std::filesystem::path& path) {
    const std::vector<std::byte> bytes = RELIEF_TRY(readFile(path));
    const auto wrong = [&] {
        return fail(ErrorCode::kInvalidInput,
                    quotedPath(path) +
                        " is not a brick atlas of this version; write it with relief-accuracy --atlas");
    };
    Header header;
    BrickAtlas atlas;
    if (bytes.size() < sizeof header) {
        return wrong();
    }
    std::memcpy(&header, bytes.data(), sizeof header);
    if (!readHeader(header, atlas)) {
        return wrong();
    }
    // Sides of up to 2^16 multiply to at most 2^48, which fits into 64 bits.
    const std::uint64_t cubes = std::uint64_t{atlas.cubes.x} * atlas.cubes.y * atlas.cubes.z;
    const std::uint64_t left = bytes.size() - sizeof header;
    if (cubes > left / 4 || header.codes != (left - 4 * cubes) / 2 || left % 2 != 0 ||
        header.codes % atlas.nodesOfBrick() != 0) {
        return wrong();
    }
    atlas.index.resize(cubes);
    atlas.codes.resize(header.codes);
    std::memcpy(atlas.index.data(), bytes.data() + sizeof header, 4 * cubes);
    std::memcpy(atlas.codes.data(), bytes.data() + sizeof header + 4 * cubes, 2 * header.codes);
    const std::size_t values = BrickAtlas::kFirstBrick + atlas.bricks();
    const auto code_max = static_cast<std::int16_t>(atlas.codeMax());
    if (std::any_of(atlas.index.begin(), atlas.index.end(), [&](auto i) { return i >= values; }) ||
        std::any_of(atlas.codes.begin(), atlas.codes.end(),
                    [&](auto c) { return c < -code_max || c > code_max; })) {
        return wrong();
    }
    return atlas;
}

Result<void> saveBrickAtlas(const BrickAtlas& atlas, const std::filesystem::path& path) {
    const Header header = headerOf(atlas);
    std::vector<std::byte> bytes;
    append(bytes, &header, 1);
    append(bytes, atlas.index.data(), atlas.index.size());
    append(bytes, atlas.codes.data(), atlas.codes.size());
    return writeFile(path, bytes);
}

}  // namespace relief
