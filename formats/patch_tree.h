// SPDX-License-Identifier: Apache-2.0
// A map of patches: the surface in small depth maps of its own, in the leaves of an octree. Each patch looks along whichever
// of 13 axes sees its piece of the surface best, so that no part of a mesh is out of sight. formats/README.md has it in words,
// shaders/collider/patches.glsl is the same in GLSL; all three change together.
//
// Map space counts root cells: the volume is [0, n.x] × [0, n.y] × [0, n.z], and cells are cubes in object space too. A texel
// has 8 bytes, four little-endian words of 16 bits; below, `low` has the first two and `high` the others, the first lowest.
//
//     texel 0           n.x, n.y, n.z, and the number of levels below the roots
//     the next ones     the records of the roots, x fastest; then those of split cells' children, level by level
//     the others        heights, and the records of pairs
//
//     record    low                                                        high
//     outside   0 in bits 0-1; 16-31: packed normal of the nearest plane   that plane's distance from the cell's middle, in
//     inside    1 in bits 0-1, else as outside                             root cells, positive outside: a float
//     split     2 in bits 0-1; 2-9: the children with a record (x          0-23: texel of the first child with a record, the
//               fastest); 10-17: of the others, those inside; 18-31: s     others follow; 24-31: the middle's distance from that
//               and t of a coarse plane's normal, of 7 bits each           plane, in 128ths of the cell, + 128
//     patch     3 in bits 0-1; 2-3: 0, 1 or 2 for 2², 3² or 5² heights;    0-23: texel of the heights but the last, a byte
//               4: outside is below; 5-6: 0 an axis, 1 a diagonal of a     each, x fastest; of 2² heights these themselves;
//               face, 2 of the cube; 7-8: the first axis; 9-10: first and  24-31: scale
//               second axis mirrored; 11-22: base + 2048; 23-30: last
//               height
//     pair      3 in bits 0-1, 3 in 2-3; 4: inside is what is in   0-23: texel of the record of a patch, which that of the
//               both of two patches, else what is in either        other one follows
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "formats/base/result.h"

namespace relief {

inline constexpr std::uint32_t kPatchLevelsMax = 15;  ///< splits below a root
inline constexpr std::uint32_t kPatchTexelsMax = std::uint32_t{1} << 24;
inline constexpr std::uint64_t kPatchBytesMin = 1024;  ///< that a baker takes
inline constexpr std::uint64_t kPatchBytesMax = 8 * std::uint64_t{kPatchTexelsMax};
inline constexpr std::uint32_t kPatchSideMax = 5;  ///< heights along a side

/// The axes of a patch: depth w, across u and v. Of a point of the cell's unit cube, u and v are in 0…1, and w in 0…1 along an
/// axis, 0…2 along the diagonal of a face and 0…3 along that of the cube.
struct PatchFrame {
    std::uint8_t diagonal = 0;  ///< 0: an axis, 1: of a face, 2: of the cube
    std::uint8_t first = 0;     ///< the axis that comes first, then those after it in the order x y z
    std::uint8_t mirrored = 0;  ///< bit 0: the first axis, bit 1: the second

    /// A point of the unit cube as (u, v, w).
    [[nodiscard]] glm::vec3 across(const glm::vec3& in_cell) const;
    [[nodiscard]] glm::dvec3 across(const glm::dvec3& in_cell) const;
    /// The gradient, in the unit cube, of w − H(u, v), with H's derivatives.
    [[nodiscard]] glm::vec3 gradient(float by_u, float by_v) const;
    friend bool operator==(const PatchFrame&, const PatchFrame&) = default;
};

/// All 13, an axis first.
[[nodiscard]] const std::array<PatchFrame, 13>& patchFrames();

struct PatchRecord;

/// Texels of a patch of side² heights beside its record.
[[nodiscard]] constexpr std::uint32_t heightTexels(std::uint32_t side) {
    return side == 2 ? 0 : (side * side - 1) / 8;
}

/// Heights of a patch as its record and texels hold them: code c stands for base/512 + c/255 · range.
struct PatchHeights {
    std::uint32_t side = 2;  ///< 2, 3 or 5
    int base = 0;            ///< −2048…2047
    std::uint8_t scale = 0;  ///< of the range: (1 + (scale & 15)/16) · 2^((scale >> 4) − 12)
    std::array<std::uint8_t, kPatchSideMax * kPatchSideMax> codes{};

