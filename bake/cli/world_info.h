// SPDX-License-Identifier: Apache-2.0
// The report of `relief info` on a world.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/fields/field.h"
#include "formats/world/world.h"

namespace relief {

struct WorldColliderInfo {
    WorldCollider named;
    std::size_t bodies = 0;  ///< number of its bodies
    std::size_t maps = 0;
    std::uint64_t bytes = 0;  ///< size of its file
    Provenance provenance{};
};

void fields(FieldVisitor& visit, const WorldColliderInfo& collider);

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

void fields(FieldVisitor& visit, const WorldInfo& info);

/// Reads the world and all its colliders. Errors: those of loadWorld.
[[nodiscard]] Result<WorldInfo> readWorldInfo(const std::string& file, const ContainerLimits& limits);

/// A summary, the bounds, the common provenance, and a table of the colliders.
[[nodiscard]] std::string worldInfoText(const WorldInfo& info);

}  // namespace relief
