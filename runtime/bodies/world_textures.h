// SPDX-License-Identifier: Apache-2.0
// Colliders with poses and materials on the GPU: a world of bodies, which takes a texture beside those of the maps
// (body_table.h), or one collider in its own object space. The materials of those that have some lie in one more texture, of
// RGBA32UI (material_table.h); only steps read it.
//
// The maps of a live body (runtime/live) have no texels yet: each gets a rectangle of its texture to be
// drawn to, below what is packed, and one of the float texture, of RGBA32F, for how the surface in each of
// its texels moves: a rectangle for the front and one above it for the back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "formats/world/pose.h"
#include "runtime/bodies/body_table.h"
#include "runtime/bodies/material_table.h"
#include "runtime/collider/map_textures.h"
#include "runtime/collider/shader_collider.h"

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

class WorldTextures : public ShaderCollider {
  public:
    static constexpr std::size_t kBodiesMax = 65'536;
    static constexpr std::uint32_t kGroups = 8;

    /// Uploads a collider in its own object space, with its materials. Fails as ColliderTextures::create does.
    [[nodiscard]] static Result<WorldTextures> create(const Collider& collider);
    /// Uploads up to kBodiesMax of them, which share a world; a collider that several have, once. The maps of those that
    /// are live are empty at first. Fails as above, and with kLimit (more bodies) and kUsage (a scale that is not above 0,
    /// a pose that is not finite, a share outside 0…1, a group above 7).
    /// \param room_texels  for maps of patches that come later: upload().
    [[nodiscard]] static Result<WorldTextures> create(std::span<const ColliderBody> bodies,
                                                      std::size_t room_texels = 0);

    /// The first texel of that room.
    [[nodiscard]] std::size_t room() const { return room_; }
    /// The most texels of patches that a texture of this GL holds, those of the bodies included.
    [[nodiscard]] static std::size_t texelsMost();
    /// The texels in a row of the room's texture.
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

    /// One slot for each map of a live body, in their order; none for another body. The textures are this
    /// object's: call again after it has been moved.
    [[nodiscard]] std::vector<LiveSlot> liveSlots(std::size_t body) const;
    /// After the texels of a live body have changed.
    void noteLiveUpdate() { ++revision_; }

    using ShaderCollider::attach;
    void attach(GLuint program, const Binding& binding) const override;
    void bind(const Binding& binding) const override;
    void bindStorage(int binding) const override { maps_.bindStorage(binding); }
    void bindMaterials(const Binding& binding) const override;
    void reach(float radius) const override;
    [[nodiscard]] const std::string& defines() const override { return defines_; }
    [[nodiscard]] int mapCount() const override { return maps_.count(); }
    [[nodiscard]] std::size_t bytes() const override { return maps_.bytes() + material_bytes_; }
    [[nodiscard]] std::size_t bodyCount() const override { return world_ ? world_->bodies.size() : 0; }
    [[nodiscard]] std::uint64_t revision() const override { return revision_; }
    [[nodiscard]] std::span<const std::string> materialNames() const override { return materials_.names; }
    [[nodiscard]] bool materialsRespond() const override { return materials_.responds; }
    [[nodiscard]] std::string materialDefines() const override;

  private:
    struct World {
        BodyTable bodies;
        glm::ivec4 head{0};  // of the block
        GlTexture texture;
        GlBuffer upload;
    };
    /// \param materials  of each body.
    [[nodiscard]] static Result<WorldTextures> upload(std::span<const PlacedMap> maps,
                                                      std::vector<TableBody> bodies,
                                                      std::span<const Materials* const> materials,
                                                      std::size_t room_texels = 0);
    [[nodiscard]] Result<void> uploadMaterials(std::span<const Materials* const> bodies);
    /// Takes over what has changed in world_.
    void updateWorld() const;

    std::vector<MapPlace> places_;  // of the maps
    MapTextures maps_;
    std::string defines_;
    std::unique_ptr<World> world_;  // null: one collider
    std::uint64_t revision_ = 0;
    MaterialTable materials_;  // without its texels
    GlTexture material_texture_;
    std::size_t material_bytes_ = 0;
    std::size_t room_ = 0;
    int room_log2_width_ = 0;  // of its texture
};

}  // namespace relief
