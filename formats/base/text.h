// SPDX-License-Identifier: Apache-2.0
// Parses and formats the numbers and words of command lines and text files: strict, exact, and independent of the
// locale, except formatted().
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace relief {

/// Returns the shortest decimal that reads back as the same float: 0.1F -> "0.1"; "inf" for infinity, "nan" for NaN.
[[nodiscard]] std::string shortest(float value);
/// Appends shortest(value) to `out` without a temporary string.
void appendShortest(std::string& out, float value);
/// Joins the components with '/': "0.1/2/3".
[[nodiscard]] std::string shortest(const glm::vec3& value);

/// Formats a number like printf, with the decimal point of the locale; truncates to 63 characters.
/// \param format  with one conversion, of a double
[[nodiscard, gnu::format(printf, 1, 0)]] std::string formatted(const char* format, double value);

/// Parses the whole text as a finite float, otherwise returns nullopt. Accepts a leading '+'; values that are too small
/// become 0.
[[nodiscard]] std::optional<float> parseFloat(std::string_view text);
/// Parses a double in the same way, but also accepts infinity and NaN.
[[nodiscard]] std::optional<double> parseDouble(std::string_view text);
/// Parses the whole text as decimal digits. Values beyond 64 bits return the maximum.
[[nodiscard]] std::optional<std::uint64_t> parseUnsigned(std::string_view text);

/// Returns bytes as text. \param bytes  borrowed
[[nodiscard]] inline std::string_view textOf(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Splits text: "a,b,,c" by ',' -> a b "" c. Empty text has one empty part.
[[nodiscard]] std::vector<std::string_view> split(std::string_view text, char separator);
/// Splits a space-separated list, as in FieldRules; an empty list has no words.
[[nodiscard]] std::vector<std::string_view> listWords(std::string_view list);
[[nodiscard]] bool listHas(std::string_view list, std::string_view word);
/// Removes spaces, tabs and carriage returns at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);
/// Removes a leading UTF-8 byte order mark.
[[nodiscard]] std::string_view withoutByteOrderMark(std::string_view bytes);
/// Removes the first line from `text`. \return the line without its end ("\n", "\r\n" or "\r").
[[nodiscard]] std::string_view popLine(std::string_view& text);
/// Removes leading white space and the first word from `text`. \return the word; empty if there is none.
[[nodiscard]] std::string_view popWord(std::string_view& text);
/// "max_error" -> "--max-error"
[[nodiscard]] std::string optionName(std::string_view field);
/// Quotes a word for a POSIX shell; control characters are replaced (cleanUtf8).
[[nodiscard]] std::string shellQuoted(const std::string& word);
/// Converts A…Z to a…z; other bytes are unchanged.
[[nodiscard]] std::string lowerCase(std::string_view text);

/// Returns the entry of `known` nearest to `word` if it starts with `word`, or if one letter or at most a third of the
/// letters of `word` differ; else "".
[[nodiscard]] std::string_view nearest(std::string_view word, std::span<const std::string_view> known);
/// Returns "; did you mean 'size'?" for the nearest entry, or "".
[[nodiscard]] std::string didYouMean(std::string_view word, std::span<const std::string_view> known);
/// Joins words: "less, greater".
[[nodiscard]] std::string listed(std::span<const std::string_view> words);

/// Treatment of bidirectional control characters (UAX 9), which can disguise one name as another.
enum class Bidi : std::uint8_t { kReplace, kKeep };
/// Converts bytes to valid UTF-8: invalid sequences and control characters become U+FFFD.
/// \param size_max  bytes; truncates before the character that would exceed it.
[[nodiscard]] std::string cleanUtf8(std::string_view bytes, std::size_t size_max = std::string::npos,
                                    Bidi bidi = Bidi::kReplace);
/// Like cleanUtf8, but with hexadecimal escapes ("\x1b"), so that replaced bytes stay distinct.
[[nodiscard]] std::string escapedUtf8(std::string_view bytes);
/// Cleans another program's output for a one-line message: cleanUtf8, control characters as spaces, trimmed.
[[nodiscard]] std::string oneCleanLine(std::string_view text);

/// Parses a size such as "4MB", "0.25 MB", "512kB", "1MiB", "65536" or "64B". kB, MB and GB are powers of 1000; KiB,
/// MiB and GiB are powers of 1024. Ignores case and rounds down to whole bytes.
/// \return nullopt for other text, less than one byte, or more than 2^53.
[[nodiscard]] std::optional<std::uint64_t> parseByteCount(std::string_view text);

}  // namespace relief
