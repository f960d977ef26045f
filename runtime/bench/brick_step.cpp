// SPDX-License-Identifier: Apache-2.0
#include "runtime/bench/brick_step.h"

#include <algorithm>
#include <glm/common.hpp>
#include <string>

#include "runtime/gl/compute_units.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

constexpr auto kWidth = ParticleSystem::kStateWidth;
// Texture units after those of the state.
constexpr int kIndexUnit = 3;
constexpr int kAtlasUnit = 4;

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

std::uint64_t texelsOf(const glm::ivec3& size) {
    return std::uint64_t(size.x) * size.y * size.z;
}

}  // namespace

Result<BrickStep> BrickStep::create(const BrickAtlas& atlas, const BenchScene& scene, StepPath path) {
    const auto old = [](const Birth& birth) { return birth.age != 0.0F; };
    if (scene.births.size() % kWidth != 0 || std::ranges::any_of(scene.births, old)) {
        return fail(ErrorCode::kUsage, "a brick step needs complete rows of births with age 0");
    }
    const PassState state;
    BrickStep made;
    made.path_ = RELIEF_TRY(chosenPath(path));
    made.forces_ = scene.forces;
    made.types_ = {benchParticleType()};
    made.dense_ = atlas.index.size() == 1 && atlas.bricks() == 1;
    made.makeState(scene);
    for (std::size_t i = 0; i < 2; ++i) {
        made.target_[i] = RELIEF_TRY(makeFramebuffer({made.state_[i][0].name(), made.state_[i][1].name()}));
    }
    RELIEF_TRY(made.uploadAtlas(atlas));
    RELIEF_TRY(made.compile(atlas));
    return made;
}

void BrickStep::makeState(const BenchScene& scene) {
    rows_ = static_cast<std::uint32_t>(scene.births.size() / kWidth);
    const auto texture = [&] {
        const auto rows = static_cast<GLsizei>(rows_);
        return path_ == StepPath::kCompute ? makeImageTexture2D(GL_RGBA32F, kWidth, rows)
                                           : makeTexture2D(GL_RGBA32F, kWidth, rows, GL_RGBA, GL_FLOAT);
    };
    birth_ = texture();
    for (auto& buffer : state_) {
        buffer = {texture(), texture()};
    }
}

Result<void> BrickStep::uploadAtlas(const BrickAtlas& atlas) {
    const glm::ivec3 nodes = glm::ivec3(atlas.cells) + 1;
    GLint side_max = 0;
    glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &side_max);
    const auto bricks = static_cast<std::uint32_t>(std::min<std::size_t>(atlas.bricks(), 1U << 31U));
    atlas_bricks_ = atlasOf(bricks, nodes, {false}, side_max);
    wide_ = atlas_bricks_.x == 0;
    if (wide_) {
        atlas_bricks_ = atlasOf(bricks, nodes, {true}, side_max);
    }
    if (atlas_bricks_.x == 0 || glm::any(glm::greaterThan(glm::ivec3(atlas.cubes), glm::ivec3(side_max)))) {
        return fail(ErrorCode::kLimit,
                    std::to_string(bricks) + " bricks are more than a 3-D texture of side " +
                        std::to_string(side_max) + " can hold; run relief-accuracy with a smaller --budget");
    }
    forgetGlErrors();
    const glm::ivec3 size = nodes * atlas_bricks_;
    if (atlas.bits == 8) {
        const std::vector<std::int8_t> texels = placed<std::int8_t>(atlas, atlas_bricks_);
        atlas_ = makeTexture3D(GL_R8_SNORM, size, GL_RED, GL_BYTE, GL_LINEAR, texels.data());
    } else {
        const std::vector<std::int16_t> texels = placed<std::int16_t>(atlas, atlas_bricks_);
        atlas_ = makeTexture3D(GL_R16_SNORM, size, GL_RED, GL_SHORT, GL_LINEAR, texels.data());
    }
    bytes_ = texelsOf(size) * atlas.bits / 8;
    if (!dense_) {
        const Packing packing{wide_};
        std::vector<std::uint32_t> index(atlas.index.size());
        for (std::size_t i = 0; i < index.size(); ++i) {
            const std::uint32_t value = atlas.index[i];
            const std::uint32_t brick = value - BrickAtlas::kFirstBrick;
            const glm::uvec3 counts(atlas_bricks_);
            index[i] = value == BrickAtlas::kOutside ? packing.outside()
                       : value == BrickAtlas::kInside
                           ? packing.inside()
                           : packing.of({brick % counts.x, brick / counts.x % counts.y,
                                         brick / counts.x / counts.y});
        }
        const std::vector<std::uint16_t> narrow(index.begin(), index.end());
        const void* const pixels = wide_ ? static_cast<const void*>(index.data()) : narrow.data();
        index_ = makeTexture3D(wide_ ? GL_R32UI : GL_R16UI, glm::ivec3(atlas.cubes), GL_RED_INTEGER,
                               wide_ ? GL_UNSIGNED_INT : GL_UNSIGNED_SHORT, GL_NEAREST, pixels);
        bytes_ += index.size() * (wide_ ? 4 : 2);
    }
    return checkAllocated("the bricks", "run relief-accuracy with a smaller --budget");
}

