// What the first bytes of a file tell, and what assimp's readers of text pass over without a word: ends that are missing,
// numbers that are none.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace relief {

/// The bytes behind a UTF-8 byte order mark, which assimp takes for a part of the first word.
[[nodiscard]] std::span<const std::byte> withoutByteOrderMark(std::span<const std::byte> bytes);

/// The extension of the format that the first bytes of a file name beyond doubt: "glb", "ply", "fbx"; "gltf" for JSON under
/// the name of a GLB. nullopt: they name none, or the one that `extension` says.
[[nodiscard]] std::optional<std::string> otherFormat(std::string_view extension,
                                                     std::span<const std::byte> bytes);

/// What is wrong with a file, and its cure; nullopt: nothing that is looked for here. Of any extension: that it is packed by
/// gzip. Of an OBJ: a coordinate that is no decimal number. Of an STL in ASCII: that it has no end.
/// \param extension  lower case, without its dot.
[[nodiscard]] std::optional<std::string> textFault(std::string_view extension,
                                                   std::span<const std::byte> bytes);

}  // namespace relief
