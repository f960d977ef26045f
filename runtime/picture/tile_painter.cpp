// SPDX-License-Identifier: Apache-2.0
#include "runtime/picture/tile_painter.h"

#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <optional>

#include "runtime/gl/compute_units.h"
#include "runtime/gl/gl_capabilities.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "shaders/picture/constants.h"

namespace relief {
namespace {

// Storage units of tile_*.comp, of the last passes (tile_bounds.comp, tile_paint.comp) and of radix_*.comp.
constexpr GLuint kSprites = 0, kEntries = 1, kCounts = 2, kWork = 3;
constexpr GLuint kPaintEntries = 0, kPaintSprites = 1;
constexpr GLuint kFrom = 0, kTo = 1, kTotals = 3;

constexpr std::uint32_t kGroup = kRadixDigits;
constexpr std::uint32_t kDigitBits = 8;
constexpr std::uint32_t kDigitsOfTile = 2;
constexpr std::uint32_t kTilesMax = 1U << (kDigitBits * kDigitsOfTile);
constexpr std::uint32_t kBlocksMax = 2048;
constexpr std::uint32_t kEntriesPerSprite = 3;
constexpr std::uint32_t kEntriesMin = 1U << 18;
constexpr std::uint64_t kWordBytes = sizeof(std::uint32_t);
constexpr std::uint64_t kSpriteBytes = 12 * kWordBytes;
constexpr std::uint64_t kEntryBytes = 2 * kWordBytes;

std::uint32_t ceilDiv(std::uint32_t a, std::uint32_t b) {
    return (a + b - 1) / b;
}

std::uint32_t entriesFor(std::uint32_t sprites) {
    return std::max(kEntriesPerSprite * sprites, kEntriesMin);
}
static_assert(kEntriesPerSprite * TilePainter::kSpritesMax < 0xffffff);  // limit of tile_scan.comp

/// Returns whether the depth range is the default 0…1, with clipping at the near and far planes.
bool hasDefaultDepthRange() {
    std::array<GLfloat, 2> range{0.0F, 1.0F};
    glGetFloatv(GL_DEPTH_RANGE, range.data());
    bool usual = range == std::array<GLfloat, 2>{0.0F, 1.0F};
#if !defined(__EMSCRIPTEN__)
    if (!isGles()) {
        usual = usual && glIsEnabled(GL_DEPTH_CLAMP) == GL_FALSE;
        if (hasGlExtension("GL_ARB_clip_control")) {
            GLint origin = GL_LOWER_LEFT;
            GLint mode = GL_NEGATIVE_ONE_TO_ONE;
            glGetIntegerv(GL_CLIP_ORIGIN, &origin);
            glGetIntegerv(GL_CLIP_DEPTH_MODE, &mode);
            usual = usual && origin == GL_LOWER_LEFT && mode == GL_NEGATIVE_ONE_TO_ONE;
        }
    }
#endif
    return usual;
}

/// Returns the depth texture of a framebuffer, which stays bound; 0 if it has no depth; nullopt if the depth is not a
/// plain texture.
std::optional<GLuint> depthAttachmentOf(GLuint framebuffer) {
    if (framebuffer == 0) {
        return std::nullopt;
    }
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    const auto of = [](GLenum what) {
        GLint value = 0;
        glGetFramebufferAttachmentParameteriv(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, what, &value);
        return value;
    };
    GLint samples = 0;
    glGetIntegerv(GL_SAMPLES, &samples);
    const GLint type = of(GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE);
    if (type == GL_NONE) {
        return samples == 0 ? std::optional<GLuint>(0) : std::nullopt;
    }
    if (type != GL_TEXTURE || samples != 0 || of(GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_LEVEL) != 0 ||
        of(GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_CUBE_MAP_FACE) != 0 ||
        of(GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_LAYER) != 0) {
        return std::nullopt;
    }
    return static_cast<GLuint>(of(GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME));
}

/// Returns whether a texture of the caller can be read as depth: not deleted, and not a layer of an array, for example.
bool isReadable(GLuint texture) {
    if (glIsTexture(texture) == GL_FALSE) {
        return false;
    }
    clearGlErrors();
    useTexture(TilePainter::kHidesUnit, texture);
    GLint mode = GL_DEPTH_COMPONENT;
    glGetTexParameteriv(GL_TEXTURE_2D, GL_DEPTH_STENCIL_TEXTURE_MODE, &mode);
    return glGetError() == GL_NO_ERROR && mode == GL_DEPTH_COMPONENT;
}

}  // namespace

Result<TilePainter> TilePainter::create() {
    GLint group_max = 0;
    glGetIntegerv(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS, &group_max);
    if (group_max < kTileSide * kTileSide || group_max < kRadixDigits) {
        return fail(ErrorCode::kUnsupported,
                    "the work groups of this GL context are too small for tiles; use the fragment path");
    }
    const std::string counted = "#define RELIEF_RADIX_COUNTED\n";
    TilePainter painter;
    painter.scan_ = RELIEF_TRY(makeComputeProgram("picture/tile_scan.comp"));
    painter.entries_ = RELIEF_TRY(makeComputeProgram("picture/tile_entries.comp"));
    painter.bounds_ = RELIEF_TRY(makeComputeProgram("picture/tile_bounds.comp"));
    painter.count_ = RELIEF_TRY(makeComputeProgram("picture/radix_count.comp", counted));
    painter.digits_ = RELIEF_TRY(makeComputeProgram("picture/radix_scan.comp"));
    painter.move_ = RELIEF_TRY(makeComputeProgram("picture/radix_move.comp", counted));
    painter.layer_program_ = RELIEF_TRY(makeScreenProgram("picture/tile_layer.frag"));
    painter.layer_program_.use();
    painter.layer_program_.set("u_layer", 0);
    painter.plain_ = makeSampler();
    return painter;
}

const TilePainter::Programs* TilePainter::programs(const std::string& defines) const {
    const auto found = programs_.find(defines);
    return found == programs_.end() ? nullptr : &found->second;
}

Result<const TilePainter::Programs*> TilePainter::makePrograms(const std::string& defines) {
    Programs made;
    made.sprites = RELIEF_TRY(makeComputeProgram("picture/tile_sprites.comp", defines));
    made.paint = RELIEF_TRY(makeComputeProgram("picture/tile_paint.comp", defines));
    made.paint.use();
    made.paint.set("u_hides", kHidesUnit);
    return &(programs_[defines] = std::move(made));
}

bool TilePainter::prepare(std::uint32_t sprites, const RenderTarget& target) {
    const auto tiles = [](GLsizei pixels) { return ceilDiv(static_cast<std::uint32_t>(pixels), kTileSide); };
    if (sprites == 0 || sprites > kSpritesMax || !hasDefaultDepthRange() ||
        std::uint64_t{tiles(target.width)} * tiles(target.height) > std::uint64_t{kTilesMax}) {
        return false;
    }
    const std::optional<GLuint> depth = depthAttachmentOf(target.framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);  // do not read a bound attachment
    if (!depth || (*depth != 0 && *depth != depth_ && !isReadable(*depth)) || !makeRoom(sprites) ||
        !makeLayer(target)) {
        return false;
    }
    depth_ = *depth;
    count_of_sprites_ = sprites;
    return true;
}

bool TilePainter::makeRoom(std::uint32_t sprites) {
    if (sprites <= room_) {
        return true;
    }
    GLint64 block_max = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block_max);
    // Allocate half as much again, so that a growing scene rarely reallocates.
    const auto room = static_cast<std::uint32_t>(
        std::clamp<std::int64_t>(block_max / static_cast<std::int64_t>(kSpriteBytes), 0,
                                 std::min(std::max(sprites + sprites / 2, 1U << 16), kSpritesMax)));
    const std::uint32_t entries = entriesFor(room);
    if (room < sprites || static_cast<std::uint64_t>(block_max) < entries * kEntryBytes ||
        sprites >= refused_) {
        return false;
    }
    const auto make = [](std::uint64_t bytes) { return StorageUnits::make(static_cast<GLsizeiptr>(bytes)); };
    const StorageUnits storage;
    clearGlErrors();
    room_ = 0;
    sprite_buffer_ = make(room * kSpriteBytes);
    for (GlBuffer& buffer : entry_buffers_) {
        buffer = make(entries * kEntryBytes);
    }
    const std::uint32_t blocks = std::min(ceilDiv(entries, kGroup), kBlocksMax);
    counts_ = make(std::max(kGroup * blocks, kSpritesMax / kGroup) * kWordBytes);
    totals_ = make((kGroup + 1) * kWordBytes);
    work_ = make(kTileWords * kWordBytes);
    tile_bounds_ = make(kTilesMax * kEntryBytes);
    if (!checkAllocated("the entries of tiles", "")) {
        refused_ = sprites;
        sprite_buffer_ = {};
        entry_buffers_[0] = {};
        entry_buffers_[1] = {};
        return false;
    }
    room_ = room;
    return true;
}

