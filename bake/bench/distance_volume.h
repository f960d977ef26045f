// SPDX-License-Identifier: Apache-2.0
// The rival: a dense signed distance volume, as Unity, Unreal and Godot bake it, made as strong as it can be
// for its bytes, so that a comparison with it is worth something.
//
// - Nodes on a lattice over the tight box of the mesh. Voxels are cubes, as small as they can be with all
// nodes
//   in the budget; neither header nor padding is counted against it. Where the sides of the box are not whole
//   numbers of voxels, the lattice may reach beyond the box on both sides, beyond one corner, or be stretched
//   to fit; which is best depends on where flat faces come to lie: the caller measures all and takes the
//   best.
// - Every node holds the exact distance to the nearest triangle, with the sign of the same truth that it is
//   measured against.
// - 16-bit signed normalised values over a range that is either the largest distance of any node or a narrow
//   band round the surface, where the quantum is finer; the caller measures both, too.
// - Trilinear lookup in double precision; a GPU's texture unit has weights of 8 bits.
// - A point beyond the box is outside, whatever the nodes at the border say, and its distance to the box is
//   added.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "bake/measure/accuracy.h"
#include "bake/mesh/mesh_query.h"
#include "formats/bricks/brick_atlas.h"

namespace relief {

/// Where the lattice lies if the sides of the box are not whole numbers of voxels.
enum class LatticeFit : std::uint8_t {
    kCentered,   ///< cubes, evenly beyond the box on both sides
    kCorner,     ///< cubes, from the lowest corner of the box
    kStretched,  ///< nodes on all faces of the box; voxels shrink a little along two axes
};

/// Where the nodes are.
struct Lattice {
    glm::uvec3 nodes{2};      ///< along each axis, at least 2
    glm::dvec3 origin{0.0};   ///< of node (0, 0, 0), object space
    glm::dvec3 spacing{1.0};  ///< object units
    Bounds box;               ///< the tight box

    [[nodiscard]] std::uint64_t count() const { return std::uint64_t{nodes.x} * nodes.y * nodes.z; }
};

/// The finest lattice over a box with at most `nodes_max` nodes, and at least eight.
[[nodiscard]] Lattice makeLattice(const Bounds& box, std::uint64_t nodes_max, LatticeFit fit);

/// Exact values of all nodes, x fastest, then y.
struct DistanceGrid {
    Lattice lattice;
    std::vector<float> distances;  ///< object units, negative inside
};

[[nodiscard]] DistanceGrid sampleDistances(const MeshQuery& query, const Lattice& lattice);

/// A grid quantised to 16 bits, with the lookup of a texture unit.
class DistanceVolume {
  public:
    /// \param range  object units: distances beyond ±range are clamped.
    DistanceVolume(const DistanceGrid& grid, double range);

    /// Finds the range that the grid needs if nothing is to be clamped.
    [[nodiscard]] static double fullRange(const DistanceGrid& grid);
    /// The range of a narrow band: the distances up to `reach` from the surface, and the nodes of all voxels
    /// there. Signs of the lookup are those of the full range, but for rounding.
    [[nodiscard]] static double bandRange(const DistanceGrid& grid, double reach);

    [[nodiscard]] FieldValue at(const glm::vec3& p) const;
    [[nodiscard]] std::uint64_t bytes() const { return codes_.size() * sizeof(std::int16_t); }
    /// For a GPU: one brick.
    [[nodiscard]] BrickAtlas atlas() const;
    [[nodiscard]] const Lattice& lattice() const { return lattice_; }
    [[nodiscard]] double range() const { return range_; }

  private:
    Lattice lattice_;
    double range_;
    std::vector<std::int16_t> codes_;  // −32767 … 32767 for −range … range
};

/// \param volume  borrowed.
[[nodiscard]] Field fieldOf(const DistanceVolume& volume);

}  // namespace relief
