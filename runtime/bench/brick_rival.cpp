// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <glm/common.hpp>
#include <string>
#include <utility>

#include "runtime/bench/rival_step.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

/// Packs the coordinates of a brick in the atlas into 16 or 32 bits. The two largest values are reserved.
struct Packing {
    bool wide;

    [[nodiscard]] std::uint32_t bits() const { return wide ? 10 : 5; }  // bits of x and of y
    [[nodiscard]] std::uint32_t outside() const { return wide ? 0xffffffffU : 0xffffU; }
    [[nodiscard]] std::uint32_t inside() const { return outside() - 1; }
    [[nodiscard]] std::uint32_t of(const glm::uvec3& brick) const {
        return brick.x | brick.y << bits() | brick.z << 2 * bits();
    }
};

/// Returns the number of bricks along each axis of the atlas, with few unused bricks; zero if the bricks do not fit.
glm::ivec3 atlasOf(std::uint32_t bricks, const glm::ivec3& nodes, const Packing& packing, int side_max) {
    const auto most = [&](int axis, std::uint32_t bits) {
        return std::min<std::uint32_t>(1U << bits, static_cast<std::uint32_t>(side_max / nodes[axis]));
    };
    const std::uint32_t most_z = most(2, packing.wide ? 12 : 6);
    glm::ivec3 best(0);
    std::uint64_t least = ~std::uint64_t{0};
    for (std::uint32_t x = 1; x <= most(0, packing.bits()); ++x) {
        for (std::uint32_t y = 1; y <= most(1, packing.bits()); ++y) {
            const std::uint32_t z = std::max((bricks + x * y - 1) / (x * y), 1U);
            // The two largest codes are reserved.
            const bool fits = z <= most_z && packing.of({x - 1, y - 1, z - 1}) < packing.inside();
            if (fits && std::uint64_t{x} * y * z < least) {
                least = std::uint64_t{x} * y * z;
                best = {x, y, z};
            }
        }
    }
    return best;
}

/// Returns the codes, arranged as in the atlas.
template <class Code>
std::vector<Code> placed(const BrickAtlas& atlas, const glm::ivec3& bricks) {
    const glm::ivec3 nodes = glm::ivec3(atlas.cells) + 1;
    const glm::ivec3 size = bricks * nodes;
    std::vector<Code> texels(std::size_t(size.x) * size.y * size.z);
    for (std::size_t i = 0; i < atlas.codes.size(); ++i) {
        const auto brick = static_cast<int>(i / atlas.nodesOfBrick());
        const auto node = static_cast<int>(i % atlas.nodesOfBrick());
        const glm::ivec3 at =
            nodes * glm::ivec3(brick % bricks.x, brick / bricks.x % bricks.y, brick / bricks.x / bricks.y) +
            glm::ivec3(node % nodes.x, node / nodes.x % nodes.y, node / nodes.x / nodes.y);
        texels[(std::size_t(at.z) * size.y + at.y) * size.x + at.x] = static_cast<Code>(atlas.codes[i]);
    }
    return texels;
}

/// Returns the index with the atlas position of each brick.
std::vector<std::uint32_t> packedIndex(const BrickAtlas& atlas, const glm::uvec3& bricks,
                                       const Packing& packing) {
    std::vector<std::uint32_t> index(atlas.index.size());
    for (std::size_t i = 0; i < index.size(); ++i) {
        const std::uint32_t value = atlas.index[i];
        const std::uint32_t brick = value - BrickAtlas::kFirstBrick;
        index[i] =
            value == BrickAtlas::kOutside ? packing.outside()
            : value == BrickAtlas::kInside
                ? packing.inside()
                : packing.of({brick % bricks.x, brick / bricks.x % bricks.y, brick / bricks.x / bricks.y});
    }
    return index;
}

