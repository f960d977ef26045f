// SPDX-License-Identifier: Apache-2.0
// Rivals that keep distances near the surface alone: bricks of 8-bit nodes in a sparse grid, as Unreal, PhysX and newton
// bake them, or in an octree (Frisken 2000), made as strong as they can be for their bytes.
//
// - Cubes over the tight box of the mesh. A cube with surface in it has a brick: `cells`³ voxels with (cells + 1)³ nodes of
//   its own, so that one filtered fetch reads it. A cube without one has a sign, that of the truth at its middle. A brick
//   whose nodes are all of one sign is worth no more than that sign, and is not stored.
// - Nodes hold exact distances, or are fitted: least squares of the exact distances at random points of the voxels that the
//   surface crosses, those close to it weighing most.
// - Codes of 8 bits for distances up to `band` voxels; larger ones are clamped.
// - In an octree the cubes that displace most of the surface are split, until the bytes are used up.
// - Bytes are those on the GPU: the nodes; and the index, a texel a cube in a dense grid or in one of two levels, whichever
//   is smaller, or eight entries a split cube of an octree.
// - A point beyond the box is outside, and its distance to the box is added.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "bake/measure/accuracy.h"
#include "bake/mesh/mesh_query.h"
#include "formats/bricks/brick_atlas.h"

namespace relief {

struct BrickLayout {
    unsigned cells = 3;  ///< voxels of a brick along each axis, 2 to 8
    bool octree = false;
    bool fitted = false;
    bool flat_index = false;  ///< a dense index even where one of two levels is smaller
    double band = 2.0;        ///< voxels
};

class BrickVolume {
  public:
    /// As fine as `bytes` allow; at least one cube. \param query  borrowed.
    [[nodiscard]] static BrickVolume build(const MeshQuery& query, const BrickLayout& layout,
                                           std::uint64_t bytes);
    /// With voxels of one size. \param layout  no octree.
    [[nodiscard]] static BrickVolume withVoxels(const MeshQuery& query, const BrickLayout& layout,
                                                double voxel);

    /// Distances of cubes without a brick, and clamped ones, are ±band.
    [[nodiscard]] FieldValue at(const glm::vec3& p) const;
    [[nodiscard]] std::uint64_t nodeBytes() const { return codes_.size(); }
    [[nodiscard]] std::uint64_t indexBytes() const { return indexBytes(bricks()); }
    [[nodiscard]] std::uint64_t bytes() const { return nodeBytes() + indexBytes(); }
    [[nodiscard]] std::size_t bricks() const { return codes_.size() / nodesOfBrick(); }
    /// The smallest voxel, object units.
    [[nodiscard]] double voxel() const;
    /// For a GPU, with a dense index whatever indexBytes() counts. Of no octree.
    [[nodiscard]] BrickAtlas atlas() const;
    /// "12345 bricks of 3x3x3 in an octree, fitted"
    [[nodiscard]] std::string text() const;

  private:
    friend class BrickBuilder;

    enum class Kind : std::uint8_t { kTruth, kOutside, kInside, kBrick, kSplit };
    struct Cube {
        Kind kind = Kind::kTruth;
        std::uint32_t first = 0;  // the brick, or the first of eight cubes in cubes_
    };
    struct Root {
        std::uint64_t cell;  // x fastest
        Cube cube;
    };

    explicit BrickVolume(const MeshQuery& query, const BrickLayout& layout, double root_size);
    [[nodiscard]] std::size_t nodesOfBrick() const;
    [[nodiscard]] std::uint64_t indexBytes(std::uint64_t bricks) const;
    [[nodiscard]] std::uint64_t cellAt(const glm::dvec3& p) const;
    [[nodiscard]] FieldValue inBrick(std::uint32_t brick, const glm::dvec3& in_voxels, double voxel) const;
    [[nodiscard]] FieldValue clamped(bool inside, double cube_size) const;

    const MeshQuery* query_;
    BrickLayout layout_;
    double root_size_;  // object units
    glm::dvec3 origin_;
    glm::uvec3 roots_count_;
    std::vector<Root> roots_;  // those with surface, by cell
    std::vector<Cube> cubes_;  // eights, x fastest
    unsigned levels_ = 0;      // of splits
    std::vector<std::int8_t> codes_;
};

/// \param volume  borrowed.
[[nodiscard]] Field fieldOf(const BrickVolume& volume);

}  // namespace relief
