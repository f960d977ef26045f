// SPDX-License-Identifier: Apache-2.0
// One depth map: its transform from object space, its texels, and its vote at a point. CPU reference of
// shaders/collider/collider.glsl.
//
// An orthographic map looks along +z of its map coordinates. T = object_to_map maps the map's volume to the unit cube.
// In the texture, x runs to the right and y upwards (row 0 is y = 0); z runs from near to far:
//
//          y                         the outermost ring of texels is an empty border; the map only represents the
//          ^   +--+--+--+--+         volume inside it
//        1 |   |  |  |  |  |
//          |   |  |##|##|  |         texel (i, j) is centred on ((i + ½)/width, (j + ½)/height)
//        0 +   +--+--+--+--+--> x
//              0           1
//
// In a cube map, T maps the volume to [−1, 1]³, and rays start at its centre. The faces +X −X +Y −Y +Z −Z and their
// axes follow OpenGL's cube maps (OpenGL 3.3, table 3.21); they are stored one after the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <vector>

#include "formats/texel.h"

namespace relief {

/// kLocal: each patch has its own direction (patch_tree.h).
enum class Projection : std::uint8_t { kOrthographic = 0, kCube = 1, kLocal = 2 };

[[nodiscard]] const char* projectionName(Projection projection);  ///< "orthographic", "cube" or "local"

/// Selects which surface on the ray of a texel is stored: the nearest, the farthest, or both (front-back).
enum class Compare : std::uint8_t { kLess = 0, kGreater = 1, kBoth = 2 };

[[nodiscard]] const char* compareName(Compare compare);  ///< "less", "greater" or "both"

/// How a texel becomes a vote: the distance along the ray to the stored depth (the paper: Kolb et al. 2004), or the
/// distance to the plane through the surface point at the texel's centre. Writers compute rays with plane.h.
enum class Decode : std::uint8_t { kProjected = 0, kPlane = 1 };

[[nodiscard]] const char* decodeName(Decode decode);  ///< "projected" or "plane"

/// An affine transform as three rows: result i = dot(row[i].xyz, p) + row[i].w,
/// evaluated as x·p.x + (y·p.y + (z·p.z + w)). Shaders do the same, but with x and y in texels for
/// orthographic maps.
struct Affine {
    glm::vec4 row[3] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};

    [[nodiscard]] glm::vec3 apply(const glm::vec3& p) const;
    /// Returns the matrix that transforms directions.
    [[nodiscard]] glm::dmat3 linear() const;
    /// Returns the inverse of linear(), which must exist.
    [[nodiscard]] glm::dmat3 inverse() const;
    /// Returns whether no entry is infinite or NaN.
    [[nodiscard]] bool isFinite() const;
    friend bool operator==(const Affine&, const Affine&) = default;
};

/// Smallest |cosine| between a stored plane's normal and its texel's ray: below it, plane and ray do not meet at a
/// useful depth. For walls seen edge-on, writers store a plane that faces the viewer instead.
inline constexpr float kPlaneCosineMin = 1.0F / 32.0F;

/// Writers also rasterize surfaces that miss the volume by at most this fraction of its depth range, and clamp the
/// depths. Rounding then never drops a surface that lies in a face of the volume.
inline constexpr double kDepthSlack = 1e-6;

/// If the |cosine| between a triangle's normal and the ray is at most this, writers clamp depths to the range of the
/// triangle's corners: its plane extrapolates poorly outside the triangle.
inline constexpr double kGrazingCosine = 1e-3;

/// Distance of a vote for "outside at an unknown distance". A finite float because shaders then need no infinity;
/// reports print "inf".
inline constexpr float kFarOutside = 1e30F;

/// Initial distance before any vote: the lowest float, -(2^24 - 1) 2^104. Shaders use this same expression because
/// ANGLE, the shader translator of browsers, parses the shortest decimal form as infinity.
inline constexpr float kFarInside = -16777215.0F * 2.028240960365167e31F;

/// Minimum size of an orthographic map: one texel inside the border. The maximum is kMapSizeMax.
inline constexpr std::uint32_t kMapSizeMin = 3;

struct PatchRecord;  // patch_tree.h

struct DepthMap {
    MapFormat format = MapFormat::kFixed8;
    Compare compare = Compare::kLess;  ///< kBoth if and only if isFrontBack(format)
    Decode decode = Decode::kProjected;
    std::uint32_t width = 0;  ///< texels; a cube's faces are width × width
    std::uint32_t height = 0;
    Affine
        object_to_map;  ///< rows are orthogonal: a rotation, a scale per axis, an optional mirror, and a translation
    /// Object units per map unit along each map axis. Orthographic: z is the paper's z_scale. Cube: half the sides of
    /// the volume, the paper's s.
    glm::vec3 object_per_map{1.0F};
    /// True if the volume contains the whole collider, so that points outside the volume are outside the collider. If
    /// false, the map abstains there.
    bool encloses = true;
    /// True if rays start in free space, so that points on a ray without a surface are outside. If false, the map
    /// abstains at empty texels.
    bool empty_is_outside = true;
    /// faceCount() · width · height texels, row by row from y = 0, face by face.
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
    /// Sets width, height and texels of a map with the format kPatches. \param records  all texels of the tree
    void setPatches(std::span<const PatchRecord> records);

    friend bool operator==(const DepthMap&, const DepthMap&) = default;
};

struct Vote {
    float distance = kFarInside;  ///< object units, positive outside
    glm::vec3 normal{0.0F};       ///< unit length, outwards; zero for kFarOutside
};

/// Combination rule of votes, independent of their order (paper section 4.1, rule 2). A point is outside if any vote is
/// outside. The smallest outside vote wins; if there is none, the inside vote closest to 0. A vote of 0 is outside:
/// with the paper's `vote > 0`, the result at a point on a surface would depend on the order.
[[nodiscard]] constexpr bool replaces(float vote, float best) {
    return (best < 0.0F && vote > best) || (vote >= 0.0F && vote < best);
}

/// Computes f_i(P) of the paper's equation 1 (formats/README.md, "The vote of a map").
/// \param p  object space; any finite point.
/// \return nullopt if the map abstains. Front-back maps return the combined vote of both surfaces.
[[nodiscard]] std::optional<Vote> vote(const DepthMap& map, const glm::vec3& p);

/// The cube face that direction d hits and the position on it, by OpenGL's selection rule. Ties between components are
/// resolved in the order x, y, z.
struct CubeCoordinates {
    std::uint32_t face;  ///< 0…5: +X −X +Y −Y +Z −Z
    float s;             ///< [0, 1] across the face
    float t;
};
[[nodiscard]] CubeCoordinates cubeCoordinates(const glm::vec3& d);

/// Inverse of cubeCoordinates(): returns the direction through (s, t) of a face; its largest component is 1.
[[nodiscard]] glm::vec3 cubeDirection(const CubeCoordinates& at);

}  // namespace relief
