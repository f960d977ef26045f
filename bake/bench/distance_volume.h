// SPDX-License-Identifier: Apache-2.0
// Dense distance volumes as Unity, Unreal and Godot bake them, as baselines for colliders. The volumes are as accurate
// as possible for their bytes, to make the comparison fair.
//
// - Nodes lie on a lattice over the tight box of the mesh. Voxels are the smallest cubes for which all nodes fit the
//   budget; headers and padding are not counted. If the sides of the box are not whole numbers of voxels, the lattice
//   may extend beyond the box on both sides, extend beyond one corner, or be stretched to fit. The best choice depends
//   on the positions of flat faces: the caller measures all three and uses the best.
// - Every node stores the exact distance to the nearest triangle, signed by MeshQuery::inside(), as in the truth.
// - 16-bit signed normalised values. Their range is either the largest distance of any node, or a narrow band around
//   the surface, where the resolution is finer; the caller measures both.
// - The lookup is trilinear in double precision, although texture units of GPUs have 8-bit weights.
// - Points beyond the box are outside: their distance to the box is added to the border value, clamped to at least 0.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "bake/measure/accuracy.h"
#include "bake/mesh/mesh_query.h"
#include "formats/bricks/brick_atlas.h"

namespace relief {

/// Computes signed distances at a sequence of points, each near the previous one.
class DistanceWalk {
  public:
    explicit DistanceWalk(const MeshQuery& query) : query_(query) {}

    [[nodiscard]] double at(const glm::dvec3& exact);

  private:
    const MeshQuery& query_;
    std::optional<std::uint32_t> nearby_;
    glm::dvec3 from_{0.0};
    double before_ = 0.0;
};

/// Position of the lattice if the sides of the box are not whole numbers of voxels.
enum class LatticeFit : std::uint8_t {
    kCentered,   ///< cubes, extending equally beyond the box on both sides
    kCorner,     ///< cubes, starting at the lowest corner of the box
    kStretched,  ///< nodes on all faces of the box; voxels shrink slightly along two axes
};

/// The positions of the nodes.
struct Lattice {
    glm::uvec3 nodes{2};      ///< along each axis, at least 2
    glm::dvec3 origin{0.0};   ///< position of node (0, 0, 0), object space
    glm::dvec3 spacing{1.0};  ///< object units
    Bounds box;               ///< the tight box

    [[nodiscard]] std::uint64_t count() const { return std::uint64_t{nodes.x} * nodes.y * nodes.z; }
};

/// Returns the finest lattice over a box. It has at most `nodes_max` nodes, but at least eight.
[[nodiscard]] Lattice makeLattice(const Bounds& box, std::uint64_t nodes_max, LatticeFit fit);

/// Exact values of all nodes, x fastest, then y.
struct DistanceGrid {
    Lattice lattice;
    std::vector<float> distances;  ///< object units, negative inside
};

[[nodiscard]] DistanceGrid sampleDistances(const MeshQuery& query, const Lattice& lattice);

/// A grid quantised to 16 bits, with trilinear lookup.
class DistanceVolume {
  public:
    /// \param range  object units: distances beyond ±range are clamped.
    DistanceVolume(const DistanceGrid& grid, double range);

    /// Returns the smallest range that clamps no value of the grid.
    [[nodiscard]] static double fullRange(const DistanceGrid& grid);
    /// Returns the range of a narrow band: `reach` plus a voxel's diagonal, at most fullRange(). It clamps no node of a
    /// voxel within `reach` of the surface. The lookup has the same signs as with the full range, except for rounding.
    [[nodiscard]] static double bandRange(const DistanceGrid& grid, double reach);

    [[nodiscard]] FieldValue at(const glm::vec3& p) const;
    [[nodiscard]] std::uint64_t bytes() const { return codes_.size() * sizeof(std::int16_t); }
    /// Returns the data for a GPU: one brick.
    [[nodiscard]] BrickAtlas atlas() const;
    [[nodiscard]] const Lattice& lattice() const { return lattice_; }
    [[nodiscard]] double range() const { return range_; }

  private:
    Lattice lattice_;
    double range_;
    std::vector<std::int16_t> codes_;  // −32767 to 32767 for −range to range
};

/// \param volume  borrowed.
[[nodiscard]] Field fieldOf(const DistanceVolume& volume);

}  // namespace relief
