#include "bake/import/import_text.h"

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

std::optional<std::string> stlFault(std::span<const std::byte> bytes) {
    std::string_view text = textOf(bytes);
    std::string_view begin = text;
    if (isBinaryStl(bytes) || lowerCase(std::string(takeWord(begin))) != "solid") {
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

std::optional<std::string> otherFormat(std::string_view extension, std::span<const std::byte> bytes) {
    const std::string_view text = textOf(bytes);
    std::string_view format;
    if (text.starts_with("glTF") && text.size() > 4 && text[4] == 2) {  // and its version, binary
        format = "glb";
    } else if (text.starts_with("ply\n") || text.starts_with("ply\r")) {
        format = "ply";
    } else if (text.starts_with("Kaydara FBX Binary")) {
        format = "fbx";
    } else if (extension == "glb" && trimmed(text.substr(0, 64)).starts_with('{')) {
        format = "gltf";
    }
    return format.empty() || format == extension ? std::nullopt : std::optional(std::string(format));
}

std::optional<std::string> textFault(std::string_view extension, std::span<const std::byte> bytes) {
    if (textOf(bytes).starts_with("\x1f\x8b")) {
        return "it is packed by gzip; unpack it first (gunzip)";
    }
    if (extension == "stl") {
        return stlFault(bytes);
    }
    if (extension == "obj") {
        return objFault(bytes);
    }
    return std::nullopt;
}

}  // namespace relief
