// SPDX-License-Identifier: Apache-2.0
// A cell of a tree of patches that is being planned, and the contents that a leaf may have.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "bake/patches/cell_columns.h"
#include "bake/patches/frame_choice.h"
#include "formats/patch_tree.h"

namespace relief {

inline constexpr double kPatchTexelBytes = 8.0;

/// The contents of a leaf with a surface.
struct PatchShape {
    std::uint32_t side = 0;  ///< heights along a side; 0: no surface
    bool pair = false;

    /// Texels beside the leaf's record.
    [[nodiscard]] constexpr std::uint32_t texels() const {
        return (pair ? 2 : 1) * heightTexels(side) + (pair ? 2 : 0);
    }
    /// Beyond a bit in the record above.
    [[nodiscard]] constexpr double bytes() const {
        return side > 0 ? kPatchTexelBytes * (1.0 + texels()) : 0.0;
    }
};
/// In the order in which they are tried: outside and inside without a surface, then these.
inline constexpr std::array<PatchShape, 8> kPatchShapes = {
    {{}, {}, {2, false}, {3, false}, {5, false}, {2, true}, {3, true}, {5, true}}};
inline constexpr std::size_t kFlats = 2;
inline constexpr std::size_t kFlatsAndSingles = 5;

/// Planes of a leaf for points deep inside, beside its surface (depth_planes.h).
enum class DepthPlanes : std::uint8_t {
    kNone,
    kOne,  ///< of a leaf without a surface, in a record of its own
    kTwo,  ///< as a pair of patches; of a leaf with a single surface that and another plane
};

struct PatchNode {
    FrameChoice frame;
    std::uint8_t tried = 0;   ///< of kPatchShapes
    std::uint8_t chosen = 0;  ///< of those
    bool split = false;
    bool turned = false;   ///< a single surface has the outside below
    bool walls = true;     ///< a pair has the inside between
    bool in_void = false;  ///< of one without triangles
    DepthPlanes planes = DepthPlanes::kNone;
    std::array<double, kPatchShapes.size()> errors;  ///< of each tried: volume, object units, times its costs
    double pair_least = 0.0;                         ///< errors of the best pair there could be
    double passed_by = 0.0;  ///< volume between the lines, counted with each one's errors
    double bytes = 0.0;      ///< of the tree below it, as it was chosen
    double wrong = 0.0;      ///< errors of that
    std::unique_ptr<std::array<PatchNode, 8>> children;
    MeshCell cell;
    CellPlane mean;                       ///< of the surface in the cell
    std::array<PatchHeights, 2> heights;  ///< of single surfaces of 2² and 3²
    std::array<PatchRecord, 2> depth;     ///< records of `planes`

    [[nodiscard]] bool empty() const { return cell.triangles.empty(); }
    /// Without a look at the cell, which is out of reach of the cache: what has a surface is tried as both flats.
    [[nodiscard]] bool seenEmpty() const { return tried == 1; }
    [[nodiscard]] const PatchShape& shape() const { return kPatchShapes[chosen]; }
    [[nodiscard]] bool surface() const { return shape().side > 0; }
    [[nodiscard]] bool hasRecord() const { return split || surface() || planes != DepthPlanes::kNone; }
    /// Texels beside the record of a leaf.
    [[nodiscard]] std::uint32_t texels() const {
        return (surface() ? shape().texels() : 0) + (planes == DepthPlanes::kTwo ? 2 : 0);
    }
    /// Of one without a surface.
    [[nodiscard]] bool inside() const { return empty() ? in_void || cell.bodies.inside() : chosen == 1; }
    [[nodiscard]] double cost(std::size_t index, double byte) const {
        return errors[index] + byte * kPatchShapes[index].bytes();
    }
    void add(double wrong_volume) { errors[tried++] = wrong_volume; }
    /// Takes the cheapest of those tried, where a byte is worth so much wrong volume.
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
