// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/live_collider.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <string>

#include "formats/validate.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

constexpr int kMotionXyUnit = 0;
constexpr int kMotionZUnit = 1;
constexpr int kTexelUnit = 2;

// Margin of free space and minimum thickness, relative to the longest side, as in baked tight boxes.
constexpr float kPadding = 1e-4F;
constexpr float kThicknessMin = 1e-2F;
/// Minimum texels of a short side.
constexpr std::uint32_t kTexelsMin = 16;

/// Returns true if a vertex lies in the volume of the map.
bool contains(const DepthMap& map, const glm::vec3& p) {
    const glm::vec3 q = map.object_to_map.apply(p);
    const glm::vec3 rim(1.0F / static_cast<float>(map.width), 1.0F / static_cast<float>(map.height), 0.0F);
    constexpr float kTexelRounding = 1e-5F;
    return glm::all(glm::greaterThanEqual(q, rim - kTexelRounding)) &&
           glm::all(glm::lessThanEqual(q, 1.0F - rim + kTexelRounding));
}

/// Attaches a texture to a framebuffer. Leaves it bound for drawing.
void attach(const GlFramebuffer& target, const GlTexture& texture) {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.name());
    glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture.name(), 0);
}

/// Returns whether a map has the form that liveMaps() makes.
bool isLiveMap(const DepthMap& map) {
    return map.format == MapFormat::kFrontBackFixed && map.compare == Compare::kBoth &&
           map.decode == Decode::kPlane && validateFrame(map);
}

}  // namespace

Result<Collider> liveMaps(const Bounds& box, std::uint32_t resolution, LiveSize size) {
    if (resolution < kMapSizeMin || resolution > kMapSizeMax) {
        return fail(ErrorCode::kUsage, "live maps of " + std::to_string(resolution) +
                                           " texels along a side are not supported; choose " +
                                           std::to_string(kMapSizeMin) + " to " +
                                           std::to_string(kMapSizeMax));
    }
    for (int i = 0; i < 3; ++i) {
        if (!std::isfinite(box.min[i]) || !std::isfinite(box.max[i]) || !(box.min[i] <= box.max[i]) ||
            !std::isfinite(box.size()[i])) {
            return fail(ErrorCode::kUsage, "the box of live maps is empty or not finite");
        }
    }
    const float longest = box.longestSide();
    if (!(longest > 0.0F)) {
        return fail(ErrorCode::kUsage, "the box of live maps has no extent");
    }
    const glm::vec3 middle = box.center();
    const glm::vec3 half =
        glm::max(0.5F * box.size() + kPadding * longest, glm::vec3(0.5F * kThicknessMin * longest));
    // Right, up and away, for a viewer who looks along the last axis.
    const glm::vec3 x(1, 0, 0);
    const glm::vec3 y(0, 1, 0);
    const glm::vec3 z(0, 0, 1);
    const glm::vec3 frames[3][3] = {{z, y, x}, {x, -z, -y}, {x, y, -z}};
    const float longest_half = std::max({half.x, half.y, half.z});
    // Returns the texels along a direction of the box.
    const auto texels = [&](const glm::vec3& axis) {
        const float fraction = glm::dot(glm::abs(axis), half) / longest_half;
        const auto count = static_cast<std::uint32_t>(std::ceil(fraction * static_cast<float>(resolution)));
        return size == LiveSize::kEqual ? resolution
                                        : std::clamp(count, std::min(kTexelsMin, resolution), resolution);
    };
    Collider collider;
    collider.bounds = box;
    for (const auto& axes : frames) {
        DepthMap map;
        map.format = MapFormat::kFrontBackFixed;
        map.compare = Compare::kBoth;
        map.decode = Decode::kPlane;
        map.width = texels(axes[0]);
        map.height = texels(axes[1]);
        for (int i = 0; i < 3; ++i) {
            // The border texels are empty.
            const float inner =
                i < 2 ? 1.0F - 2.0F / static_cast<float>(i == 0 ? map.width : map.height) : 1.0F;
            const float side = 2.0F * glm::dot(glm::abs(axes[i]), half) / inner;
            const glm::vec3 row = axes[i] / side;
            map.object_to_map.row[i] = glm::vec4(row, 0.5F - glm::dot(row, middle));
            map.object_per_map[i] = side;
        }
        collider.maps.push_back(std::move(map));
    }
    return collider;
}

