// SPDX-License-Identifier: Apache-2.0
// The settings of a map: `FORMAT[:key=value,...]` of `relief bake --map`.
//
//     float                                     512² floats, seen along −z, nearest surface
//     fixed8:dir=-y,size=1024x512               from above, 1024 texels wide
//     front-back:dir=1/1/1,box=-1/-1/-1/1/1/1   both surfaces along a diagonal, of a part of the object
//     cube:center=0/0.1/0,compare=less          all around a point in free space
//     patches:budget=1MB                        small depth maps in an octree: formats/patch_tree.h
//     patches:texel=0.01                        the same, with a uniform texel size
#pragma once

#include <array>
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

struct MapKey {
    std::string_view key;
    std::string_view formats;  ///< formats that accept the key
    std::string_view text;     ///< description for the manual
};
inline constexpr std::array kMapKeys = std::to_array<MapKey>({
    {"budget", "patches", "size limit on the GPU as in --budget, 1MB by default"},
    {"texel", "patches", "texel length as in --texel; budget is then an upper limit"},
    {"dir", "float, fixed8, front-back", "view direction: +x, -x, +y, -y, +z, -z or a vector a/b/c"},
    {"up", "float, fixed8, front-back", "up direction of the image, as in dir"},
    {"size", "all but patches", "texels: N, or WxH if not a cube"},
    {"compare", "float, fixed8, cube",
     "less (default) keeps the nearest surface, greater the farthest; a cube whose centre is inside the mesh "
     "defaults to greater"},
    {"center", "cube", "viewpoint a/b/c, by default the middle of the box"},
    {"depth", "front-back", "unorm16 (default): 16-bit fixed point; half: half floats, as in the paper"},
    {"decode", "all but patches",
     "plane (default): distance to a plane fitted to the whole texel; projected: along the ray to a flat "
     "texel, as in the paper"},
    {"box", "all but patches", "region to cover: tight (default) or x0/y0/z0/x1/y1/z1"},
});

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
