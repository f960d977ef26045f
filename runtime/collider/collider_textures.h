// SPDX-License-Identifier: Apache-2.0
// Colliders on the GPU: three textures and a uniform block, read by shaders/collider/collider.glsl. One collider in
// its own object space, or a world of bodies with poses, which takes a fourth texture (body_table.h).
//
// Maps of one texel layout share a 2-D texture: RGBA32F for float, RGBA8 for fixed8 and cube, RGBA16UI for
// front-back of either depth. Their texels (gpu_image.h) follow each other as they do in the
// container, wrapped at the texture's width. So a texture takes the bytes of its maps and less than a row more:
//
//     bytes on the GPU < Σ texel bytes + Σ over the textures: width · texel size
//
// The width is the least power of two that makes the texture no higher than wide.
//
// Materials of colliders that have some lie in one more texture, of RGBA32UI (material_table.h); only steps read it.
//
// The maps of a live body (live_collider.h) have no texels yet: each gets a rectangle of its texture to be
// drawn to, below what is packed, and one of the float texture, of RGBA32F, for how the surface in each of
// its texels moves: a rectangle for the front and one above it for the back.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "runtime/collider/body_table.h"
#include "runtime/collider/material_table.h"
#include "runtime/collider/pose.h"
#include "runtime/gl/gl_object.h"
#include "runtime/layout/collider_block.h"
#include "runtime/layout/map_layout.h"

namespace relief {

/// A collider with a place in the world.
struct ColliderBody {
    const Collider* collider = nullptr;  ///< for create() alone
    Pose pose{};
    float restitution = 1.0F;  ///< factor of the particle's own, 0…1
    /// ν, 0…1: what is left of the tangential speed is (1 − ν) of the particle's share.
    float friction = 0.0F;
    bool live = false;  ///< the collider's maps have no texels yet; these are drawn later
    /// 0 to 7: the bit of ParticleType::collides that it answers to. Without one the body's own number, or 7 beyond that.
    std::optional<std::uint32_t> group = {};
};

/// The place of the texels of a live map.
struct LiveSlot {
    const GlTexture* texels = nullptr;  ///< the texture of its layout
    GLint x = 0;                        ///< of its texel (0, 0)
    GLint y = 0;
    const GlTexture* motion = nullptr;  ///< the float texture
    GLint motion_x = 0;
    GLint motion_y = 0;
};

class ColliderTextures {
  public:
    static constexpr std::size_t kBodiesMax = 65'536;
    static constexpr std::uint32_t kGroups = 8;
    /// Texture units and the uniform block binding that bind() uses: `first_unit`, + 1, + 2, and for a world one more.
    struct Binding {
        int first_unit = 0;
        int uniform_block = 0;
        int world_unit = 9;
        int material_unit = 10;  ///< of bindMaterials() alone
    };

    /// Uploads a collider. Needs a current context.
    /// Errors: kLimit (the texels or the number of maps above what this GL takes; the message has both
    /// numbers), kUnsupported (no maps).
    [[nodiscard]] static Result<ColliderTextures> create(const Collider& collider);
    /// Uploads up to kBodiesMax of them, which share a world; a collider that several have, once. The maps of those that
    /// are live are empty at first. Fails as above, and with kLimit (more bodies) and kUsage (a scale that is not above 0,
    /// a pose that is not finite, a share outside 0…1, a group above 7).
    /// \param room_texels  for maps of patches that come later: upload().
    [[nodiscard]] static Result<ColliderTextures> create(std::span<const ColliderBody> bodies,
                                                         std::size_t room_texels = 0);

    /// The first texel of that room.
    [[nodiscard]] std::size_t room() const { return room_; }
    /// The most texels of patches that a texture of this GL holds, those of the bodies included.
    [[nodiscard]] static std::size_t texelsMost();
    /// Of a row of the room's texture.
    [[nodiscard]] std::size_t rowTexels() const { return std::size_t{1} << room_log2_width_; }
    /// Copies texels of a map of patches into the room, for exchange(). Waits for nothing.
    /// \param first  texel of the room, counted as room() is.
    /// \param texels  whole ones, of 8 bytes, or a part of them.
    void upload(std::size_t first, std::span<const std::byte> texels);
    /// Gives all bodies that have the collider of a body another map of patches, whose texels lie in the room, or that with which
    /// they were made.
    /// \param first  its first texel; none: where the one that they were made with lies.
    /// Errors: kUnsupported: not a single map of patches, or of other flags than the one before.
    [[nodiscard]] Result<void> exchange(std::size_t body, const Collider& collider,
                                        std::optional<std::size_t> first);