Result<LiveCollider> LiveCollider::create(std::span<const glm::vec3> positions,
                                          std::span<const glm::uvec3> triangles, Collider frames) {
    RELIEF_TRY(checkContext());
    if (frames.maps.empty() || !std::all_of(frames.maps.begin(), frames.maps.end(), isLiveMap)) {
        return fail(ErrorCode::kUsage, "a live collider needs maps from liveMaps()");
    }
    auto mesh = RELIEF_TRY(GpuMesh::create(positions, triangles));
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    for (DepthMap& map : frames.maps) {
        map.texels.clear();
        width = std::max(width, map.width);
        height = std::max(height, map.height);
    }
    auto renderer = RELIEF_TRY(DepthMapRenderer::create(width, height));
    LiveCollider live(std::move(mesh), std::move(renderer), std::move(frames));
    const PassState state;
    live.motion_program_ = RELIEF_TRY(makeScreenProgram("live/live_motion.frag"));
    live.motion_program_.use();
    live.motion_program_.set("u_motion_xy", kMotionXyUnit);
    live.motion_program_.set("u_motion_z", kMotionZUnit);
    live.motion_program_.set("u_texels", kTexelUnit);
    live.motion_target_ = makeFramebuffer();
    live.texel_target_ = makeFramebuffer();
    return live;
}

Result<void> LiveCollider::rejectSecondChange() const {
    if (shown_ && moved_) {
        return fail(ErrorCode::kUsage,
                    "a live collider's positions were set twice between two updates, so half of "
                    "its motion would be lost; call update(), or settle() after a jump");
    }
    return {};
}

Result<void> LiveCollider::setPositions(std::span<const glm::vec3> positions) {
    RELIEF_TRY(rejectSecondChange());
    for (const DepthMap& map : frames_.maps) {
        for (std::size_t i = 0; map.encloses && i < positions.size(); ++i) {
            const glm::vec3& p = positions[i];
            if (std::isfinite(p.x + p.y + p.z) && !contains(map, p)) {
                return fail(ErrorCode::kUsage,
                            "vertex " + std::to_string(i) +
                                " leaves the box of the live collider's maps; choose a larger box");
            }
        }
    }
    RELIEF_TRY(mesh_.setPositions(positions));
    moved_ = true;
    return {};
}

Result<void> LiveCollider::setPositions(GLuint buffer, std::size_t offset) {
    RELIEF_TRY(rejectSecondChange());
    RELIEF_TRY(mesh_.setPositions(buffer, offset));
    moved_ = true;
    return {};
}

void LiveCollider::settle() {
    mesh_.settle();
    // A mesh that jumped is at rest, but its maps must still be updated.
    shown_ = shown_ && !moved_;
}

Result<void> LiveCollider::update(WorldTextures& textures, std::size_t body) {
    const std::vector<LiveSlot> slots = textures.liveSlots(body);
    if (slots.size() != frames_.maps.size()) {
        return fail(ErrorCode::kUsage, "body " + std::to_string(body) +
                                           " was not created with `live` and the maps of this collider");
    }
    if (shown_ && !moved_ && !moving_) {
        return {};
    }
    if (!shown_ || !moved_) {
        mesh_.settle();
    }
    const PassState state;
    // Once for all maps: they have the same format, so their texels share a texture, and motion is always in the float
    // texture. Drivers check a framebuffer again after each change of an attachment.
    attach(texel_target_, *slots.front().texels);
    attach(motion_target_, *slots.front().motion);
    for (std::size_t m = 0; m < slots.size(); ++m) {
        renderer_.renderInPass(mesh_, frames_.maps[m]);
        copyTexels(slots[m], frames_.maps[m]);
        copyMotion(slots[m], frames_.maps[m]);
    }
    moving_ = shown_ && moved_;
    shown_ = true;
    moved_ = false;
    textures.noteLiveUpdate();
    return {};
}

void LiveCollider::copyTexels(const LiveSlot& slot, const DepthMap& map) const {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, renderer_.framebuffer());
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, texel_target_.name());
    // glBlitFramebuffer instead of glCopyTexSubImage2D: an H200's driver copied integer formats on the CPU, 13 ms per
    // map.
    const auto width = static_cast<GLint>(map.width);
    const auto height = static_cast<GLint>(map.height);
    glBlitFramebuffer(0, 0, width, height, slot.x, slot.y, slot.x + width, slot.y + height,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void LiveCollider::copyMotion(const LiveSlot& slot, const DepthMap& map) const {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, motion_target_.name());
    useTexture(kMotionXyUnit, renderer_.motion(0));
    useTexture(kMotionZUnit, renderer_.motion(1));
    useTexture(kTexelUnit, renderer_.texels());
    motion_program_.use();
    const auto width = static_cast<GLsizei>(map.width);
    const auto height = static_cast<GLsizei>(map.height);
    motion_program_.set("u_origin", glm::ivec2(slot.motion_x, slot.motion_y));
    motion_program_.set("u_height", height);
    glViewport(slot.motion_x, slot.motion_y, width, 2 * height);
    glScissor(slot.motion_x, slot.motion_y, width, 2 * height);
    glEnable(GL_SCISSOR_TEST);
    motion_program_.drawScreen();
    glDisable(GL_SCISSOR_TEST);
}

}  // namespace relief
