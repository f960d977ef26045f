// SPDX-License-Identifier: Apache-2.0
#include "formats/base/text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <utility>

#include "formats/base/float_chars.h"

namespace relief {
namespace {

/// Returns the number of edits (insert, delete, change, swap neighbours) that turn one word into the other.
std::size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before_previous(b.size() + 1);
    std::vector<std::size_t> previous(b.size() + 1);
    std::vector<std::size_t> current(b.size() + 1);
    std::iota(previous.begin(), previous.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        current[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t change = previous[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            current[j] = std::min({previous[j] + 1, current[j - 1] + 1, change});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                current[j] = std::min(current[j], before_previous[j - 2] + 1);
            }
        }
        std::swap(before_previous, previous);
        std::swap(previous, current);
    }
    return previous[b.size()];
}

template <class T>
std::optional<T> parseNumber(std::string_view text) {
    if (text.starts_with('+') && text.size() > 1 && text[1] != '-') {
        text.remove_prefix(1);
    }
    T value{};
    const auto [end, error] = fromChars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size()) {
        return std::nullopt;
    }
    // std::from_chars reports underflow to 0 as the same error as overflow.
    if (error == std::errc::result_out_of_range &&
        std::abs(std::strtod(std::string(text).c_str(), nullptr)) < 1.0) {
        return text.starts_with('-') ? -T{} : T{};
    }
    return error == std::errc{} ? std::optional(value) : std::nullopt;
}

/// Returns the length of the well-formed UTF-8 sequence at the start of `bytes`, or 0.
std::size_t utf8Length(std::string_view bytes) {
    const auto at = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
    const unsigned first = at(0);
    const std::size_t length = first < 0x80                    ? 1
                               : first >= 0xc2 && first < 0xe0 ? 2
                               : first >= 0xe0 && first < 0xf0 ? 3
                               : first >= 0xf0 && first < 0xf5 ? 4
                                                               : 0;
    if (length == 0 || length > bytes.size()) {
        return 0;
    }
    for (std::size_t i = 1; i < length; ++i) {
        if ((at(i) & 0xc0U) != 0x80) {
            return 0;
        }
    }
    // Overlong forms, surrogates, and code points above U+10FFFF.
    if ((first == 0xe0 && at(1) < 0xa0) || (first == 0xed && at(1) >= 0xa0) ||
        (first == 0xf0 && at(1) < 0x90) || (first == 0xf4 && at(1) >= 0x90)) {
        return 0;
    }
    return length;
}

/// U+202A to U+202E and U+2066 to U+2069: embeddings, overrides and isolates.
bool changesOrder(std::string_view character) {
    return (character >= "\xe2\x80\xaa" && character <= "\xe2\x80\xae") ||
           (character >= "\xe2\x81\xa6" && character <= "\xe2\x81\xa9");
}

/// A UTF-8 character, or a byte of an invalid sequence.
struct Character {
    std::string_view bytes;
    bool clean = false;  ///< can be displayed unchanged
};

/// Removes the first character from `text`, which must not be empty.
Character takeCharacter(std::string_view& text, Bidi bidi) {
    const std::size_t length = utf8Length(text);
    const std::string_view bytes = text.substr(0, std::max(length, std::size_t{1}));
    const auto first = static_cast<unsigned char>(bytes[0]);
    const bool upper_control = length == 2 && first == 0xc2 && static_cast<unsigned char>(bytes[1]) < 0xa0;
    const bool bad = length == 0 || first < 0x20 || first == 0x7f || upper_control ||
                     (bidi == Bidi::kReplace && changesOrder(bytes));
    text.remove_prefix(bytes.size());
    return {bytes, !bad};
}

}  // namespace

void appendShortest(std::string& out, float value) {
    char text[32];
    const auto end = toChars(text, text + sizeof(text), value);
    out.append(text, end.ptr);
}

std::string shortest(float value) {
    std::string text;
    appendShortest(text, value);
    return text;
}

std::string shortest(const glm::vec3& value) {
    return shortest(value.x) + '/' + shortest(value.y) + '/' + shortest(value.z);
}

std::string formatted(const char* format, double value) {
    char text[64];
    std::snprintf(text, sizeof(text), format, value);
    return text;
}

std::optional<float> parseFloat(std::string_view text) {
    const std::optional<float> value = parseNumber<float>(text);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<double> parseDouble(std::string_view text) {
    return parseNumber<double>(text);
}

std::optional<std::uint64_t> parseUnsigned(std::string_view text) {
    if (text.empty() || !std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; })) {
        return std::nullopt;
    }
    std::uint64_t value = 0;
    if (std::from_chars(text.data(), text.data() + text.size(), value).ec != std::errc{}) {
        return std::numeric_limits<std::uint64_t>::max();
    }
    return value;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    while (true) {
        const std::size_t at = text.find(separator);
        parts.push_back(text.substr(0, at));
        if (at == std::string_view::npos) {
            return parts;
        }
        text.remove_prefix(at + 1);
    }
}

