// SPDX-License-Identifier: Apache-2.0
// A map of patches: an octree whose leaves contain small depth maps of the surface. Each patch is projected along the
// one of 13 axes that suits its piece of the surface best, so no part of a mesh is hidden. formats/README.md specifies
// the format; shaders/engines/relief.glsl, formats/single/relief.h and runtime/web/engines/patches.js also implement it:
// change all together.
//
// Map space is measured in root cells: the volume is [0, n.x] × [0, n.y] × [0, n.z], and cells are cubes in object
// space. A texel has 8 bytes, four little-endian words of 16 bits. Below, `low` is the first two words and `high` the
// last two, lowest word first.
//
//     texel 0           n.x, n.y, n.z, and the number of levels below the roots
//     then              the records of the roots, x fastest; then those of split cells' children, level by level
//     then              heights, and the records of pairs
//
//     record    low                                                        high
//     outside   0 in bits 0-1; 16-31: packed normal of the nearest       distance of the cell's centre from that plane,
//               plane                                                    in root cells, positive outside: a float
//     inside    1 in bits 0-1, else as outside
//     split     2 in bits 0-1; 2-9: mask of children with a record (x    0-23: texel of the first child's record, the
//               fastest); 10-17: mask of inside children among the       others follow; 24-31: distance of the cell's
//               rest; 18-31: s and t of a coarse plane's normal, 7       centre from the coarse plane, in 128ths of the
//               bits each                                                cell, + 128
//     patch     3 in bits 0-1; 2-3: 0, 1 or 2 for 2², 3² or 5² heights;  0-23: first texel of the heights except the
//               4: outside is below; 5-6: 0 axis, 1 face diagonal,       last, a byte each, u fastest; for 2², these
//               2 cube diagonal; 7-8: the first axis; 9-10: first and    heights themselves; 24-31: scale
//               second axis mirrored; 11-22: base + 2048; 23-30: last
//               height
//     pair      3 in bits 0-1, 3 in 2-3; 4: inside is the                0-23: texel of the first patch's record; the
//               intersection of two patches, else their union            second patch's record follows it
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "formats/base/result.h"
#include "formats/texel.h"

namespace relief {

inline constexpr std::uint32_t kPatchLevelsMax = 15;  ///< splits below a root
inline constexpr std::uint32_t kPatchTexelsMax = std::uint32_t{1} << 24;
inline constexpr std::size_t kPatchTexelBytes = texelSize(MapFormat::kPatches);
inline constexpr std::uint64_t kPatchBytesMin = 1024;  ///< minimum budget of a baker
inline constexpr std::uint64_t kPatchBytesMax = std::uint64_t{kPatchTexelBytes} * kPatchTexelsMax;
inline constexpr std::uint32_t kPatchSideMax = 5;  ///< heights per side

/// The axes of a patch: depth w, and u and v across. For points in the cell's unit cube, u and v are in 0…1; w is in
/// 0…1 along an axis, 0…2 along a face diagonal, and 0…3 along the cube diagonal.
struct PatchFrame {
    std::uint8_t diagonal = 0;  ///< 0: axis, 1: face diagonal, 2: cube diagonal
    std::uint8_t first = 0;     ///< first axis; the others follow cyclically: x y z x y
    std::uint8_t mirrored = 0;  ///< bit 0: the first axis, bit 1: the second

    /// Transforms a point of the unit cube to (u, v, w).
    [[nodiscard]] glm::vec3 across(const glm::vec3& in_cell) const;
    [[nodiscard]] glm::dvec3 across(const glm::dvec3& in_cell) const;
    /// Returns the gradient of w − H(u, v) in the unit cube. \param by_u, by_v  derivatives of H
    [[nodiscard]] glm::vec3 gradient(float by_u, float by_v) const;
    friend bool operator==(const PatchFrame&, const PatchFrame&) = default;
};

/// Returns all 13 frames: along the axes, then the face diagonals, then the cube diagonals.
[[nodiscard]] const std::array<PatchFrame, 13>& patchFrames();

struct PatchRecord;

/// Returns the number of texels that the heights of a patch need in addition to its record.
[[nodiscard]] constexpr std::uint32_t heightTexels(std::uint32_t side) {
    return side == 2 ? 0 : (side * side - 1) / 8;
}

/// Encoded heights of a patch: code c is the height base/512 + c/255 · range.
struct PatchHeights {
    std::uint32_t side = 2;  ///< 2, 3 or 5
    int base = 0;            ///< −2048…2047
    std::uint8_t scale = 0;  ///< encodes range = (1 + (scale & 15)/16) · 2^((scale >> 4) − 12)
    std::array<std::uint8_t, kPatchSideMax * kPatchSideMax> codes{};