    /// The poses at the end of the next step; those of the call before become those at its beginning. Call it
    /// before each step while anything moves, and once more when it has stopped. Bodies beyond poses.size() stay. Scales
    /// may not change. Costs time by the bodies that have ever moved.
    void setPoses(std::span<const Pose> poses);
    /// Says how large the balls are that will be asked about, at most, so that a world finds the bodies that they meet.
    void reach(float radius) const;

    /// One slot for each map of a live body, in their order; none for another body. The textures are this
    /// object's: call again after it has been moved.
    [[nodiscard]] std::vector<LiveSlot> liveSlots(std::size_t body) const;
    /// Says that the texels of a live body have changed.
    void noteLiveUpdate() { ++revision_; }

    /// Connects a program that includes collider.glsl: samplers, block binding. Once after linking; leaves
    /// the program current.
    void attach(const GlProgram& program, const Binding& binding) const { attach(program.name(), binding); }
    void attach(GLuint program, const Binding& binding) const;  ///< of a program of the caller's own
    /// Binds textures and block for the next draw.
    void bind(const Binding& binding) const;
    /// Binds the texture of the materials, where there are some: for shaders that include materials.glsl.
    void bindMaterials(const Binding& binding) const;
    /// Binds the block's buffer as shader storage as well, for a compute shader (collider_tour.glsl). Needs hasCompute().
    void bindStorage(int binding) const;

    /// 0 for one collider in its own space.
    [[nodiscard]] std::size_t bodyCount() const { return world_ ? world_->bodies.size() : 0; }
    /// Changes with every pose that does, and with every update of a live body.
    [[nodiscard]] std::uint64_t revision() const { return revision_; }
    /// The names of all materials, of which a shader has the numbers; equal names of several colliders are one. Empty: no collider
    /// has materials, or those that do are live.
    [[nodiscard]] std::span<const std::string> materialNames() const { return material_names_; }
    /// Some material has another restitution than 1, a friction or a loss of lifetime: without one only events need them.
    [[nodiscard]] bool materialsRespond() const { return materials_respond_; }
    /// Lines for makeProgram of a shader that includes materials.glsl, behind defines(); none without materials.
    [[nodiscard]] const std::string& materialDefines() const { return material_defines_; }
    [[nodiscard]] int mapCount() const { return map_count_; }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }  ///< of maps and materials
    /// Lines for makeProgram (collider_block.h).
    [[nodiscard]] const std::string& defines() const { return defines_; }

  private:
    [[nodiscard]] static Result<ColliderTextures> upload(std::span<const PlacedMap> maps,
                                                         std::vector<TableBody> bodies,
                                                         std::span<const Materials* const> materials,
                                                         std::size_t room_texels = 0);
    /// \param bodies  the materials of each.
    [[nodiscard]] Result<void> uploadMaterials(std::span<const Materials* const> bodies);
    struct World {
        BodyTable bodies;
        glm::ivec4 head{0};  // of the block
        GlTexture texture;
        GlBuffer upload;
    };
    /// Takes over what has changed in world_.
    void updateWorld() const;

    std::vector<MapPlace> places_;  // of the maps
    std::unique_ptr<World> world_;  // none of a single collider
    std::uint64_t revision_ = 0;
    std::array<GlTexture, kTexelKinds> textures_;
    GlTexture materials_;
    std::vector<std::string> material_names_;
    std::string material_defines_;
    MaterialHead material_head_;  // of a single collider
    bool materials_respond_ = false;
    GlBuffer block_;
    int map_count_ = 0;
    std::size_t room_ = 0;
    int room_log2_width_ = 0;  // of its texture
    std::size_t bytes_ = 0;
    std::string defines_;
};

}  // namespace relief
