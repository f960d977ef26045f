// SPDX-License-Identifier: Apache-2.0
// Sparse distance volumes, baselines for colliders: bricks of 8-bit nodes near the surface, in a sparse grid as Unreal,
// PhysX and Newton bake them, or in an octree (Frisken 2000). They are as accurate as possible for their bytes.
//
// - Cubes cover the tight box of the mesh. A cube that contains surface has a brick of `cells`³ voxels. Bricks share no
//   nodes: each has (cells + 1)³, so that one filtered fetch reads it. Any other cube stores only the sign of the exact
//   distance at its centre. A brick whose nodes have equal signs is stored as that sign.
// - Nodes store exact distances, or a least-squares fit to the exact distances at random points of the voxels that the
//   surface crosses. Points close to the surface have the largest weights.
// - 8-bit codes for distances up to `band` voxels; larger distances are clamped.
// - In an octree, the cubes with the largest total surface error are split until the bytes are used up.
// - Sizes are bytes on the GPU: the nodes and the index. The index is a dense or two-level grid of the cubes, whichever
//   is smaller; for an octree, it has one entry per root and eight per split cube.
// - A point beyond the box is outside; its distance to the box is added to the field at the nearest point of the box.
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
    unsigned cells = 3;  ///< voxels along each axis of a brick, 2 to 8
    bool octree = false;
    bool fitted = false;
    bool flat_index = false;  ///< use a dense index even if a two-level index is smaller
    double band = 2.0;        ///< voxels
};

class BrickVolume {
  public:
    /// Builds the finest volume within `bytes`, with at least one cube. \param query  borrowed.
    [[nodiscard]] static BrickVolume build(const MeshQuery& query, const BrickLayout& layout,
                                           std::uint64_t bytes);
    /// Builds a volume with voxels of a given size. \param layout  not an octree.
    [[nodiscard]] static BrickVolume withVoxels(const MeshQuery& query, const BrickLayout& layout,
                                                double voxel);

    /// Returns the field. Distances in cubes without a brick, and clamped distances, are ±band voxels.
    [[nodiscard]] FieldValue at(const glm::vec3& p) const;
    [[nodiscard]] std::uint64_t nodeBytes() const { return codes_.size(); }
    [[nodiscard]] std::uint64_t indexBytes() const { return indexBytes(bricks()); }
    [[nodiscard]] std::uint64_t bytes() const { return nodeBytes() + indexBytes(); }
    [[nodiscard]] std::size_t bricks() const { return codes_.size() / nodesOfBrick(); }
    /// The side of the smallest voxel, object units.
    [[nodiscard]] double voxel() const;
    /// Returns the data for a GPU, always with a dense index, regardless of indexBytes(). Not for an octree.
    [[nodiscard]] BrickAtlas atlas() const;
    /// "12345 bricks of 3x3x3 in an octree, fitted"
    [[nodiscard]] std::string text() const;

  private:
    friend class BrickBuilder;

    enum class Kind : std::uint8_t { kTruth, kOutside, kInside, kBrick, kSplit };
    struct Cube {
        Kind kind = Kind::kTruth;
        std::uint32_t first = 0;  // index of the brick, or of the first of eight cubes in cubes_
    };
    struct Root {
        std::uint64_t cell;  // x fastest
        Cube cube;
    };

    explicit BrickVolume(const MeshQuery& query, const BrickLayout& layout, double root_size);
    [[nodiscard]] std::size_t nodesOfBrick() const;
    [[nodiscard]] std::uint64_t indexBytes(std::uint64_t bricks) const;
    [[nodiscard]] std::uint64_t cellAt(const glm::dvec3& p) const;
    [[nodiscard]] glm::uvec3 rootOf(std::uint64_t cell) const;
    [[nodiscard]] Cube cubeOf(std::uint64_t cell) const;
    [[nodiscard]] FieldValue inBrick(std::uint32_t brick, const glm::dvec3& in_voxels, double voxel) const;
    [[nodiscard]] FieldValue clamped(bool inside, double cube_size) const;

    const MeshQuery* query_;
    BrickLayout layout_;
    double root_size_;  // object units
    glm::dvec3 origin_;
    glm::uvec3 roots_count_;
    std::vector<Root> roots_;  // cubes that contain surface, sorted by cell
    std::vector<Cube> cubes_;  // groups of eight, x fastest
    unsigned levels_ = 0;      // depth of the octree
    std::vector<std::int8_t> codes_;
};

/// \param volume  borrowed.
[[nodiscard]] Field fieldOf(const BrickVolume& volume);

}  // namespace relief
