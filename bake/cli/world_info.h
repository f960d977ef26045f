// The report of relief info of a world.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/fields/field.h"
#include "formats/world/world.h"

namespace relief {

/// A collider of the world.
struct WorldColliderInfo {
    WorldCollider named;
    std::size_t bodies = 0;  ///< that place it
    std::size_t maps = 0;
    std::uint64_t bytes = 0;  ///< of its file
};

template <class Visitor, FieldsOf<WorldColliderInfo> C>
void fields(Visitor& visit, C& collider) {
    fields(visit, collider.named);
    visit("bodies", collider.bodies, {"Bodies that place it"});
    visit("maps", collider.maps, {"Its maps"});
    visit("bytes", collider.bytes, {"Size of its file", "bytes"});
}

/// `relief info world.json --json`
struct WorldInfo {
    std::string file{};
    std::string unit{};
    Bounds bounds{glm::vec3(0.0F), glm::vec3(0.0F)};
    std::size_t bodies = 0;
    std::uint64_t bytes = 0;
    std::uint64_t gpu_bytes = 0;
    std::vector<WorldColliderInfo> colliders{};
};

template <class Visitor, FieldsOf<WorldInfo> I>
void fields(Visitor& visit, I& info) {
    visit("file", info.file, {"File of the world"});
    visit("unit", info.unit, {"Unit of lengths: m, or empty"});
    visit("min", info.bounds.min, {"Lower corner of the box that holds all bodies", "world units"});
    visit("max", info.bounds.max, {"Upper corner of the box that holds all bodies", "world units"});
    visit("bodies", info.bodies, {"Bodies"});
    visit("bytes", info.bytes, {"Size of the colliders' files together", "bytes"});
    visit("gpu_bytes", info.gpu_bytes, {"Bytes that the colliders take on the GPU", "bytes"});
    visit("colliders", info.colliders, {"Each different shape once"});
}

/// Reads the world and all its colliders. Errors: those of loadWorld.
[[nodiscard]] Result<WorldInfo> readWorldInfo(const std::string& file, const ContainerLimits& limits);

/// A line for all, their box, and a table of the colliders.
[[nodiscard]] std::string worldInfoText(const WorldInfo& info);

}  // namespace relief
