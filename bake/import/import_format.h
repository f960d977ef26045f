// What the first bytes of a file tell of its format, whatever its name says.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace relief {

/// The extension of the format that the contents name beyond doubt, such as "glb", "stl" or "dae". nullopt: they name none,
/// or the one that `extension` says.
/// \param extension  lower case, without its dot.
[[nodiscard]] std::optional<std::string> otherFormat(std::string_view extension,
                                                     std::span<const std::byte> bytes);

/// What the file is instead of a mesh, and the cure: packed, text in UTF-16, a picture, a web page, a placeholder of Git.
/// nullopt: nothing of that kind.
/// \param extension  lower case, without its dot.
[[nodiscard]] std::optional<std::string> noMeshAtAll(std::string_view extension,
                                                     std::span<const std::byte> bytes);

}  // namespace relief
