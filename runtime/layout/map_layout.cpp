// SPDX-License-Identifier: Apache-2.0
#include "runtime/layout/map_layout.h"

#include <algorithm>
#include <string>

namespace relief {
namespace {

std::size_t texelCount(const DepthMap& map) {
    return static_cast<std::size_t>(map.texelBytes()) / texelSize(map.format);
}

Result<void> reserve(std::span<const PlacedMap> maps, std::int32_t side_max, std::size_t room_texels,
                     std::array<TexelLayout, kTexelKinds>& textures) {
    for (const auto& [map, live] : maps) {
        TexelLayout& texture = textures[texelKindOf(map->format)];
        if (live) {
            const auto width = static_cast<std::int32_t>(map->width);
            const auto height = static_cast<std::int32_t>(map->height);
            texture.addRectangle(width, height);
            textures[kFloatTexels].addRectangle(width, 2 * height);  // motion of its front and its back
        } else {
            texture.addPacked(texelCount(*map));
        }
    }
    textures[kFrontBackTexels].addPacked(room_texels);
    for (TexelLayout& texture : textures) {
        if (!texture.finish(side_max)) {
            return fail(ErrorCode::kLimit, "the collider's maps have " + std::to_string(texture.texels()) +
                                               " texels of one size; this GL context supports " +
                                               std::to_string(side_max) + "x" + std::to_string(side_max) +
                                               " in a texture; bake it with a smaller budget");
        }
    }
    return {};
}

}  // namespace

std::vector<PlacedMap> placedMaps(const Collider& collider) {
    std::vector<PlacedMap> maps;
    for (const DepthMap& map : collider.maps) {
        maps.push_back({&map, false});
    }
    return maps;
}

std::size_t TexelLayout::texels() const {
    std::size_t sum = packed_;
    for (const TexelRectangle& r : rectangles_) {
        sum += static_cast<std::size_t>(r.width) * static_cast<std::size_t>(r.height);
    }
    return sum;
}

bool TexelLayout::finish(std::int32_t side_max) {
    for (log2_width_ = 0; width() <= side_max && log2_width_ < 30; ++log2_width_) {
        height_ = place(side_max);
        if (height_ <= width()) {
            return true;
        }
    }
    return false;
}

std::int32_t TexelLayout::place(std::int32_t side_max) {
    const std::int32_t full = side_max + 1;
    const auto row_texels = static_cast<std::size_t>(width());
    const std::size_t rows = (packed_ + row_texels - 1) >> log2_width_;
    if (rows > static_cast<std::size_t>(side_max)) {
        return full;
    }
    std::int32_t x = 0;
    auto shelf = static_cast<std::int32_t>(rows);
    std::int32_t top = shelf;
    for (TexelRectangle& r : rectangles_) {
        if (x + r.width > width()) {
            x = 0;
            shelf = top;
        }
        if (r.width > width() || r.height > side_max - shelf) {
            return full;
        }
        r.x = x;
        r.y = shelf;
        x += r.width;
        top = std::max(top, shelf + r.height);
    }
    return top;
}

TexelKind texelKindOf(MapFormat format) {
    const std::size_t size = texelSize(format);
    return size == 16 ? kFloatTexels : size == 4 ? kFixedTexels : kFrontBackTexels;
}

Result<MapLayout> MapLayout::create(std::span<const PlacedMap> maps, std::int32_t side_max,
                                    std::size_t room_texels) {
    if (maps.empty()) {
        return fail(ErrorCode::kUnsupported, "the collider has no maps, so nothing can collide with it");
    }
    MapLayout layout;
    auto& textures = layout.textures;
    RELIEF_TRY(reserve(maps, side_max, room_texels, textures));
    // Assign places in the order in which packed texels and rectangles were added.
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
            place.pitch = static_cast<std::int32_t>(map->width);
            packed[place.kind] += texelCount(*map);
        }
        layout.places.push_back(place);
    }
    layout.room = packed[kFrontBackTexels];
    return layout;
}

}  // namespace relief
