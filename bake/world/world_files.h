// The files of a world in its folder: the one that names the others is written last, and then those go that only the one
// before named.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"
#include "formats/world/world.h"

namespace relief {

/// A name as a part of a file's: letters, digits and _ - . of ASCII.
[[nodiscard]] std::string fileStem(std::string_view name);

/// Writes kWorldFileName; its containers are there. Containers of the world from before that this one does not name are removed,
/// if they still are what that one named.
/// \param name  stands in front of what is wrong with the world.
/// \return the names of those that were removed.
/// Errors: those of parseWorld: no reader would take it; kIo.
[[nodiscard]] Result<std::vector<std::string>> replaceWorld(const std::filesystem::path& folder,
                                                            const World& world, const std::string& name);

}  // namespace relief
