// SPDX-License-Identifier: Apache-2.0
// One depth map: its place in object space, its texels, and its vote for a point. CPU truth of
// shaders/collider/collider.glsl.
//
// An orthographic map looks along +z of its map coordinates. T = object_to_map carries the map's volume to
// the unit cube; x runs to the right and y upwards in the texture (row 0 is y = 0), z from near to far:
//
//          y                         the outermost ring of texels is an empty border: the volume that the
//          ^   +--+--+--+--+         map speaks for is inside it
//        1 |   |  |  |  |  |
//          |   |  |##|##|  |         texel (i, j) is centred on ((i + ½)/width, (j + ½)/height)
//        0 +   +--+--+--+--+--> x
//              0           1
//
// A cube map's T carries its volume to [−1, 1]³ about the centre; faces +X −X +Y −Y +Z −Z and their axes are
// those of OpenGL's cube maps (OpenGL 3.3, table 3.21), stored one after the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <vector>

#include "formats/texel.h"

namespace relief {

/// kLocal: each patch has a direction of its own (patch_tree.h).
enum class Projection : std::uint8_t { kOrthographic = 0, kCube = 1, kLocal = 2 };

[[nodiscard]] const char* projectionName(Projection projection);  ///< "orthographic", "cube" or "local"

/// Which surface along the ray a map keeps: the nearest, the farthest, or both (front-back).
enum class Compare : std::uint8_t { kLess = 0, kGreater = 1, kBoth = 2 };

[[nodiscard]] const char* compareName(Compare compare);  ///< "less", "greater" or "both"

/// How a vote is read from a texel: as the distance along the ray to a surface that faces the viewer (the
/// paper's), or as the distance to the plane through the surface point at the texel's centre. plane.h has
/// what encoders of planes need.
enum class Decode : std::uint8_t { kProjected = 0, kPlane = 1 };

[[nodiscard]] const char* decodeName(Decode decode);  ///< "projected" or "plane"

/// An affine map as three rows: result i = dot(row[i].xyz, p) + row[i].w, evaluated as
/// x·p.x + (y·p.y + (z·p.z + w)); the shader does the same with rows that give texels.
struct Affine {
    glm::vec4 row[3] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};

    [[nodiscard]] glm::vec3 apply(const glm::vec3& p) const;
    friend bool operator==(const Affine&, const Affine&) = default;
};

/// Writers store no plane whose normal has a smaller |cosine| than this with its texel's ray: plane and ray meet at no useful
/// depth. The texel of a wall that a view sees edge-on stores a plane that faces the viewer instead.
inline constexpr float kPlaneCosineMin = 1.0F / 32.0F;

/// Writers of maps draw surfaces that lie up to this share of the depth range outside the volume, and clamp
/// their depths to it: a surface in a face of the volume is met in spite of rounding.
inline constexpr double kDepthSlack = 1e-6;

/// Writers of maps hold a depth between those of the triangle's corners where the |cosine| of its normal with
/// the ray is no larger than this: its plane is a poor guide outside the triangle.
inline constexpr double kGrazingCosine = 1e-3;

/// The distance of a vote that knows P to be outside but not how far. A finite float, so that shaders need
/// no infinity; reports print it as "inf".
inline constexpr float kFarOutside = 1e30F;

/// The distance of no vote: the lowest float, -(2^24 - 1) 2^104. Shaders share this form of it, since ANGLE, which browsers
/// compile with, takes its shortest digits for infinite.
inline constexpr float kFarInside = -16777215.0F * 2.028240960365167e31F;

/// A limit that every map keeps, beside kMapSizeMax; `container.h` refuses files beyond them.
inline constexpr std::uint32_t kMapSizeMin = 3;  ///< orthographic: one texel inside the border

struct DepthMap {
    MapFormat format = MapFormat::kFixed8;
    Compare compare = Compare::kLess;  ///< kBoth if and only if isFrontBack(format)
    Decode decode = Decode::kProjected;
    std::uint32_t width = 0;  ///< texels; a cube's faces are width × width
    std::uint32_t height = 0;
    Affine object_to_map;  ///< its rows are orthogonal: a turn, a scale an axis, maybe a mirror, and a shift
    /// Object units for one unit along each map axis. Orthographic: z is the paper's z_scale. Cube: half the
    /// sides of the volume, the paper's s.
    glm::vec3 object_per_map{1.0F};
    /// The volume holds the whole collider, so that a point outside the volume is outside the collider.
    /// Otherwise this map abstains there.
    bool encloses = true;
    /// Rays start in free space, so that a point on a ray that meets no surface is outside. Otherwise this
    /// map abstains at an empty texel.
    bool empty_is_outside = true;
    /// faceCount() · width · height texels, row by row from y = 0, face after face.
    std::vector<std::byte> texels;

    [[nodiscard]] Projection projection() const {
        return format == MapFormat::kCube8     ? Projection::kCube
               : format == MapFormat::kPatches ? Projection::kLocal
                                               : Projection::kOrthographic;
    }
    [[nodiscard]] std::uint32_t faceCount() const { return projection() == Projection::kCube ? 6 : 1; }
    [[nodiscard]] std::uint64_t texelBytes() const {
        return std::uint64_t{faceCount()} * width * height * texelSize(format);
    }
    [[nodiscard]] std::span<const std::byte> texelAt(std::uint32_t face, std::uint32_t x,
                                                     std::uint32_t y) const;
    [[nodiscard]] std::span<std::byte> texelAt(std::uint32_t face, std::uint32_t x, std::uint32_t y);

    friend bool operator==(const DepthMap&, const DepthMap&) = default;
};

/// The vote of a map, or of a whole collider, at a point.
struct Vote {
    float distance = kFarInside;  ///< object units, positive outside
    glm::vec3 normal{0.0F};       ///< unit length, outwards; zero where the vote is only "far outside"
};

/// The rule that combines votes, in any order (paper section 4.1, rule 2): outside as soon as one vote is
/// outside; of several the smallest positive, or else the largest negative, wins. A vote of 0 is outside: the
/// paper's `vote > 0` would make the answer depend on the order where P lies exactly on a surface.
[[nodiscard]] constexpr bool replaces(float vote, float best) {
    return (best < 0.0F && vote > best) || (vote >= 0.0F && vote < best);
}

/// f_i(P) of the paper's equation 1 (../formats/README.md, "The vote of a map").
/// \param p  object space; any finite point.
/// \return nullopt where the map abstains. Front-back maps return the combined vote of both ends.
[[nodiscard]] std::optional<Vote> vote(const DepthMap& map, const glm::vec3& p);

/// The face of a cube that the direction d meets, and where on it: OpenGL's selection rule. Of equal
/// components x wins over y, and y over z.
struct CubeCoordinates {
    std::uint32_t face;  ///< 0…5: +X −X +Y −Y +Z −Z
    float s;             ///< [0, 1] across the face
    float t;
};
[[nodiscard]] CubeCoordinates cubeCoordinates(const glm::vec3& d);

/// The inverse: the direction, of largest component 1, through (s, t) of a face.
[[nodiscard]] glm::vec3 cubeDirection(const CubeCoordinates& at);

}  // namespace relief