bool TilePainter::makeLayer(const RenderTarget& target) {
    const auto width = static_cast<std::uint32_t>(target.width);
    const auto height = static_cast<std::uint32_t>(target.height);
    if (!layer_ || width > layer_width_ || height > layer_height_) {
        clearGlErrors();
        layer_width_ = std::max(width, layer_width_);
        layer_height_ = std::max(height, layer_height_);
        layer_ = {};
        layer_ = makeImageTexture2D(GL_RGBA16F, static_cast<GLsizei>(layer_width_),
                                    static_cast<GLsizei>(layer_height_));
        if (!checkAllocated("the layer of tiles", "")) {
            layer_ = {};
            layer_width_ = layer_height_ = 0;
            return false;
        }
    }
    width_ = width;
    height_ = height;
    return true;
}

void TilePainter::paint(const Programs& programs, const Vertices& vertices, bool adds) {
    const StorageUnits storage;
    const ImageUnits images;
    const std::uint32_t groups = ceilDiv(count_of_sprites_, kGroup);
    const std::uint32_t columns = ceilDiv(width_, kTileSide);
    const std::uint32_t rows = ceilDiv(height_, kTileSide);
    const auto run = [&](const GlProgram& program, std::uint32_t x, std::uint32_t y) {
        program.use();
        program.set("u_count", count_of_sprites_);
        program.set("u_tiles", glm::ivec2(columns, rows));
        program.set("u_picture", glm::ivec2(width_, height_));
        glDispatchCompute(x, y, 1);
        StorageUnits::order();
    };
    StorageUnits::order();  // buffers of the previous picture may still be in use
    StorageUnits::bind(kSprites, sprite_buffer_);
    StorageUnits::bind(kEntries, entry_buffers_[0]);
    StorageUnits::bind(kCounts, counts_);
    StorageUnits::bind(kWork, work_);
    run(programs.sprites, groups, 1);
    scan_.use();
    scan_.set("u_blocks", groups);
    scan_.set("u_vertices", vertices.count);
    scan_.set("u_room", entriesFor(count_of_sprites_));
    run(scan_, 1, 1);
    run(entries_, groups, 1);
    sortEntries();

    StorageUnits::bind(kPaintEntries, entry_buffers_[0]);
    StorageUnits::bind(kPaintSprites, sprite_buffer_);
    StorageUnits::bind(kCounts, tile_bounds_);
    StorageUnits::bind(kWork, work_);
    run(bounds_, ceilDiv(columns * rows, kGroup), 1);
    ImageUnits::write(0, layer_, GL_RGBA16F);
    programs.paint.use();
    programs.paint.set("u_adds", adds);
    programs.paint.set("u_hidden", depth_ != 0);
    if (depth_ != 0) {
        useTexture(kHidesUnit, depth_);
        glBindSampler(kHidesUnit, plain_.name());
    }
    run(programs.paint, columns, rows);
    ImageUnits::finish();
    if (depth_ != 0) {
        glBindSampler(kHidesUnit, 0);
        useTexture(kHidesUnit, 0);  // the texture becomes a render target again
    }
}

