// SPDX-License-Identifier: Apache-2.0
#include "bake/images/map_image.h"

#include <glm/geometric.hpp>
#include <limits>

#include "bake/images/axis_grid.h"
#include "bake/mesh/cube_faces.h"

namespace relief {
namespace {

/// Near plane of the perspective of a cube's face, in units of the volume.
constexpr double kNearPlane = 1.0 / 1024.0;

glm::dvec4 row(const Affine& affine, int i) {
    return affine.row[i];
}

glm::dmat4 fromRows(const glm::dvec4& x, const glm::dvec4& y, const glm::dvec4& z, const glm::dvec4& w) {
    return glm::transpose(glm::dmat4(x, y, z, w));
}

/// Sets the camera of a face; its rows are axes in map coordinates.
void setFaceCamera(const DepthMap& map, std::uint32_t face, ExrImage& image) {
    const auto in_map = [&](const CubeFaceAxes::Axis& axis) {
        return axis.sign * row(map.object_to_map, axis.component);
    };
    const auto in_object = [&](const CubeFaceAxes::Axis& axis) {
        return static_cast<double>(map.object_per_map[axis.component]) * in_map(axis);
    };
    const CubeFaceAxes& axes = kCubeFaces[face];
    const glm::dvec4 one(0.0, 0.0, 0.0, 1.0);
    const glm::dvec4 depth = in_map(axes.major);
    image.world_to_camera = fromRows(in_object(axes.s), -in_object(axes.t), in_object(axes.major), one);
    image.world_to_ndc = fromRows(0.5 * (in_map(axes.s) + depth), 0.5 * (in_map(axes.t) + depth),
                                  depth - kNearPlane * one, depth);
}

/// Object units per unit of depth along the ray of a texel.
float objectPerDepth(const DepthMap& map, std::uint32_t face, std::uint32_t x, std::uint32_t y) {
    if (map.projection() == Projection::kOrthographic) {
        return map.object_per_map.z;
    }
    const auto size = static_cast<float>(map.width);
    const glm::vec3 direction = glm::normalize(
        cubeDirection({face, (static_cast<float>(x) + 0.5F) / size, (static_cast<float>(y) + 0.5F) / size}));
    return glm::length(map.object_per_map * direction);
}

}  // namespace

std::string mapImageName(const DepthMap& map, std::size_t index, std::uint32_t face) {
    const std::string base = "map" + std::to_string(index) + "_" + mapFormatName(map.format);
    return map.faceCount() == 1 ? base + ".exr" : base + "_" + kDirectionNames[face] + ".exr";
}

ExrImage mapImage(const DepthMap& map, std::uint32_t face, const std::string& unit) {
    const bool cube = map.projection() == Projection::kCube;
    const bool two_sided = map.compare == Compare::kBoth;
    ExrImage image;
    image.width = map.width;
    image.height = map.height;
    const std::size_t pixels = std::size_t{map.width} * map.height;
    for (const char* name : {"Z", "N.X", "N.Y", "N.Z", "ZBack", "NBack.X", "NBack.Y", "NBack.Z"}) {
        if (image.channels.size() < 4 || two_sided) {
            image.channels.push_back({name, std::vector<float>(pixels)});
        }
    }
    for (std::uint32_t y = 0; y < map.height; ++y) {
        const std::uint32_t image_row = cube ? y : map.height - 1 - y;
        for (std::uint32_t x = 0; x < map.width; ++x) {
            const Texel texel = decodeTexel(map.format, map.texelAt(face, x, y));
            const std::size_t pixel = std::size_t{image_row} * map.width + x;
            const auto put = [&](std::size_t first, const std::optional<Surface>& surface) {
                image.channels[first].values[pixel] = surface
                                                          ? surface->depth * objectPerDepth(map, face, x, y)
                                                          : std::numeric_limits<float>::infinity();
                for (std::size_t i = 0; i < 3; ++i) {
                    image.channels[first + 1 + i].values[pixel] =
                        surface ? surface->normal[static_cast<int>(i)] : 0.0F;
                }
            };
            put(0, texel.front);
            if (two_sided) {
                put(4, texel.back);
            }
        }
    }
    if (cube) {
        setFaceCamera(map, face, image);
    } else {
        image.setOrthographicCamera(row(map.object_to_map, 0), row(map.object_to_map, 1),
                                    row(map.object_to_map, 2), map.object_per_map);
    }
    image.attributes = {
        {"relief.format", mapFormatName(map.format)},
        {"relief.projection", projectionName(map.projection())},
        {"relief.compare", compareName(map.compare)},
        {"relief.unit", unit},
        {"relief.Z", cube ? "object units along the ray from the centre of the cube; +inf: no surface"
                          : "object units along the view from the near plane; +inf: no surface"},
        {"relief.N", "unit normal in object space, outwards; zero: no surface"},
        {"relief.rows", cube ? "top row: t = 0 of the OpenGL cube face" : "top row: highest y of the map"},
    };
    if (cube) {
        image.attributes.emplace_back("relief.face", kDirectionNames[face]);
    }
    return image;
}

}  // namespace relief
