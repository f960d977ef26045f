#include "bake/import/import_format.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "formats/base/text.h"
#include "formats/base/text_scanner.h"

namespace relief {
namespace {

/// As much as a header takes.
constexpr std::size_t kLooked = 4096;
constexpr std::size_t kObjLines = 40;

std::string_view textOf(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

struct Signature {
    std::string_view begin;
    std::string_view format;
};

/// Bytes that no other format begins with.
constexpr std::array<Signature, 13> kSignatures = {{{"ply\n", "ply"},
                                                    {"ply\r", "ply"},
                                                    {"Kaydara FBX Binary", "fbx"},
                                                    {"; FBX ", "fbx"},
                                                    {"BLENDER_", "blend"},
                                                    {"BLENDER-", "blend"},
                                                    {"BB3D", "b3d"},
                                                    {"MS3D000000", "ms3d"},
                                                    {"AC3Db\n", "ac"},
                                                    {"AC3Db\r", "ac"},
                                                    {"*3DSMAX_ASCIIEXPORT", "ase"},
                                                    {"xof 030", "x"},
                                                    {"glTF\x02", "glb"}}};

struct Stranger {
    std::string_view begin;
    std::string_view words;  // with a cure
};

constexpr std::array<Stranger, 13> kStrangers = {{
    {"\x1f\x8b", "it is packed by gzip; unpack it first (gunzip)"},
    {"PK\x03\x04", "it is a ZIP archive; unpack it first (unzip)"},
    {"\xfd"
     "7zXZ",
     "it is packed by xz; unpack it first (unxz)"},
    {"\x28\xb5\x2f\xfd", "it is packed by zstd; unpack it first (unzstd)"},
    {"BZh", "it is packed by bzip2; unpack it first (bunzip2)"},
    {"7z\xbc\xaf", "it is a 7z archive; unpack it first"},
    {"Rar!", "it is a RAR archive; unpack it first"},
    {"\x89PNG", "it is a picture (PNG); name the mesh"},
    {"\xff\xd8\xff", "it is a picture (JPEG); name the mesh"},
    {"%PDF", "it is a PDF document; name the mesh"},
    {"\x7f"
     "ELF",
     "it is a program; name the mesh"},
    {"version https://git-lfs",
     "it is the placeholder of a file that Git LFS holds; fetch that (git lfs pull)"},
    {"SQLite format 3", "it is a database; name the mesh"},
}};

/// Text of a byte order of 16 or 32 bits, by its mark or by the zeros between its letters.
bool isWideText(std::string_view text) {
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
        return true;
    }
    const std::string_view begin = text.substr(0, 64);
    if (begin.size() < 8) {
        return false;
    }
    for (const std::size_t zero : {0, 1}) {
        bool all = true;
        for (std::size_t i = 0; i < begin.size(); ++i) {
            const auto c = static_cast<unsigned char>(begin[i]);
            const bool letter = (c >= ' ' && c < 0x7F) || c == '\t' || c == '\r' || c == '\n';
            all = all && (i % 2 == zero ? c == 0 : letter);
        }
        if (all) {
            return true;
        }
    }
    return false;
}

/// Whether lines that are no comments are all statements of OBJ, some of them vertices.
bool isObj(std::string_view text) {
    constexpr std::array<std::string_view, 11> kStatements = {"v", "vt", "vn",     "vp",     "f", "g",
                                                              "o", "s",  "mtllib", "usemtl", "l"};
    std::size_t vertices = 0;
    TextScanner scanner(text, {'#', true});
    for (std::size_t lines = 0; lines < kObjLines;) {
        if (const std::string_view word = scanner.word(); !word.empty()) {
            if (std::find(kStatements.begin(), kStatements.end(), word) == kStatements.end()) {
                // The last may be cut by what is looked at.
                return !scanner.nextLine() && lines > 0 && vertices > 0;
            }
            vertices += word == "v" && parseDouble(scanner.word()).has_value() ? 1 : 0;
            ++lines;
        }
        if (!scanner.nextLine()) {
            break;
        }
    }
    return vertices > 0;
}

/// Of which one comes first in the JSON, or close behind that.
constexpr std::array<std::string_view, 7> kGltfKeys = {"\"asset\"",         "\"accessors\"", "\"buffers\"",
                                                       "\"scenes\"",        "\"meshes\"",    "\"nodes\"",
                                                       "\"extensionsUsed\""};

/// By what a text says within its first bytes.
std::string_view textFormat(std::string_view text) {
    std::string_view rest = text;
    const std::string word = lowerCase(takeWord(rest));
    if (word == "solid" && lowerCase(text).find("facet") != std::string::npos) {
        return "stl";
    }
    if (word == "off" || word == "coff" || word == "noff") {
        return "off";
    }
    if (text.find("<COLLADA") != std::string_view::npos) {
        return "dae";
    }
    if (word.starts_with('{') &&
        std::any_of(kGltfKeys.begin(), kGltfKeys.end(),
                    [text](std::string_view key) { return text.find(key) != std::string_view::npos; })) {
        return "gltf";
    }
    return isObj(text) ? "obj" : "";
}

/// By a header of binary numbers that fits the file's length.
std::string_view binaryFormat(std::span<const std::byte> bytes) {
    const auto word = [bytes](std::size_t at) {
        std::uint32_t value = 0;
        std::memcpy(&value, bytes.data() + at, sizeof(value));
        return std::uint64_t{value};
    };
    if (bytes.size() > 16 && textOf(bytes).starts_with("MM") && word(2) == bytes.size()) {
        return "3ds";
    }
    if (bytes.size() > 84 && word(80) > 0 && bytes.size() == 84 + 50 * word(80)) {
        return "stl";
    }
    const std::string_view form = bytes.size() > 12 ? textOf(bytes).substr(8, 4) : "";
    if (textOf(bytes).starts_with("FORM")) {
        return form == "LWO2" || form == "LWOB" ? "lwo" : form == "LXOB" ? "lxo" : "";
    }
    return "";
}

}  // namespace

std::optional<std::string> otherFormat(std::string_view extension, std::span<const std::byte> bytes) {
    const std::string_view text = textOf(bytes).substr(0, kLooked);
    std::string_view format = binaryFormat(bytes);
    if (extension == "stl" && format == "stl") {
        return std::nullopt;  // whatever its header says
    }
    for (const Signature& signature : kSignatures) {
        format = format.empty() && text.starts_with(signature.begin) ? signature.format : format;
    }
    // These two have words of their own that look like those of others.
    if (format.empty() && extension != "raw" && extension != "nff") {
        format = textFormat(text);
    }
    // A .gltf may be long before it names its asset.
    std::string_view rest = text;
    if (format.empty() && extension == "glb" && takeWord(rest).starts_with('{')) {
        format = "gltf";
    }
    return format.empty() || format == extension ? std::nullopt : std::optional(std::string(format));
}

std::optional<std::string> noMeshAtAll(std::string_view extension, std::span<const std::byte> bytes) {
    const std::string_view text = textOf(bytes).substr(0, kLooked);
    const bool packed = (extension == "3mf" && text.starts_with("PK")) ||
                        (extension == "blend" && text.starts_with("\x1f\x8b"));
    if (packed || (extension == "stl" && binaryFormat(bytes) == "stl")) {
        return std::nullopt;  // as these are
    }
    for (const Stranger& stranger : kStrangers) {
        if (text.starts_with(stranger.begin)) {
            return std::string(stranger.words);
        }
    }
    std::string_view words = text;
    const std::string first = lowerCase(takeWord(words));
    const std::string second = lowerCase(takeWord(words));
    if ((first == "<!doctype" && second.starts_with("html")) || first.starts_with("<html")) {
        return "it is a web page; download the mesh itself";
    }
    // XML says its own encoding.
    constexpr std::array<std::string_view, 12> kNarrow = {"obj", "stl", "ply", "off", "gltf", "glb",
                                                          "ac",  "ase", "dxf", "nff", "raw",  "smd"};
    if (std::find(kNarrow.begin(), kNarrow.end(), extension) != kNarrow.end() && isWideText(text)) {
        return "it is text in UTF-16 or UTF-32; save it in UTF-8";
    }
    return std::nullopt;
}

}  // namespace relief