void TilePainter::sortEntries() const {
    // The number of entries is only on the GPU, so dispatch blocks for the full capacity; some blocks are empty.
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    constexpr auto kWord = static_cast<GLsizeiptr>(kWordBytes);
    copyBuffer(work_, totals_, kRadixDigits * kWord, kWord);

    const std::uint32_t lines = ceilDiv(entriesFor(count_of_sprites_), kGroup);
    const std::uint32_t turns = ceilDiv(lines, kBlocksMax);
    const std::uint32_t blocks = ceilDiv(lines, turns);
    StorageUnits::bind(kCounts, counts_);
    StorageUnits::bind(kTotals, totals_);
    for (std::uint32_t digit = 0; digit < kDigitsOfTile; ++digit) {
        StorageUnits::bind(kFrom, entry_buffers_[digit % 2]);
        StorageUnits::bind(kTo, entry_buffers_[1 - digit % 2]);
        for (const GlProgram* part : {&count_, &digits_, &move_}) {
            part->use();
            part->set("u_turns", turns);
            part->set("u_blocks", blocks);
            part->set("u_shift", digit * kDigitBits);
            glDispatchCompute(part == &digits_ ? kGroup : blocks, 1, 1);
            StorageUnits::order();
        }
    }
}

void TilePainter::show(const GlProgram& sprites, const Vertices& vertices) const {
    glDisable(GL_DEPTH_TEST);
    GLint bound_texture = 0;
    glActiveTexture(GL_TEXTURE0);
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound_texture);
    useTexture(0, layer_);
    layer_program_.drawScreen();
    useTexture(0, static_cast<GLuint>(bound_texture));

    glEnable(GL_DEPTH_TEST);
    glMemoryBarrier(GL_COMMAND_BARRIER_BIT);
    GLint bound = 0;
    glGetIntegerv(GL_DRAW_INDIRECT_BUFFER_BINDING, &bound);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, work_.name());
    glUseProgram(sprites.name());
    constexpr std::uintptr_t kFirstWord = kWordBytes;
    glDrawArraysIndirect(vertices.mode, reinterpret_cast<const void*>(kFirstWord));
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, static_cast<GLuint>(bound));
}

}  // namespace relief
