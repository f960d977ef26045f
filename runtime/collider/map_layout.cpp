#include "runtime/collider/map_layout.h"

#include <string>

#include "formats/row_spans.h"

namespace relief {
namespace {

GLsizei stackedHeight(const DepthMap& map) {
    return static_cast<GLsizei>(map.height * map.faceCount());
}

/// A live map moves at its front and at its back, or on each face.
GLsizei motionHeight(const DepthMap& map) {
    return isFrontBack(map.format) ? 2 * stackedHeight(map) : stackedHeight(map);
}

std::size_t texelCount(const DepthMap& map) {
    return static_cast<std::size_t>(gpuBytes(map)) / texelSize(map.format);
}

Result<void> reserve(std::span<const PlacedMap> maps, GLint side_max,
                     std::array<TexelLayout, kTexelKinds>& textures) {
    for (const auto& [map, live] : maps) {
        TexelLayout& texture = textures[texelKindOf(map->format)];
        if (live) {
            const auto width = static_cast<GLsizei>(map->width);
            texture.addRectangle(width, stackedHeight(*map));
            textures[kFloatTexels].addRectangle(width, motionHeight(*map));
        } else {
            texture.addPacked(texelCount(*map));
        }
    }
    for (TexelLayout& texture : textures) {
        if (!texture.finish(side_max)) {
            return fail(ErrorCode::kLimit, "the collider's maps have " + std::to_string(texture.texels()) +
                                               " texels of one layout, this GL takes " +
                                               std::to_string(side_max) + "x" + std::to_string(side_max) +
                                               " in a texture; bake it with fewer bytes");
        }
    }
    return {};
}

}  // namespace

TexelKind texelKindOf(MapFormat format) {
    switch (format) {
        case MapFormat::kFloat32:
            return kFloatTexels;
        case MapFormat::kFrontBackHalf:
        case MapFormat::kFrontBackFixed:
            return kFrontBackTexels;
        case MapFormat::kFixed8:
        case MapFormat::kCube8:
            break;
    }
    return kFixedTexels;
}

Result<MapLayout> MapLayout::create(std::span<const PlacedMap> maps, GLint side_max) {
    MapLayout layout;
    auto& textures = layout.textures;
    RELIEF_TRY(reserve(maps, side_max, textures));
    // In the order in which they were added, packed texels as well as rectangles.
    std::array<std::size_t, kTexelKinds> packed{};
    std::array<std::size_t, kTexelKinds> rectangles{};
    for (const auto& [map, live] : maps) {
        MapPlace place;
        place.kind = texelKindOf(map->format);
        const TexelLayout& texture = textures[place.kind];
        if (live) {
            place.texels = texture.rectangle(rectangles[place.kind]++);
            place.motion = textures[kFloatTexels].rectangle(rectangles[kFloatTexels]++);
            place.first = texture.index(place.texels);
            place.pitch = texture.width();
            place.motion_first = textures[kFloatTexels].index(place.motion);
        } else {
            place.first = packed[place.kind];
            place.pitch = static_cast<GLint>(map->width);
            packed[place.kind] += texelCount(*map);
        }
        layout.places.push_back(place);
    }
    return layout;
}

}  // namespace relief
