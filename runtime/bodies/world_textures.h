// SPDX-License-Identifier: Apache-2.0
// Colliders with poses and materials on the GPU: either a world of bodies, which uses an additional texture
// (body_table.h), or a single collider in its own object space. Materials are stored in one more RGBA32UI texture
// (material_table.h), which only steps read.
//
// The maps of a live body (runtime/live) have no texels at first. Each is rendered into a rectangle of its format's
// texture, below the packed texels. Each map also has a rectangle of the float texture (RGBA32F) for the motion of the
// surface in each texel: the first half of its rows for the front, the second for the back.
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

/// A collider placed in the world.
struct ColliderBody {
    const Collider* collider = nullptr;  ///< used only by create()
    Pose pose{};
    float restitution = 1.0F;  ///< multiplies the particle's restitution, 0…1
    /// 0…1; contacts multiply tangential speed by 1 − friction of the body and by that of the particle.
    float friction = 0.0F;
    bool live = false;  ///< the collider's maps have no texels yet; they are rendered later
    /// Bit of ParticleType::collides_with for this body, 0 to 7. nullopt: min(index of the body, 7).
    std::optional<std::uint32_t> group = {};
};

/// The place in the textures where a live map is rendered.
struct LiveSlot {
    const GlTexture* texels = nullptr;  ///< texture of its format
    GLint x = 0;                        ///< position of its texel (0, 0)
    GLint y = 0;
    const GlTexture* motion = nullptr;  ///< the float texture
    GLint motion_x = 0;
    GLint motion_y = 0;
};

class WorldTextures : public ShaderCollider {
  public:
    static constexpr std::size_t kBodiesMax = 65'536;
    static constexpr std::uint32_t kGroups = 8;

    /// Uploads a collider in its own object space, with its materials. Errors: those of ColliderTextures::create.
    [[nodiscard]] static Result<WorldTextures> create(const Collider& collider);
    /// Uploads up to kBodiesMax bodies that share a world. A collider that several bodies use is uploaded once. The
    /// maps of live bodies are empty at first.
    /// \param room_texels  number of texels reserved for maps of patches that upload() adds later.
    /// Errors: as above; kLimit (too many bodies), kUsage (a scale that is not above 0, a pose that is not finite, a
    /// factor outside 0…1, a group above 7).
    [[nodiscard]] static Result<WorldTextures> create(std::span<const ColliderBody> bodies,
                                                      std::size_t room_texels = 0);

    /// Returns the index of the first reserved texel.
    [[nodiscard]] std::size_t room() const { return room_; }
    /// Returns the maximum number of patch texels in one texture of this context, including those of the bodies.
    [[nodiscard]] static std::size_t maxTexels();
    /// Returns the texels per row of the texture with the reserved range.
    [[nodiscard]] std::size_t rowTexels() const { return std::size_t{1} << room_log2_width_; }
    /// Copies texels of a map of patches into the reserved range, for exchange(). Does not wait.
    /// \param first  index of a texel in the texture, room() or above.
    /// \param texels  whole texels of 8 bytes; may be part of a map.
    void upload(std::size_t first, std::span<const std::byte> texels);
    /// Sets the map of all bodies with this body's collider to a map of patches in the reserved range, or to the
    /// original map.
    /// \param first  first texel of the new map; nullopt: the original map.
    /// Errors: kUnsupported (not a single map of patches, or flags that differ from the previous map).
    [[nodiscard]] Result<void> exchange(std::size_t body, const Collider& collider,
                                        std::optional<std::size_t> first);

    /// Sets the poses that bodies reach at the end of the next step; the step starts from the poses of the previous
    /// call. Call it before each step while any body moves, and once after all have stopped. Bodies beyond poses.size()
    /// are unchanged. Scales must not change. The cost grows with the number of bodies that have ever moved.
    void setPoses(std::span<const Pose> poses);

    /// Returns one slot for each map of a live body, in order; empty for other bodies. They point into this object;
    /// call again after std::move.
    [[nodiscard]] std::vector<LiveSlot> liveSlots(std::size_t body) const;
    /// Call after the texels of a live body have changed.
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
    [[nodiscard]] bool materialsAffectReaction() const override { return materials_.responds; }
    [[nodiscard]] std::string materialDefines() const override;

  private:
    struct World {
        BodyTable bodies;
        glm::ivec4 head{0};  // blockHead()
        GlTexture texture;
        GlBuffer upload;
    };
    /// \param materials  one for each body.
    [[nodiscard]] static Result<WorldTextures> upload(std::span<const PlacedMap> maps,
                                                      std::vector<TableBody> bodies,
                                                      std::span<const Materials* const> materials,
                                                      std::size_t room_texels = 0);
    [[nodiscard]] Result<void> uploadMaterials(std::span<const Materials* const> bodies);
    /// Uploads the changes in world_.
    void updateWorld() const;

    std::vector<MapPlace> places_;  // one for each map
    MapTextures maps_;
    std::string defines_;
    std::unique_ptr<World> world_;  // null for a single collider
    std::uint64_t revision_ = 0;
    MaterialTable materials_;  // `texels` is emptied after the upload
    GlTexture material_texture_;
    std::size_t material_bytes_ = 0;
    std::size_t room_ = 0;
    int room_log2_width_ = 0;  // of the texture with the reserved range
};

}  // namespace relief
