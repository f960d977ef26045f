// SPDX-License-Identifier: Apache-2.0
// The settings of a map: `FORMAT[:key=value,...]` of `relief bake --map`.
//
//     float                                     512² floats, seen along −z, nearest surface
//     fixed8:dir=-y,size=1024x512               from above, 1024 texels wide
//     front-back:dir=1/1/1,box=-1/-1/-1/1/1/1   both surfaces along a diagonal, of a part of the object
//     cube:center=0/0.1/0,compare=less          all around a point in free space
//     patches:budget=1MB                        small depth maps in an octree: formats/patch_tree.h
//     patches:texel=0.01                        the same, with a uniform texel size
//
// clang-format off
//     key      value               formats             meaning
//     budget   1MB, 250000         patches             maximum size of the tree
//     texel    0.01                patches             texel size, object units, for a tree of any size; with
//                                                      `budget`, the size grows until the tree fits. Patches have
//                                                      no other keys.
//     dir      +x -x … -z, a/b/c   all but cube        view direction; -y looks down
//     up       +x -x … -z, a/b/c   all but cube        direction that points up in the image, projected
//                                                      perpendicular to dir; default: the rule of view.h
//     size     N or WxH            all (cube: N)       texels, border included; for a cube, along the edge of a face
//     compare  less, greater       all but front-back  keep the nearest or the farthest surface along the ray
//     center   a/b/c               cube                origin of the rays, object space
//     depth    unorm16, half       front-back          16-bit fixed point, or the paper's half floats
//     decode   plane, projected    all                 distance to a plane fitted to the texel's footprint, or,
//                                                      as in the paper, along the ray to a flat texel
//     box      tight, or           all                 part of object space covered by the map;
//              x0/y0/z0/x1/y1/z1                       a cube with a box is centred on the box
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
    /// kPlane: texels store supporting planes (plane_fit.h); kProjected: they store the surface at their centre.
    Decode decode = Decode::kPlane;
    /// View direction in object space; any length except 0. Unused for cubes.
    glm::vec3 direction{0.0F, 0.0F, -1.0F};
    /// Direction that points up in the image, in object space; any length except 0. Its component along `direction` is
    /// ignored. nullopt: the rule of view.h. Unused for cubes.
    std::optional<glm::vec3> up;
    std::uint32_t width = 0;  ///< texels; 0: the resolution of the bake
    std::uint32_t height = 0;
    /// nullopt: less, or greater for a cube whose centre is inside the mesh. Unused for front-back, which keeps both.
    std::optional<Compare> compare;
    std::optional<glm::vec3> center;  ///< cubes only; nullopt: the centre of the box
    std::optional<Bounds> box;        ///< object space; nullopt: tight around the whole mesh
    std::uint64_t bytes = 0;          ///< patches only; 0: kPatchBytesDefault, or unlimited if `texel` is set
    float texel = 0.0F;               ///< patches only, object units; 0: limited by bytes

    friend bool operator==(const MapSpec&, const MapSpec&) = default;
};

/// Defaults for settings that are missing in the text.
struct MapSpecDefaults {
    Decode decode = Decode::kPlane;
    MapFormat front_back = MapFormat::kFrontBackFixed;  ///< or kFrontBackHalf
};

/// Texels as in the paper.
inline constexpr MapSpecDefaults kPaperDefaults{Decode::kProjected, MapFormat::kFrontBackHalf};

/// Parses the settings of a map.
/// Errors, quoting `text` and the valid choices: kUsage (unknown or repeated key, invalid value, a key without effect
/// for the format, up parallel to dir), kLimit (size above kMapSizeMax).
[[nodiscard]] Result<MapSpec> parseMapSpec(std::string_view text, const MapSpecDefaults& defaults = {});

/// Errors: kUsage if `up` is (nearly) parallel to `direction`.
[[nodiscard]] Result<void> checkUp(const MapSpec& spec);

/// Returns the canonical text with every setting that has an effect: parseMapSpec(toString(s)) == s if s has a size.
[[nodiscard]] std::string toString(const MapSpec& spec);

/// The maps of the paper, with its texels: three orthogonal front-back maps and one cube, without sizes.
[[nodiscard]] std::vector<MapSpec> paperMapSpecs();

/// Validates the number of texels along a side, from --resolution or a size.
/// \param what  name of the option, for the message.
/// Errors: kUsage (too small), kLimit.
[[nodiscard]] Result<std::uint32_t> checkMapSize(std::uint64_t texels, MapFormat format,
                                                 const std::string& what);

}  // namespace relief