void uploadIndex(Rival& rival, const std::vector<std::uint32_t>& index, const glm::ivec3& size, bool wide) {
    const std::vector<std::uint16_t> narrow(index.begin(), index.end());
    const void* const pixels = wide ? static_cast<const void*>(index.data()) : narrow.data();
    rival.textures.push_back({"u_index",
                              makeTexture3D(wide ? GL_R32UI : GL_R16UI, size, GL_RED_INTEGER,
                                            wide ? GL_UNSIGNED_INT : GL_UNSIGNED_SHORT, GL_NEAREST, pixels),
                              true});
    rival.bytes += index.size() * (wide ? 4 : 2);
}

void uploadCodes(Rival& rival, const BrickAtlas& atlas, const glm::ivec3& bricks) {
    const glm::ivec3 size = (glm::ivec3(atlas.cells) + 1) * bricks;
    GlTexture texture;
    if (atlas.bits == 8) {
        const std::vector<std::int8_t> texels = placed<std::int8_t>(atlas, bricks);
        texture = makeTexture3D(GL_R8_SNORM, size, GL_RED, GL_BYTE, GL_LINEAR, texels.data());
    } else {
        const std::vector<std::int16_t> texels = placed<std::int16_t>(atlas, bricks);
        texture = makeTexture3D(GL_R16_SNORM, size, GL_RED, GL_SHORT, GL_LINEAR, texels.data());
    }
    rival.textures.push_back({"u_atlas", std::move(texture), true});
    rival.bytes += std::uint64_t(size.x) * size.y * size.z * atlas.bits / 8;
}

std::function<void(const GlProgram&)> uniformsOf(const BrickAtlas& atlas, const glm::ivec3& bricks,
                                                 const Packing& packing) {
    return [=, box = atlas.box, origin = atlas.origin, per_cube = 1.0F / atlas.cube_size,
            last_cube = glm::vec3(atlas.cubes) - 1.0F, cells = atlas.cells,
            range = atlas.range](const GlProgram& program) {
        program.set("u_outside", GLuint{packing.outside()});
        program.set("u_inside", GLuint{packing.inside()});
        program.set("u_box_min", box.min);
        program.set("u_box_max", box.max);
        program.set("u_origin", origin);
        program.set("u_per_cube", per_cube);
        program.set("u_last_cube", last_cube);
        program.set("u_cells", glm::vec3(cells));
        program.set("u_per_node", 1.0F / glm::vec3((glm::ivec3(cells) + 1) * bricks));
        // Texture values of ±1 (codes ±127 or ±32767) mean ± the range.
        program.set("u_range", range);
    };
}

}  // namespace

Result<Rival> makeBrickRival(const BrickAtlas& atlas) {
    const PassState state;
    const glm::ivec3 nodes = glm::ivec3(atlas.cells) + 1;
    GLint side_max = 0;
    glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &side_max);
    const auto count = static_cast<std::uint32_t>(std::min<std::size_t>(atlas.bricks(), 1U << 31U));
    Packing packing{false};
    glm::ivec3 bricks = atlasOf(count, nodes, packing, side_max);
    if (bricks.x == 0) {
        packing = {true};
        bricks = atlasOf(count, nodes, packing, side_max);
    }
    if (bricks.x == 0 || glm::any(glm::greaterThan(glm::ivec3(atlas.cubes), glm::ivec3(side_max)))) {
        return fail(ErrorCode::kLimit,
                    std::to_string(count) + " bricks are more than a 3-D texture of side " +
                        std::to_string(side_max) + " can hold; run relief-accuracy with a smaller --budget");
    }
    const bool dense = atlas.index.size() == 1 && atlas.bricks() == 1;
    Rival rival;
    rival.shader = {"bench/brick_step.frag",
                    dense ? "#define RELIEF_DENSE\n"
                          : "#define RELIEF_BRICK_BITS " + std::to_string(packing.bits()) + "\n"};
    clearGlErrors();
    uploadCodes(rival, atlas, bricks);
    if (!dense) {
        uploadIndex(rival, packedIndex(atlas, glm::uvec3(bricks), packing), glm::ivec3(atlas.cubes),
                    packing.wide);
    }
    RELIEF_TRY(checkAllocated("the bricks", "run relief-accuracy with a smaller --budget"));
    rival.set = uniformsOf(atlas, bricks, packing);
    return rival;
}

}  // namespace relief