Result<void> BrickStep::compile(const BrickAtlas& atlas) {
    const Packing packing{wide_};
    const std::string defines = dense_ ? "#define RELIEF_DENSE\n"
                                       : "#define RELIEF_BRICK_BITS " + std::to_string(packing.bits()) + "\n";
    pass_ = RELIEF_TRY(
        StepPass::create({.compute = path_ == StepPath::kCompute}, {"bench/brick_step.frag", defines}));
    const GlProgram& program = pass_.program();
    program.use();
    program.set("u_index", kIndexUnit);
    program.set("u_atlas", kAtlasUnit);
    program.set("u_outside", GLuint{packing.outside()});
    program.set("u_inside", GLuint{packing.inside()});
    program.set("u_box_min", atlas.box.min);
    program.set("u_box_max", atlas.box.max);
    program.set("u_origin", atlas.origin);
    program.set("u_per_cube", 1.0F / atlas.cube_size);
    program.set("u_last_cube", glm::vec3(atlas.cubes) - 1.0F);
    program.set("u_cells", glm::vec3(atlas.cells));
    program.set("u_per_node", 1.0F / glm::vec3((glm::ivec3(atlas.cells) + 1) * atlas_bricks_));
    // Texture values of ±1 (codes ±127 or ±32767) mean ± the range.
    program.set("u_range", atlas.range);
    return {};
}

void BrickStep::begin(const BenchScene& scene) {
    std::vector<glm::vec4> position, velocity, birth;
    for (const Birth& one : scene.births) {
        position.emplace_back(one.position, 0.0F);
        velocity.emplace_back(one.velocity, 0.0F);
        birth.emplace_back(0.0F, one.lifetime, static_cast<float>(one.type), 0.0F);
    }
    const PassState state;
    const auto upload = [&](const GlTexture& texture, const std::vector<glm::vec4>& texels) {
        useTexture(0, texture);
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kWidth, static_cast<GLsizei>(rows_), GL_RGBA, GL_FLOAT,
                        texels.data());
    };
    upload(state_[current_][0], position);
    upload(state_[current_][1], velocity);
    upload(birth_, birth);
    clock_ = 0.0F;
    step();
}

void BrickStep::step() {
    const PassState state;
    const std::size_t next = 1 - current_;
    clock_ += kBenchDt;
    useTexture(StepPass::kPositionUnit, state_[current_][0]);
    useTexture(StepPass::kVelocityUnit, state_[current_][1]);
    useTexture(StepPass::kBirthUnit, birth_);
    if (!dense_) {
        useTexture3D(kIndexUnit, index_);
    }
    useTexture3D(kAtlasUnit, atlas_);
    pass_.use({.now = clock_, .dt = kBenchDt, .ground = -1e30F, .forces = forces_, .types = types_});
    if (path_ == StepPath::kCompute) {
        const ImageUnits units;
        ImageUnits::write(0, state_[next][0]);
        ImageUnits::write(1, state_[next][1]);
        pass_.dispatch(kWidth, rows_);
        ImageUnits::finish();
    } else {
        pass_.draw(target_[next].name(), kWidth, rows_);
    }
    current_ = next;
}

}  // namespace relief
