#include "bake/import/import_format.h"

#include <algorithm>
#include <cstring>

#include "formats/base/text.h"

namespace relief {
namespace {

using enum MeshReader;

// Formats that import assimp's test models correctly, or refuse them clearly.
constexpr MeshFormat kRows[] = {
    {.extension = "obj", .reader = kObj},
    {.extension = "stl", .reader = kStl, .whole = true},
    {.extension = "ply", .reader = kPly, .signatures = {"ply\n", "ply\r"}, .whole = true},
    {.extension = "off", .reader = kOff, .whole = true},
    {.extension = "gltf", .reader = kGltf},
    {.extension = "glb", .reader = kGltf, .signatures = {"glTF\x02"}},
    {.extension = "fbx", .frame = AssimpFrame::kFbx, .signatures = {"Kaydara FBX Binary", "; FBX "}},
    {.extension = "dae", .frame = AssimpFrame::kDae, .wide = true},
    {.extension = "3ds", .frame = AssimpFrame::k3ds},
    {.extension = "blend", .signatures = {"BLENDER_", "BLENDER-"}, .packed = "\x1f\x8b"},
    {.extension = "3mf", .reader = k3mf, .packed = "PK"},
    {.extension = "x", .frame = AssimpFrame::kMirrored, .signatures = {"xof 030"}},
    {.extension = "lwo", .frame = AssimpFrame::kMirrored},
    {.extension = "b3d", .frame = AssimpFrame::kMirrored, .signatures = {"BB3D"}},
    {.extension = "lxo", .frame = AssimpFrame::kMirrored},
    {.extension = "ms3d", .signatures = {"MS3D000000"}},
    {.extension = "smd"},
};

struct Stranger {
    std::string_view begin;
    std::string_view words;  // with a cure
};

constexpr std::string_view kWide = "it is text in UTF-16; save it in UTF-8";
constexpr Stranger kStrangers[] = {
    {"\x1f\x8b", "it is packed by gzip; unpack it first (gunzip)"},
    {"PK\x03\x04", "it is a ZIP archive; unpack it first (unzip)"},
    {"\xfd\x37zXZ", "it is packed by xz; unpack it first (unxz)"},
    {"\x28\xb5\x2f\xfd", "it is packed by zstd; unpack it first (unzstd)"},
    {"BZh", "it is packed by bzip2; unpack it first (bunzip2)"},
    {"7z\xbc\xaf", "it is a 7z archive; unpack it first"},
    {"Rar!", "it is a RAR archive; unpack it first"},
    {"\x89PNG", "it is a picture (PNG); name the mesh"},
    {"\xff\xd8\xff", "it is a picture (JPEG); name the mesh"},
    {"%PDF", "it is a PDF document; name the mesh"},
    {"\x7f\x45LF", "it is a program; name the mesh"},
    {"version https://git-lfs",
     "it is the placeholder of a file that Git LFS holds; fetch that (git lfs pull)"},
    {"\xff\xfe", kWide},
    {"\xfe\xff", kWide},
};

std::string_view textOf(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// By the count of its header and its length, as the header may hold anything.
bool isBinaryStl(std::string_view extension, std::span<const std::byte> bytes) {
    std::uint32_t count = 0;
    if (extension != "stl" || bytes.size() <= 84) {
        return false;
    }
    std::memcpy(&count, bytes.data() + 80, sizeof(count));
    return count > 0 && bytes.size() == 84 + 50 * std::uint64_t{count};
}

}  // namespace

const MeshFormat* meshFormat(std::string_view extension) {
    const std::string lower = lowerCase(extension);
    const auto found = std::find_if(std::begin(kRows), std::end(kRows),
                                    [&](const MeshFormat& row) { return row.extension == lower; });
    return found == std::end(kRows) ? nullptr : found;
}

std::optional<std::string> otherFormat(std::string_view extension, std::span<const std::byte> bytes) {
    for (const MeshFormat& row : kRows) {
        for (const std::string_view begin : row.signatures) {
            if (!begin.empty() && textOf(bytes).starts_with(begin)) {
                return row.extension == extension || isBinaryStl(extension, bytes)
                           ? std::nullopt
                           : std::optional(std::string(row.extension));
            }
        }
    }
    return std::nullopt;
}

std::optional<std::string> noMeshAtAll(std::string_view extension, std::span<const std::byte> bytes) {
    const std::string_view text = textOf(bytes);
    const MeshFormat* const named = meshFormat(extension);
    const bool packed = named != nullptr && !named->packed.empty() && text.starts_with(named->packed);
    if (packed || isBinaryStl(extension, bytes)) {
        return std::nullopt;
    }
    for (const auto& [begin, words] : kStrangers) {
        if (text.starts_with(begin) && !(words == kWide && named != nullptr && named->wide)) {
            return std::string(words);
        }
    }
    std::string_view rest = text.substr(0, 4096);
    const std::string first = lowerCase(takeWord(rest));
    const std::string second = lowerCase(takeWord(rest));
    if ((first == "<!doctype" && second.starts_with("html")) || first.starts_with("<html")) {
        return "it is a web page; download the mesh itself";
    }
    return std::nullopt;
}

}  // namespace relief
