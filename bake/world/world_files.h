// SPDX-License-Identifier: Apache-2.0
// The files of a world in its folder: the one that names the others is written last, and then those go that only the one
// before named.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"
#include "formats/world/world.h"

namespace relief {

/// A name as a part of a file's: letters, digits and _ - . of ASCII.
[[nodiscard]] std::string fileStem(std::string_view name);

struct ReplacedWorld {
    std::vector<std::string> removed;   ///< containers
    std::vector<std::string> warnings;  ///< of what was written by hand and is left out; one line each
};

/// Writes kWorldFileName; its containers are there. Containers of the world from before that this one does not name are removed,
/// if they still are what that one named. What people write into that file stays: responses by the names of materials,
/// restitution and friction of bodies by name, box and place of their nodes, or by less if that means one node only.
/// \param materials  names of those of all its colliders.
/// \param name       stands in front of what is wrong with the world.
/// Errors: those of parseWorld: no reader would take it; kIo.
[[nodiscard]] Result<ReplacedWorld> replaceWorld(const std::filesystem::path& folder, World& world,
                                                 const std::set<std::string>& materials,
                                                 const std::string& name);

}  // namespace relief
