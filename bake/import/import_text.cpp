#include "bake/import/import_text.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::size_t kStlHeader = 80;
constexpr std::size_t kStlTriangle = 50;  // bytes

std::string_view textOf(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// As long as the count of its triangles says.
bool isBinaryStl(std::span<const std::byte> bytes) {
    std::uint32_t triangles = 0;
    if (bytes.size() < kStlHeader + sizeof(triangles)) {
        return false;
    }
    std::memcpy(&triangles, bytes.data() + kStlHeader, sizeof(triangles));
    return bytes.size() >= kStlHeader + sizeof(triangles) + std::uint64_t{triangles} * kStlTriangle;
}

bool isAsciiStl(std::span<const std::byte> bytes) {
    std::string_view text = textOf(bytes);
    return !isBinaryStl(bytes) && lowerCase(takeWord(text)) == "solid";
}

std::optional<std::string> stlFault(std::span<const std::byte> bytes) {
    std::string_view text = textOf(bytes);
    if (!isAsciiStl(bytes)) {
        return std::nullopt;
    }
    // Some writers fill the last block with zeros.
    text = text.substr(0, text.find_last_not_of(std::string_view(" \t\r\n\0", 5)) + 1);
    std::string_view last = text.substr(text.find_last_of("\r\n") + 1);
    if (lowerCase(std::string(takeWord(last))) == "endsolid") {
        return std::nullopt;
    }
    return "it has no 'endsolid' at its end and was probably cut off; copy or export it again";
}

/// Follows the counts of an AC file.
class AcCounts {
  public:
    /// \return whether everything is there that is announced.
    bool hold(std::string_view text) {
        static_cast<void>(takeLine(text));  // its version
        while (!text.empty()) {
            std::string_view line = takeLine(text);
            const std::string_view word = takeWord(line);
            const std::uint64_t count = parseUnsigned(takeWord(line)).value_or(0);
            if (word == "OBJECT") {
                ++objects_;
                --kids_;
            } else if (word == "kids") {
                --objects_;  // each ends with them
                kids_ += static_cast<std::int64_t>(std::min(count, kCountMax));
            } else if (word == "data") {
                text.remove_prefix(std::min<std::uint64_t>(text.size(), count));
            } else if (word == "numsurf") {
                surfaces_ += static_cast<std::int64_t>(std::min(count, kCountMax));
            } else if (word == "SURF") {
                --surfaces_;
                ++open_surfaces_;
            } else if (word == "refs" || word == "numvert") {
                open_surfaces_ -= word == "refs" ? 1 : 0;
                if (!takeLines(text, count, word == "numvert" ? 3 : 1)) {
                    return false;
                }
            }
        }
        return objects_ == 0 && kids_ <= 0 && surfaces_ <= 0 && open_surfaces_ <= 0;
    }

  private:
    static constexpr std::uint64_t kCountMax = 1'000'000'000;

    static bool takeLines(std::string_view& text, std::uint64_t count, int words) {
        for (std::uint64_t i = 0; i < count; ++i) {
            std::string_view line = takeLine(text);
            for (int k = 0; k < words; ++k) {
                if (!parseDouble(takeWord(line))) {
                    return false;
                }
            }
        }
        return true;
    }

    std::int64_t objects_ = 0;  // without their kids
    std::int64_t kids_ = 1;     // announced; the world is one
    std::int64_t surfaces_ = 0;
    std::int64_t open_surfaces_ = 0;  // without their corners
};

std::optional<std::string> acFault(std::span<const std::byte> bytes) {
    // Text in UTF-16 is assimp's own business.
    const std::string_view text = textOf(bytes);
    if (!text.starts_with("AC3D") || AcCounts().hold(text)) {
        return std::nullopt;
    }
    return "it holds less than its counts say and was probably cut off; copy or export it again";
}

/// The next line of an OFF file that holds a word, without its comment; empty at the end.
std::string_view takeOffLine(std::string_view& text) {
    while (!text.empty()) {
        std::string_view line = takeLine(text);
        line = line.substr(0, line.find('#'));
        if (std::string_view rest = line; !takeWord(rest).empty()) {
            return line;
        }
    }
    return {};
}

std::uint64_t wordsOf(std::string_view line) {
    std::uint64_t words = 0;
    while (!takeWord(line).empty()) {
        ++words;
    }
    return words;
}

/// assimp takes 0 for each number that the line of a face lacks.
std::optional<std::string> offFault(std::span<const std::byte> bytes) {
    std::string_view text = textOf(bytes);
    std::string_view line = takeOffLine(text);
    if (std::string_view rest = line; lowerCase(takeWord(rest)).ends_with("off")) {
        line = wordsOf(rest) > 0 ? rest : takeOffLine(text);
    }
    const std::optional<std::uint64_t> vertices = parseUnsigned(takeWord(line));
    const std::optional<std::uint64_t> faces = parseUnsigned(takeWord(line));
    if (!vertices || !faces) {
        return std::nullopt;  // the reader's own business, as lines that are missing are
    }
    for (std::uint64_t i = 0; i < *vertices && !text.empty(); ++i) {
        takeOffLine(text);
    }
    for (std::uint64_t i = 0; i < *faces && !text.empty(); ++i) {
        line = takeOffLine(text);
        const std::optional<std::uint64_t> corners = parseUnsigned(takeWord(line));
        if (corners && wordsOf(line) < *corners) {
            return "face " + std::to_string(i) +
                   " has fewer vertices than it says, and the file was probably cut off; copy or export it "
                   "again";
        }
    }
    return std::nullopt;
}

/// assimp takes the 0 before the x. (Words as nan it judges by itself.)
bool isHexadecimal(std::string_view word) {
    if (word.starts_with('-') || word.starts_with('+')) {
        word.remove_prefix(1);
    }
    return word.starts_with("0x") || word.starts_with("0X");
}

std::optional<std::string> objFault(std::span<const std::byte> bytes) {
    std::string_view text = textOf(bytes);
    if (text.find("0x") == std::string_view::npos && text.find("0X") == std::string_view::npos) {
        return std::nullopt;  // as good as always: large files are not taken apart
    }
    for (std::size_t number = 1; !text.empty(); ++number) {
        std::string_view line = takeLine(text);
        if (takeWord(line) != "v") {
            continue;
        }
        for (std::string_view word = takeWord(line); !word.empty(); word = takeWord(line)) {
            if (isHexadecimal(word)) {
                return "line " + std::to_string(number) + ": '" + cleanUtf8(word, 40) +
                       "' is hexadecimal, which OBJ does not have; write it as a decimal number";
            }
        }
    }
    return std::nullopt;
}

}  // namespace

