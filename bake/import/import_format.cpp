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

using enum MeshReader;

// Formats that import assimp's test models correctly, or refuse them clearly.
constexpr MeshFormat kRows[] = {
    {.extension = "obj", .reader = kObj, .narrow = true},
    {.extension = "stl", .reader = kStl, .narrow = true, .whole = true},
    {.extension = "ply", .reader = kPly, .signatures = {"ply\n", "ply\r"}, .narrow = true, .whole = true},
    {.extension = "off", .reader = kOff, .narrow = true, .whole = true},
    {.extension = "gltf", .reader = kGltf, .narrow = true},
    {.extension = "glb", .reader = kGltf, .signatures = {"glTF\x02"}, .narrow = true},
    {.extension = "fbx", .frame = AssimpFrame::kFbx, .signatures = {"Kaydara FBX Binary", "; FBX "}},
    {.extension = "dae", .frame = AssimpFrame::kDae},
    {.extension = "3ds", .frame = AssimpFrame::k3ds},
    {.extension = "blend", .signatures = {"BLENDER_", "BLENDER-"}, .packed = "\x1f\x8b"},
    {.extension = "3mf", .reader = k3mf, .packed = "PK"},
    {.extension = "x", .frame = AssimpFrame::kMirrored, .signatures = {"xof 030"}},
    {.extension = "lwo", .frame = AssimpFrame::kMirrored},
    {.extension = "ac", .signatures = {"AC3Db\n", "AC3Db\r"}, .narrow = true},
    {.extension = "acc", .alias = "ac"},  // as racing simulators call it
    {.extension = "ase", .frame = AssimpFrame::kZUp, .signatures = {"*3DSMAX_ASCIIEXPORT"}, .narrow = true},
    {.extension = "b3d", .frame = AssimpFrame::kMirrored, .signatures = {"BB3D"}},
    {.extension = "dxf", .frame = AssimpFrame::kDxf, .narrow = true},
    {.extension = "lxo", .frame = AssimpFrame::kMirrored},
    {.extension = "ms3d", .signatures = {"MS3D000000"}},
    {.extension = "nff", .narrow = true, .own_words = true},
    {.extension = "raw", .reader = kRaw, .narrow = true, .own_words = true},
    {.extension = "smd", .narrow = true},
    {.extension = "amf", .reader = kAmf},
};

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

/// All lines but comments are statements of OBJ, some of them vertices.
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

/// By words among the first bytes of a text.
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

std::span<const MeshFormat> meshFormats() {
    return kRows;
}

const MeshFormat* meshFormat(std::string_view extension) {
    const std::string lower = lowerCase(extension);
    const auto found = std::find_if(std::begin(kRows), std::end(kRows),
                                    [&](const MeshFormat& row) { return row.extension == lower; });
    return found == std::end(kRows) ? nullptr : found;
}

std::optional<std::string> otherFormat(std::string_view extension, std::span<const std::byte> bytes) {
    const std::string_view text = textOf(bytes).substr(0, kLooked);
    std::string_view format = binaryFormat(bytes);
    if (extension == "stl" && format == "stl") {
        return std::nullopt;  // whatever its header holds
    }
    for (const MeshFormat& row : kRows) {
        for (const std::string_view begin : row.signatures) {
            const bool begins = !begin.empty() && text.starts_with(begin);
            format = format.empty() && begins ? row.extension : format;
        }
    }
    const MeshFormat* const named = meshFormat(extension);
    if (format.empty() && (named == nullptr || !named->own_words)) {
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
    const MeshFormat* const named = meshFormat(extension);
    const bool packed = named != nullptr && !named->packed.empty() && text.starts_with(named->packed);
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
    if (named != nullptr && named->narrow && isWideText(text)) {
        return "it is text in UTF-16 or UTF-32; save it in UTF-8";
    }
    return std::nullopt;
}

}  // namespace relief
