// SPDX-License-Identifier: Apache-2.0
// A cell of a tree of patches during planning, and the possible contents of a leaf.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "bake/patches/cell_columns.h"
#include "bake/patches/frame_choice.h"
#include "formats/patch_tree.h"

namespace relief {

/// The contents of a leaf with a surface.
struct PatchShape {
    std::uint32_t side = 0;  ///< heights along a side; 0: no surface
    bool pair = false;

    /// Texels in addition to the leaf's record.
    [[nodiscard]] constexpr std::uint32_t texels() const {
        return (pair ? 2 : 1) * heightTexels(side) + (pair ? 2 : 0);
    }
    /// Bytes in addition to a bit in the parent's record.
    [[nodiscard]] constexpr double bytes() const {
        return side > 0 ? double{kPatchTexelBytes} * (1.0 + texels()) : 0.0;
    }
};
/// Shapes in the order in which they are tried. The first kFlats have no surface: all outside, then all inside.
inline constexpr std::array<PatchShape, 8> kPatchShapes = {
    {{}, {}, {2, false}, {3, false}, {5, false}, {2, true}, {3, true}, {5, true}}};
inline constexpr std::size_t kFlats = 2;
inline constexpr std::size_t kSinglePatchShapesEnd = 5;

/// Planes of a leaf for points deep inside, in addition to any surface (depth_planes.h).
enum class DepthPlanes : std::uint8_t {
    kNone,
    kOne,  ///< for a leaf without a surface, in a separate record
    kTwo,  ///< stored like a pair of patches: two planes, or the single surface of the leaf and one plane
};

struct PatchNode {
    FrameChoice frame;
    std::uint8_t tried = 0;   ///< number of kPatchShapes tried
    std::uint8_t chosen = 0;  ///< index into kPatchShapes
    bool split = false;
    bool turned = false;   ///< a single surface has the outside below it
    bool walls = true;     ///< the inside lies between the surfaces of a pair
    bool in_void = false;  ///< a node without triangles lies in a void (struct Voids)
    DepthPlanes planes = DepthPlanes::kNone;
    /// Weighted error of each shape that was tried: volume, object units cubed.
    std::array<double, kPatchShapes.size()> errors;
    double pair_least = 0.0;     ///< lower bound of the errors of any pair
    double missed_volume = 0.0;  ///< estimated volume missed between sampling lines; included in `errors`
    double bytes = 0.0;          ///< of the chosen subtree
    double wrong = 0.0;          ///< errors of the chosen subtree
    std::unique_ptr<std::array<PatchNode, 8>> children;
    MeshCell cell;
    CellPlane mean;                       ///< mean plane of the surface in the cell
    std::array<PatchHeights, 2> heights;  ///< of single surfaces with 2² and 3² heights
    std::array<PatchRecord, 2> depth;     ///< records of `planes`

    [[nodiscard]] bool empty() const { return cell.triangles.empty(); }
    /// Equals empty() after a trial, but does not access the cell, which is rarely in the CPU cache. A node with
    /// triangles has tried at least two shapes: outside and inside without a surface.
    [[nodiscard]] bool wasEmpty() const { return tried == 1; }
    [[nodiscard]] const PatchShape& shape() const { return kPatchShapes[chosen]; }
    [[nodiscard]] bool surface() const { return shape().side > 0; }
    [[nodiscard]] bool hasRecord() const { return split || surface() || planes != DepthPlanes::kNone; }
    /// Texels in addition to the record of a leaf.
    [[nodiscard]] std::uint32_t texels() const {
        return (surface() ? shape().texels() : 0) + (planes == DepthPlanes::kTwo ? 2 : 0);
    }
    /// Whether a leaf without a surface is inside.
    [[nodiscard]] bool inside() const { return empty() ? in_void || cell.bodies.inside() : chosen == 1; }
    [[nodiscard]] double cost(std::size_t index, double byte) const {
        return errors[index] + byte * kPatchShapes[index].bytes();
    }
    void add(double wrong_volume) { errors[tried++] = wrong_volume; }
    /// Chooses the tried shape with the lowest cost(). \param byte  misclassified volume that a byte is worth.
    void chooseLeaf(double byte) {
        split = false;
        chosen = 0;
        for (std::uint8_t i = 1; i < tried; ++i) {
            chosen = cost(i, byte) < cost(chosen, byte) ? i : chosen;
        }
        bytes = shape().bytes();
        wrong = errors[chosen];
    }
};

}  // namespace relief
