// What assimp's readers of text stumble over, or pass over without a word: byte order marks, capitals, ends that are
// missing, numbers that are none.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace relief {

/// The bytes behind a UTF-8 byte order mark, which assimp takes for a part of the first word.
[[nodiscard]] std::span<const std::byte> withoutByteOrderMark(std::span<const std::byte> bytes);

/// An STL in ASCII with its words in lower case, as assimp wants them, names aside. nullopt: they are, or it is no STL in
/// ASCII.
/// \param extension  lower case, without its dot.
[[nodiscard]] std::optional<std::vector<std::byte>> lowerCaseStl(std::string_view extension,
                                                                 std::span<const std::byte> bytes);

/// What is wrong with a file, and its cure; nullopt: nothing that is looked for here. Of an OBJ: a coordinate that is no
/// decimal number. Of an STL in ASCII: that it has no end. Of an AC: that it holds less than its counts say. Of an OFF: a
/// face of too few vertices.
/// \param extension  lower case, without its dot.
[[nodiscard]] std::optional<std::string> textFault(std::string_view extension,
                                                   std::span<const std::byte> bytes);

}  // namespace relief
