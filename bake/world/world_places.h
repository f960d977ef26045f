// SPDX-License-Identifier: Apache-2.0
// A typical misclassified point of a body: the cause of the error, and a slice through all bodies at the point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "bake/images/slice.h"
#include "bake/world/placed_mesh.h"
#include "formats/fields/field.h"
#include "formats/world/world_field.h"

namespace relief {

enum class WorldCause : std::uint8_t {
    kMoved,      ///< the node's pose in the world differs from its pose in the level
    kPrecision,  ///< floatsLimit(): the mesh is too far from its origin
    kTexel,      ///< the point is at most kTexelsOff texels from the surface
    kMesh,       ///< the point is farther away: intersecting faces, open edges, or a lost part
};
template <>
inline constexpr std::array<std::string_view, 4> kWordsOf<WorldCause>{"moved", "precision", "texel", "mesh"};

inline constexpr double kTexelsOff = 1.5;

struct WorldPlace {
    glm::vec3 normal{0.0F};  ///< of the nearest surface of the body's mesh, world space
    double distance = 0.0;   ///< from that surface, world units
    double texel = 0.0;      ///< side of the deciding body's texels there, world units; 0: no body decides
    WorldCause cause = WorldCause::kMesh;
    std::optional<VerdictSlice> slice;
};

struct WorldPlaceQuery {
    const std::vector<PlacedMesh>& level;
    const WorldField& field;
    std::size_t body = 0;  ///< index in the level
    glm::vec3 place{0.0F};
    bool moved = false;
    double wrong = 0.0;  ///< percent of the points of the body
};

[[nodiscard]] WorldPlace worldPlace(const WorldPlaceQuery& query, bool picture);

}  // namespace relief