    /// Clamps heights to ±3.99, and encodes them as the nearest codes.
    [[nodiscard]] static PatchHeights of(std::span<const double> heights, std::uint32_t side);
    [[nodiscard]] float low() const { return static_cast<float>(base) * (1.0F / 512.0F); }
    [[nodiscard]] float step() const;  ///< height of one code step
    /// \param out  side² heights.
    void decode(std::span<double> out) const;
    /// Returns one of the heightTexels(side) texels.
    [[nodiscard]] PatchRecord texel(std::uint32_t index) const;
};

/// A texel of a map of patches.
struct PatchRecord {
    std::uint32_t low = 0;
    std::uint32_t high = 0;

    enum class Kind : std::uint8_t { kOutside = 0, kInside = 1, kSplit = 2, kPatch = 3 };
    [[nodiscard]] Kind kind() const { return static_cast<Kind>(low & 3U); }
    /// Split cells: mask of children with a record.
    [[nodiscard]] std::uint32_t children() const { return low >> 2U & 0xffU; }
    /// Heights along each side of a patch; 0 for a pair.
    [[nodiscard]] std::uint32_t side() const { return std::array{2U, 3U, 5U, 0U}[low >> 2U & 3U]; }
    [[nodiscard]] PatchFrame frame() const;  ///< patches only
    /// Split cells, pairs, patches of 3² or 5²: index of the first texel that the record refers to.
    [[nodiscard]] std::uint32_t first() const { return high & 0xffffffU; }

    /// \param distance  of the cell's centre from the nearest plane, in root cells, positive outside.
    [[nodiscard]] static PatchRecord flat(bool inside, const glm::vec3& normal, float distance);
    /// \param offset  distance of the cell's centre from the coarse plane, in cells, positive outside.
    [[nodiscard]] static PatchRecord split(std::uint32_t children, std::uint32_t inside, std::uint32_t first,
                                           const glm::vec3& normal, float offset);
    /// \param both  true: inside is the intersection of the two patches; false: their union.
    /// \param first  texel of the first patch's record; the second follows it.
    [[nodiscard]] static PatchRecord pair(bool both, std::uint32_t first);
    [[nodiscard]] bool isPair() const { return (low & 15U) == 15U; }
    /// \param first  texel of the heights; unused for 2².
    [[nodiscard]] static PatchRecord patch(const PatchFrame& frame, bool outside_below,
                                           const PatchHeights& heights, std::uint32_t first);
};

// The texels of a tree. They must be valid unless a function states otherwise.
using PatchTexels = std::span<const std::byte>;

/// \param index  less than the number of texels.
[[nodiscard]] PatchRecord patchTexel(PatchTexels texels, std::uint32_t index);
/// Returns the encoded heights of a patch. \param patch  not a pair.
[[nodiscard]] PatchHeights patchHeights(PatchTexels texels, const PatchRecord& patch);
/// Appends a texel.
void appendPatchTexel(std::vector<std::byte>& texels, const PatchRecord& record);

/// The contents of texel 0.
struct PatchTreeSize {
    glm::uvec3 roots{1};
    std::uint32_t levels = 0;
};
[[nodiscard]] PatchTreeSize patchTreeSize(PatchTexels texels);

/// Returns the spacing of heights in the finest possible patch, in root cells.
[[nodiscard]] double patchSpacing(PatchTexels texels);

/// Width and height of the map for a number of texels. Unused texels of the last row are zero.
struct PatchMapSize {
    std::uint32_t width;
    std::uint32_t height;
};
[[nodiscard]] PatchMapSize patchMapSize(std::size_t texels);

/// The leaf at a point.
struct PatchLeaf {
    PatchRecord record;       ///< the leaf's own record, or that of its split parent if it has none
    glm::vec3 in_cell{0.0F};  ///< the point in the unit cube of the record's cell
    float cell = 1.0F;        ///< the size of that cell, in root cells
    bool beside = false;      ///< the leaf has no record
    bool inside = false;      ///< valid for a leaf without a patch
};
/// \param p  map space, within the roots.
[[nodiscard]] PatchLeaf patchLeafAt(PatchTexels texels, const glm::vec3& p);

/// The vote at a point in map space; the distance is in root cells.
struct PatchVote {
    float distance = 0.0F;
    glm::vec3 normal{0.0F};
};
/// \param p  map space.
/// \return nullopt outside the roots.
[[nodiscard]] std::optional<PatchVote> votePatches(PatchTexels texels, const glm::vec3& p);
/// Returns whether the vote classifies a point as outside. Much faster than votePatches() in leaves without a patch.
/// \param p  map space.
/// \return false outside the roots.
[[nodiscard]] bool isOutsidePatches(PatchTexels texels, const glm::vec3& p);
/// Returns false only if no point of the box has an inside vote. Bounds the heights by the codes around the box.
/// \param low, high  map space; the part of the box outside the roots is ignored.
[[nodiscard]] bool mayBeInsidePatches(PatchTexels texels, const glm::vec3& low, const glm::vec3& high);

/// Checks that every record refers to texels of the map: split cells to the next free texels, level by level; patches
/// and pairs to texels after the records of cells. Errors: kInvalidInput.
/// \param texels  any bytes.
[[nodiscard]] Result<void> validatePatches(PatchTexels texels);

}  // namespace relief