std::vector<std::string_view> listWords(std::string_view list) {
    return list.empty() ? std::vector<std::string_view>() : split(list, ' ');
}

bool listHas(std::string_view list, std::string_view word) {
    const std::vector<std::string_view> words = listWords(list);
    return std::find(words.begin(), words.end(), word) != words.end();
}

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) {
        return {};
    }
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string_view withoutByteOrderMark(std::string_view bytes) {
    return bytes.substr(bytes.substr(0, 3) == "\xef\xbb\xbf" ? 3 : 0);
}

std::string_view popLine(std::string_view& text) {
    const std::size_t end = text.find_first_of("\r\n");
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(line.size());
    const bool both = text.substr(0, 2) == "\r\n";
    text.remove_prefix(text.empty() ? 0 : both ? 2 : 1);
    return line;
}

std::string optionName(std::string_view field) {
    std::string name = "--" + std::string(field);
    std::replace(name.begin(), name.end(), '_', '-');
    return name;
}

std::string shellQuoted(const std::string& word) {
    constexpr std::string_view kPlain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._=+/:,%-";
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) {
        return word;
    }
    std::string text = "'";
    for (const char c : cleanUtf8(word)) {
        text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return text + "'";
}

std::string_view popWord(std::string_view& text) {
    const auto is_space = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
    const char* const begin = std::find_if_not(text.data(), text.data() + text.size(), is_space);
    const char* const end = std::find_if(begin, text.data() + text.size(), is_space);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return {begin, static_cast<std::size_t>(end - begin)};
}

std::string lowerCase(std::string_view text) {
    std::string lower(text);
    for (char& c : lower) {
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return lower;
}

std::string_view nearest(std::string_view word, std::span<const std::string_view> known) {
    std::string_view best;
    std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
    if (word.size() > 64) {
        return {};
    }
    for (const std::string_view candidate : known) {
        // A truncated word counts as near.
        const bool prefix = word.size() >= 2 && candidate.starts_with(word);
        const std::size_t distance = prefix ? 1 : editDistance(word, candidate);
        if (distance < best_distance) {
            best = candidate;
            best_distance = distance;
        }
    }
    return best;
}

std::string didYouMean(std::string_view word, std::span<const std::string_view> known) {
    const std::string_view best = nearest(word, known);
    return best.empty() ? std::string() : "; did you mean '" + std::string(best) + "'?";
}

std::string listed(std::span<const std::string_view> words) {
    std::string text;
    for (const std::string_view word : words) {
        text.append(text.empty() ? "" : ", ").append(word);
    }
    return text;
}

std::string cleanUtf8(std::string_view bytes, std::size_t size_max, Bidi bidi) {
    std::string text;
    while (!bytes.empty()) {
        const Character next = takeCharacter(bytes, bidi);
        const std::string_view character = next.clean ? next.bytes : std::string_view("\xef\xbf\xbd");
        if (text.size() + character.size() > size_max) {
            break;
        }
        text += character;
    }
    return text;
}

std::string escapedUtf8(std::string_view bytes) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text;
    while (!bytes.empty()) {
        const Character next = takeCharacter(bytes, Bidi::kReplace);
        if (next.clean) {
            text += next.bytes;
            continue;
        }
        for (const char c : next.bytes) {
            const auto byte = static_cast<unsigned char>(c);
            text.append("\\x").append({kDigits[byte / 16], kDigits[byte % 16]});
        }
    }
    return text;
}

std::string oneCleanLine(std::string_view text) {
    std::string line(trimmed(text));
    std::replace_if(
        line.begin(), line.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
    return cleanUtf8(trimmed(line));
}

std::optional<std::uint64_t> parseByteCount(std::string_view text) {
    constexpr std::array<std::pair<std::string_view, double>, 8> kUnits = {{{"", 1.0},
                                                                            {"b", 1.0},
                                                                            {"kb", 1e3},
                                                                            {"mb", 1e6},
                                                                            {"gb", 1e9},
                                                                            {"kib", 0x1p10},
                                                                            {"mib", 0x1p20},
                                                                            {"gib", 0x1p30}}};
    text = trimmed(text);
    double number = 0.0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = fromChars(text.data(), end, number, true);
    if (error != std::errc()) {
        return std::nullopt;
    }
    const std::string unit = lowerCase(trimmed({rest, static_cast<std::size_t>(end - rest)}));
    for (const auto& [name, factor] : kUnits) {
        if (unit == name) {
            const double bytes = number * factor;
            // This form also rejects NaN.
            return bytes >= 1.0 && bytes <= 0x1p53 ? std::optional(static_cast<std::uint64_t>(bytes))
                                                   : std::nullopt;
        }
    }
    return std::nullopt;
}

}  // namespace relief