std::span<const std::byte> withoutByteOrderMark(std::span<const std::byte> bytes) {
    return textOf(bytes).starts_with("\xef\xbb\xbf") ? bytes.subspan(3) : bytes;
}

std::optional<std::vector<std::byte>> lowerCaseStl(std::string_view extension,
                                                   std::span<const std::byte> bytes) {
    std::string_view text = textOf(bytes);
    if (extension != "stl" || !isAsciiStl(bytes)) {
        return std::nullopt;
    }
    std::vector<std::byte> lower(bytes.begin(), bytes.end());
    bool changed = false;
    while (!text.empty()) {
        std::string_view line = takeLine(text);
        const auto begin = static_cast<std::size_t>(line.data() - textOf(bytes).data());
        std::string_view rest = line;
        const std::string word = lowerCase(takeWord(rest));
        // A name follows these two.
        const bool named = word == "solid" || word == "endsolid";
        for (std::size_t i = 0; i < line.size() - (named ? rest.size() : 0); ++i) {
            if (line[i] >= 'A' && line[i] <= 'Z') {
                lower[begin + i] = static_cast<std::byte>(line[i] - 'A' + 'a');
                changed = true;
            }
        }
    }
    return changed ? std::optional(std::move(lower)) : std::nullopt;
}

std::optional<std::string> textFault(std::string_view extension, std::span<const std::byte> bytes) {
    if (extension == "stl") {
        return stlFault(bytes);
    }
    if (extension == "obj") {
        return objFault(bytes);
    }
    if (extension == "ac") {
        return acFault(bytes);
    }
    if (extension == "off") {
        return offFault(bytes);
    }
    return std::nullopt;
}

}  // namespace relief