    /// The nearest codes to some heights, which are held in −4…4.
    [[nodiscard]] static PatchHeights of(std::span<const double> heights, std::uint32_t side);
    [[nodiscard]] float low() const { return static_cast<float>(base) * (1.0F / 512.0F); }
    [[nodiscard]] float step() const;  ///< of a code
    /// \param out  side² heights.
    void decode(std::span<double> out) const;
    /// The index-th of the heightTexels(side).
    [[nodiscard]] PatchRecord texel(std::uint32_t index) const;
};

/// A texel of a map of patches.
struct PatchRecord {
    std::uint32_t low = 0;
    std::uint32_t high = 0;

    enum class Kind : std::uint8_t { kOutside = 0, kInside = 1, kSplit = 2, kPatch = 3 };
    [[nodiscard]] Kind kind() const { return static_cast<Kind>(low & 3U); }
    [[nodiscard]] std::uint32_t children() const { return low >> 2U & 0xffU; }  ///< of a split cell: a mask
    /// Heights along each side of a patch; 0 of a pair.
    [[nodiscard]] std::uint32_t side() const { return std::array{2U, 3U, 5U, 0U}[low >> 2U & 3U]; }
    [[nodiscard]] PatchFrame frame() const;                                 ///< of a patch
    [[nodiscard]] std::uint32_t first() const { return high & 0xffffffU; }  ///< of a split cell or a patch

    /// \param distance  of the nearest plane from the cell's middle, root cells.
    [[nodiscard]] static PatchRecord flat(bool inside, const glm::vec3& normal, float distance);
    /// \param offset  the distance of the cell's middle from the coarse plane, cells, positive outside.
    [[nodiscard]] static PatchRecord split(std::uint32_t children, std::uint32_t inside, std::uint32_t first,
                                           const glm::vec3& normal, float offset);
    /// \param both  inside is what is in both of two patches, else what is in either.
    /// \param first  texel of the first one's record, which the second one's follows.
    [[nodiscard]] static PatchRecord pair(bool both, std::uint32_t first);
    [[nodiscard]] bool isPair() const { return (low & 15U) == 15U; }
    /// \param first  texel of the heights; of no use for 2².
    [[nodiscard]] static PatchRecord patch(const PatchFrame& frame, bool outside_below,
                                           const PatchHeights& heights, std::uint32_t first);
};

// A tree as the texels of a map: any number of them that is valid, unless said otherwise.
using PatchTexels = std::span<const std::byte>;

/// \param index  below the number of texels.
[[nodiscard]] PatchRecord patchTexel(PatchTexels texels, std::uint32_t index);
/// Appends a texel.
void appendPatchTexel(std::vector<std::byte>& texels, const PatchRecord& record);

/// Texel 0.
struct PatchTreeSize {
    glm::uvec3 roots{1};
    std::uint32_t levels = 0;
};
[[nodiscard]] PatchTreeSize patchTreeSize(PatchTexels texels);

/// Between heights of the finest patches that the tree may have, in root cells.
[[nodiscard]] double patchSpacing(PatchTexels texels);

/// Width and height of a map of so many texels; the last row may have some to spare, which are zero.
struct PatchMapSize {
    std::uint32_t width;
    std::uint32_t height;
};
[[nodiscard]] PatchMapSize patchMapSize(std::size_t texels);

/// The cell that a point ends up in.
struct PatchLeaf {
    PatchRecord record;       ///< its own, or without one that of the split cell above it
    glm::vec3 in_cell{0.0F};  ///< the point in the unit cube of the record's cell
    float cell = 1.0F;        ///< the size of that, in root cells
    bool beside = false;      ///< it has no record
    bool inside = false;      ///< of one without a patch
};
/// \param p  map space, within the roots.
[[nodiscard]] PatchLeaf patchLeafAt(PatchTexels texels, const glm::vec3& p);

/// The vote on a point, in map space: its distance in root cells.
struct PatchVote {
    float distance = 0.0F;
    glm::vec3 normal{0.0F};
};
/// \param p  map space.
/// \return nullopt beyond the roots.
[[nodiscard]] std::optional<PatchVote> votePatches(PatchTexels texels, const glm::vec3& p);

/// That every record leads to texels of the map: children to the next free ones, level by level, and patches and pairs to
/// those behind the records. Fails with kInvalidInput.
/// \param texels  any bytes.
[[nodiscard]] Result<void> validatePatches(PatchTexels texels);

}  // namespace relief
