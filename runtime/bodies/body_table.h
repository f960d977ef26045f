// SPDX-License-Identifier: Apache-2.0
// The bodies of a world as words, for the texture that shaders/bodies/world.glsl reads: maps, poses, and the broad phase of
// those at rest and of those that move. Plain arithmetic, no GL.
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

/// A body in the table: shaders/bodies/world.glsl.
struct BlockBody {
    std::int32_t maps[4];
    glm::vec4 response;
    glm::vec4 row[3];
    glm::vec4 move[3];
};
static_assert(sizeof(BlockBody) == 128);

/// A body and its place in the table.
struct TableBody {
    Pose pose;
    float restitution = 1.0F;
    float friction = 0.0F;
    std::uint32_t first_map = 0;  ///< of those that the table is made with
    std::uint32_t maps = 0;
    bool live = false;
    std::uint32_t group = 0;
    std::optional<Bounds> box;  ///< insideBox of its collider
};

class BodyTable {
  public:
    /// \param maps  blockMaps of all; bodies may share some.
    /// \param placed  each body has one map of patches, which is placed in the world, so that a point of the world finds its
    ///                cell by one transform.
    BodyTable(std::vector<BlockMap> maps, std::vector<TableBody> bodies, bool placed);

    [[nodiscard]] std::size_t size() const { return bodies_.size(); }
    [[nodiscard]] const TableBody& operator[](std::size_t body) const { return bodies_[body]; }

    /// The poses at the end of the next step; those of the call before become those at its beginning. Bodies beyond
    /// poses.size() stay.
    /// \return true if something moved.
    bool setPoses(std::span<const Pose> poses);
    /// Gives all bodies whose first map this is another one in its place.
    /// \param box  beyond which nothing of it is inside. Where theirs do not hold it, all bodies are sorted into cells anew.
    /// \return false, and nothing changes: its format or its flags are others, which the shader was not compiled for.
    [[nodiscard]] bool setMap(std::uint32_t first_map, const BlockMap& map, const std::optional<Bounds>& box);
    /// The radius of the largest ball that is asked about.
    void setReach(float radius);

    /// Texels of the texture, row by row; it is no higher than wide.
    [[nodiscard]] std::span<const glm::uvec4> words() const { return words_; }
    [[nodiscard]] int log2Width() const { return log2_width_; }
    /// The uniform block but for its first vector, u_relief_count.
    [[nodiscard]] std::vector<glm::ivec4> block() const;

    /// Rows of the texture.
    struct Rows {
        std::size_t first = 0;
        std::size_t end = 0;
    };
    /// The texture has another size, or other contents throughout, since the last takeChanges().
    [[nodiscard]] bool isNew() const { return resized_; }
    /// Those that have changed since the last call, from the first row on.
    [[nodiscard]] std::vector<Rows> takeChanges();

  private:
    [[nodiscard]] std::vector<BodyBox> boxes(bool moving) const;
    /// Writes a body, and its map where that is placed. \param before  its pose at the beginning of the step.
    void place(std::size_t body, const Pose& before);
    void arrange();
    void placeMoving();
    /// Writes a grid from this texel on. \return the texel after it.
    std::size_t write(const BodyGrid& grid, std::size_t first, std::vector<glm::ivec4>& levels);

    std::vector<BlockMap> maps_;  // where they are placed
    std::vector<TableBody> bodies_;
    std::vector<std::uint8_t> moves_;    // has moved since it was made
    std::vector<std::uint8_t> settles_;  // moved in the last call
    float reach_ = 0.0F;
    std::size_t first_body_ = 0;    // texels
    std::size_t first_moving_ = 0;  // of the grid of those that move
    std::vector<glm::uvec4> words_;
    int log2_width_ = 0;
    bool resized_ = true;
    std::vector<Rows> changes_;  // in texels
    std::vector<glm::ivec4> still_levels_;
    std::vector<glm::ivec4> moving_levels_;
};

}  // namespace relief
