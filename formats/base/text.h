// SPDX-License-Identifier: Apache-2.0
// Numbers and words of the command line and of text files: strict, exact, and the same in every locale.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace relief {

/// The shortest decimal that reads back as the same float: 0.1F -> "0.1". Infinity is "inf", NaN "nan".
[[nodiscard]] std::string shortest(float value);
/// Appends shortest(value) to `out` without a temporary string.
void appendShortest(std::string& out, float value);
/// "a/b/c"
[[nodiscard]] std::string shortest(const glm::vec3& value);

/// The whole of `text` as a finite float; a leading '+' is allowed, and what is too small becomes 0. nullopt otherwise.
[[nodiscard]] std::optional<float> parseFloat(std::string_view text);
/// The same as a double, which may also be infinite or NaN.
[[nodiscard]] std::optional<double> parseDouble(std::string_view text);
/// The whole of `text` as decimal digits. Numbers too large for 64 bits come back as the largest one.
[[nodiscard]] std::optional<std::uint64_t> parseUnsigned(std::string_view text);

/// "a,b,,c" by ',' -> a b "" c. An empty text has one empty part.
[[nodiscard]] std::vector<std::string_view> split(std::string_view text, char separator);
/// The words of a list with a space between two, as FieldRules has them; an empty list has none.
[[nodiscard]] std::vector<std::string_view> listWords(std::string_view list);
[[nodiscard]] bool listHas(std::string_view list, std::string_view word);
/// Without spaces, tabs and a carriage return at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);
/// `bytes` without a byte order mark of UTF-8 in front.
[[nodiscard]] std::string_view withoutByteOrderMark(std::string_view bytes);
/// Cuts the first line off `text`. \return it, without its end: "\n", "\r\n" or "\r".
[[nodiscard]] std::string_view takeLine(std::string_view& text);
/// Cuts the first word, and the white space before it, off `text`. \return it; empty if there is none.
[[nodiscard]] std::string_view takeWord(std::string_view& text);
/// "max_error" -> "--max-error"
[[nodiscard]] std::string optionName(std::string_view field);
/// A word as a POSIX shell reads it back; control characters are replaced (cleanUtf8).
[[nodiscard]] std::string shellQuoted(const std::string& word);
/// With a…z for A…Z; all other bytes stay.
[[nodiscard]] std::string lowerCase(std::string_view text);

/// The one of `known` that is nearest to `word`, if at most a third of its letters are changed; else "".
[[nodiscard]] std::string_view nearest(std::string_view word, std::span<const std::string_view> known);
/// "; did you mean 'size'?" for the nearest one, or "".
[[nodiscard]] std::string didYouMean(std::string_view word, std::span<const std::string_view> known);
/// "less, greater"
[[nodiscard]] std::string listed(std::span<const std::string_view> words);

/// Characters that change the order of those round them (UAX 9), with which a name can pretend to be another one.
enum class Bidi : std::uint8_t { kReplace, kKeep };
/// Any bytes as valid UTF-8: what is none becomes U+FFFD, control characters included.
/// \param size_max  bytes: the text ends before the character that would exceed it.
[[nodiscard]] std::string cleanUtf8(std::string_view bytes, std::size_t size_max = std::string::npos,
                                    Bidi bidi = Bidi::kReplace);
/// As cleanUtf8, but with the bytes as hexadecimal escapes, "\x1b", so that different names stay different.
[[nodiscard]] std::string escapedUtf8(std::string_view bytes);
/// Words of another program for a message: cleanUtf8, with spaces for control characters, and none at both ends.
[[nodiscard]] std::string oneCleanLine(std::string_view text);

/// "4MB", "0.25 MB", "512kB", "1MiB", "65536", "64B": kB, MB and GB are powers of 1000, KiB, MiB and GiB of
/// 1024; the case of letters does not matter. Rounded down to whole bytes.
/// \return nullopt for anything else, for less than one byte, and beyond 2^53.
[[nodiscard]] std::optional<std::uint64_t> parseByteCount(std::string_view text);

}  // namespace relief
