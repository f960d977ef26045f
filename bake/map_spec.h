// What the user asks of one map: `FORMAT[:key=value,...]`, the argument of `relief bake --map`.
//
//     float                                     512² floats, seen along −z, nearest surface
//     fixed8:dir=-y,size=1024x512               from above, 1024 texels wide
//     front-back:dir=1/1/1,box=-1/-1/-1/1/1/1   both surfaces along a diagonal, of a part of the object
//     cube:center=0/0.1/0,compare=less          all round a point in free space
//
//     key      value                formats            meaning
//     dir      +x -x +y -y +z -z    all but cube       the direction in which the view looks; -y looks down
//              x y z, or a/b/c
//     size     N or WxH             all (cube: N)      texels, border included; a cube's along one edge of a
//     face compare  less, greater        all but front-back keep the nearest or the farthest surface along
//     the ray center   a/b/c                cube               where the rays of a cube start, object space
//     depth    half, unorm16        front-back         the paper's half floats, or 16-bit fixed point
//     decode   projected, plane     all                the paper's distance along the ray to a flat texel, or
//     the
//                                                      distance to a plane fitted to the texel's footprint
//     box      tight, or            all                the part of object space that the map speaks for;
//              x0/y0/z0/x1/y1/z1                       a cube with a box is centred on it
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "formats/collider.h"
#include "formats/depth_map.h"
#include "formats/result.h"

namespace relief {

struct MapSpec {
    MapFormat format = MapFormat::kFrontBackHalf;
    /// kPlane: texels hold supporting planes (plane_fit.h); kProjected: the surface at their centre.
    Decode decode = Decode::kProjected;
    /// The view's direction in object space, of any length but 0; not for cubes.
    glm::vec3 direction{0.0F, 0.0F, -1.0F};
    /// Texels; 0 stands for the default resolution of the bake.
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    /// Not for front-back. nullopt: less; for a cube, greater if its centre lies inside the mesh.
    std::optional<Compare> compare;
    /// Cubes only. nullopt: the middle of the box.
    std::optional<glm::vec3> center;
    /// Object space. nullopt: tight, round the whole mesh.
    std::optional<Bounds> box;

    friend bool operator==(const MapSpec&, const MapSpec&) = default;
};

/// Errors: kUsage (unknown or repeated key, value, or a key that does nothing for this format), kLimit (size
/// above kMapSizeMax). Messages quote `text` and say what would be right.
[[nodiscard]] Result<MapSpec> parseMapSpec(std::string_view text);

/// The canonical text, with every setting that has an effect: parseMapSpec(toString(s)) == s if s has a size.
[[nodiscard]] std::string toString(const MapSpec& spec);

/// Three orthogonal front-back maps and one cube: what `relief bake` makes when it is not told otherwise.
[[nodiscard]] std::vector<MapSpec> defaultMapSpecs();

/// Checks a number of texels along a side, of a --resolution or a size.
/// \param what  names the option in the message.
/// Errors: kUsage (too small), kLimit.
[[nodiscard]] Result<std::uint32_t> checkMapSize(std::uint64_t texels, MapFormat format,
                                                 const std::string& what);

}  // namespace relief
