// Where a path leads in the end.
#pragma once

#include <filesystem>
#include <system_error>

namespace relief {

/// An absolute path without symbolic links, "." and ".."; parts that do not exist stay. Dangling links are followed too:
/// by the time that the path is opened their target may be there.
/// \param error  set where links lead in a circle, or a folder cannot be looked into.
[[nodiscard]] std::filesystem::path destination(const std::filesystem::path& path, std::error_code& error);

}  // namespace relief
