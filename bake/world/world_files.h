// SPDX-License-Identifier: Apache-2.0
// Writes the file of a world after its containers exist, and removes the containers that only the previous world
// references.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"
#include "formats/world/world.h"

namespace relief {

/// Converts a name to a part of a file name: ASCII letters, digits, '_', '-' and '.'.
[[nodiscard]] std::string fileStem(std::string_view name);

struct ReplacedWorld {
    std::vector<std::string> removed;   ///< removed containers
    std::vector<std::string> warnings;  ///< about dropped settings that were written by hand; one line each
};

/// Writes kWorldFileName; its containers must exist. Removes containers that only the previous world references, if
/// their contents have not changed. Preserves settings written by hand: responses by material name, and the restitution
/// and friction of bodies. Bodies are matched by the name, box and pose of their node, or by fewer of these if the match
/// is unique.
/// \param materials  names of the materials of all colliders.
/// \param name       prefix for errors about the world.
/// Errors: those of parseWorld (no reader would accept the world), kIo.
[[nodiscard]] Result<ReplacedWorld> replaceWorld(const std::filesystem::path& folder, World& world,
                                                 const std::set<std::string>& materials,
                                                 const std::string& name);

}  // namespace relief
