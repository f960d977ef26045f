// SPDX-License-Identifier: Apache-2.0
// The settings of one map: `FORMAT[:key=value,...]` of `relief bake --map`.
//
//     float                                     512² floats, seen along −z, nearest surface
//     fixed8:dir=-y,size=1024x512               from above, 1024 texels wide
//     front-back:dir=1/1/1,box=-1/-1/-1/1/1/1   both surfaces along a diagonal, of a part of the object
//     cube:center=0/0.1/0,compare=less          all round a point in free space
//     patches:bytes=1MB                         small depth maps in an octree: formats/patch_tree.h
//     patches:texel=0.01                        the same, as fine as that everywhere
//
// clang-format off
//     key      value               formats             meaning
//     bytes    1MB, 250000         patches             what the tree may take
//     texel    0.01                patches             object units: the size that is wanted everywhere, whatever bytes that takes,
//                                                      or a larger one that takes no more than `bytes`; patches have no other keys
//     dir      +x -x … -z, a/b/c   all but cube        the direction in which the view looks; -y looks down
//     up       +x -x … -z, a/b/c   all but cube        the direction that points upwards in the image, as far as
//                                                      it is square to dir; without it, view.h's rule
//     size     N or WxH            all (cube: N)       texels, border included; a cube's along a face's edge
//     compare  less, greater       all but front-back  keep the nearest or the farthest surface along the ray
//     center   a/b/c               cube                where the rays of a cube start, object space
//     depth    unorm16, half       front-back          16-bit fixed point, or the paper's half floats
//     decode   plane, projected    all                 the distance to a plane that was fitted to the texel's
//                                                      footprint, or the paper's: along the ray to a flat texel
//     box      tight, or           all                 the part of object space that the map covers;
//              x0/y0/z0/x1/y1/z1                       a cube with a box is centred on it
// clang-format on
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "formats/depth_map.h"

namespace relief {

inline constexpr std::uint64_t kPatchBytesDefault = 1'000'000;

struct MapSpec {
    MapFormat format = MapFormat::kFrontBackFixed;
    /// kPlane: texels hold supporting planes (plane_fit.h); kProjected: the surface at their centre.
    Decode decode = Decode::kPlane;
    /// The view's direction in object space, of any length but 0; not for cubes.
    glm::vec3 direction{0.0F, 0.0F, -1.0F};
    /// Upwards in the image, in object space, of any length but 0; its component along `direction` is ignored. Not for cubes.
    /// nullopt: the rule of view.h.
    std::optional<glm::vec3> up;
    std::uint32_t width = 0;  ///< texels; 0: the resolution of the bake
    std::uint32_t height = 0;
    /// nullopt: less, or greater for a cube whose centre lies inside the mesh. Not of front-back, which keeps both.
    std::optional<Compare> compare;
    std::optional<glm::vec3> center;  ///< cubes only; nullopt: the middle of the box
    std::optional<Bounds> box;        ///< object space; nullopt: tight round the whole mesh
    std::uint64_t bytes = 0;  ///< patches only; 0: kPatchBytesDefault, or with a texel as many as it takes
    float texel = 0.0F;       ///< patches only, object units; 0: by bytes

    friend bool operator==(const MapSpec&, const MapSpec&) = default;
};

/// Settings that a text leaves out.
struct MapSpecDefaults {
    Decode decode = Decode::kPlane;
    MapFormat front_back = MapFormat::kFrontBackFixed;  ///< or kFrontBackHalf
};

/// The texels of the paper.
inline constexpr MapSpecDefaults kPaperDefaults{Decode::kProjected, MapFormat::kFrontBackHalf};

/// Errors, quoting `text` and the valid choices: kUsage (unknown or repeated key, value, a key without effect for this
/// format, up along dir), kLimit (size above kMapSizeMax).
[[nodiscard]] Result<MapSpec> parseMapSpec(std::string_view text, const MapSpecDefaults& defaults = {});

/// Errors: kUsage if up is (nearly) parallel to the direction.
[[nodiscard]] Result<void> checkUp(const MapSpec& spec);

/// The canonical text, with every setting that has an effect: parseMapSpec(toString(s)) == s if s has a size.
[[nodiscard]] std::string toString(const MapSpec& spec);

/// The paper's set, of the paper's texels: three orthogonal front-back maps and one cube, without sizes.
[[nodiscard]] std::vector<MapSpec> paperMapSpecs();

/// Checks a number of texels along a side, of a --resolution or a size.
/// \param what  names the option in the message.
/// Errors: kUsage (too small), kLimit.
[[nodiscard]] Result<std::uint32_t> checkMapSize(std::uint64_t texels, MapFormat format,
                                                 const std::string& what);

}  // namespace relief
