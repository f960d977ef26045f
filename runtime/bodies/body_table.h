// SPDX-License-Identifier: Apache-2.0
// Encodes the bodies of a world as texels of the texture that shaders/bodies/world.glsl reads: maps, poses, and
// separate broad phases for static and moving bodies. Independent of GL.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <vector>

#include "formats/collider.h"
#include "formats/world/pose.h"
#include "runtime/bodies/body_grid.h"
#include "runtime/layout/collider_block.h"

namespace relief {

/// A body in the table; must match shaders/bodies/world.glsl.
struct BlockBody {
    std::int32_t maps[4];
    glm::vec4 response;
    glm::vec4 row[3];
    glm::vec4 move[3];
};
static_assert(sizeof(BlockBody) == 128);

/// A body and its index range in the table of maps.
struct TableBody {
    Pose pose;
    float restitution = 1.0F;
    float friction = 0.0F;
    std::uint32_t first_map = 0;  ///< index into the maps given to the constructor
    std::uint32_t maps = 0;
    bool live = false;
    std::uint32_t group = 0;
    std::optional<Bounds> box;  ///< insideBox() of its collider
};

class BodyTable {
  public:
    /// \param maps  blockMaps() of all bodies; bodies may share maps.
    /// \param placed  true if each body has exactly one map of patches; each body then stores its own map in world
    /// space, so that points need only one transform to find their cell.
    BodyTable(std::vector<BlockMap> maps, std::vector<TableBody> bodies, bool placed);

    [[nodiscard]] std::size_t size() const { return bodies_.size(); }
    [[nodiscard]] const TableBody& operator[](std::size_t body) const { return bodies_[body]; }

    /// Sets the poses that bodies reach at the end of the next step; the step starts from the poses of the previous
    /// call. Bodies beyond poses.size() are unchanged.
    /// \return true if a body moved.
    bool setPoses(std::span<const Pose> poses);
    /// Replaces the map of all bodies whose first map is `first_map`.
    /// \param box  encloses the inside of the new map. If the box of a body does not contain it, the body's box grows
    /// and both broad phases are rebuilt.
    /// \return false, without changes, if the format or flags differ: the shader was not compiled for them.
    [[nodiscard]] bool setMap(std::uint32_t first_map, const BlockMap& map, const std::optional<Bounds>& box);
    /// Raises the maximum radius of the balls that shaders will query; smaller radii have no effect.
    void setReach(float radius);

    /// Returns the texels of the texture, row by row; its height does not exceed its width.
    [[nodiscard]] std::span<const glm::uvec4> words() const { return words_; }
    [[nodiscard]] int log2Width() const { return log2_width_; }
    /// Returns the uniform block without its first vector, u_relief_count.
    [[nodiscard]] std::vector<glm::ivec4> block() const;

    /// A range of texture rows.
    struct Rows {
        std::size_t first = 0;
        std::size_t end = 0;
    };
    /// Returns whether the texture was resized or rewritten completely since the last takeChanges().
    [[nodiscard]] bool isNew() const { return resized_; }
    /// Returns the rows that changed since the last call, in ascending order.
    [[nodiscard]] std::vector<Rows> takeChanges();

  private:
    [[nodiscard]] std::vector<BodyBox> boxes(bool moving) const;
    /// Writes a body, and its map if placed. \param before  pose at the start of the step.
    void place(std::size_t body, const Pose& before);
    void arrange();
    void placeMoving();
    /// Writes a grid from texel `first`. \return the texel after it.
    std::size_t write(const BodyGrid& grid, std::size_t first, std::vector<glm::ivec4>& levels);

    std::vector<BlockMap> maps_;  // with their placement
    std::vector<TableBody> bodies_;
    std::vector<std::uint8_t> moves_;    // has moved since creation
    std::vector<std::uint8_t> settles_;  // moved in the last setPoses()
    float reach_ = 0.0F;
    std::size_t first_body_ = 0;    // texel index
    std::size_t first_moving_ = 0;  // texel index of the grid of moving bodies
    std::vector<glm::uvec4> words_;
    int log2_width_ = 0;
    bool resized_ = true;
    std::vector<Rows> changes_;  // in texels
    std::vector<glm::ivec4> still_levels_;
    std::vector<glm::ivec4> moving_levels_;
};

}  // namespace relief
