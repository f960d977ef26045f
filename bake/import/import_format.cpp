// SPDX-License-Identifier: Apache-2.0
#include "bake/import/import_format.h"

#include <algorithm>
#include <cstring>

#include "formats/base/text.h"

namespace relief {
namespace {

using enum MeshReader;

// Contains only formats of which assimp's test models are imported correctly, or rejected with a clear error.
constexpr MeshFormat kRows[] = {
    {.extension = "obj", .reader = kObj},
    {.extension = "stl", .reader = kStl, .whole = true},
    {.extension = "ply", .reader = kPly, .signatures = {"ply\n", "ply\r"}, .whole = true},
    {.extension = "off", .reader = kOff, .whole = true},
    {.extension = "gltf", .reader = kGltf},
    {.extension = "glb", .reader = kGltf, .signatures = {"glTF\x02"}},
    {.extension = "ac", .reader = kAc3d, .signatures = {"AC3D"}, .whole = true},
    {.extension = "acc", .reader = kAc3d, .signatures = {"AC3D"}, .whole = true},  // TORCS
    {.extension = "fbx", .frame = AssimpFrame::kFbx, .signatures = {"Kaydara FBX Binary", "; FBX "}},
    {.extension = "dae", .frame = AssimpFrame::kDae},
    {.extension = "3ds", .frame = AssimpFrame::k3ds},
    {.extension = "blend", .signatures = {"BLENDER_", "BLENDER-"}},
    {.extension = "x", .frame = AssimpFrame::kMirrored, .signatures = {"xof 030"}},
    {.extension = "lwo", .frame = AssimpFrame::kMirrored},
    {.extension = "b3d", .frame = AssimpFrame::kMirrored, .signatures = {"BB3D"}},
    {.extension = "lxo", .frame = AssimpFrame::kMirrored},
    {.extension = "ms3d", .signatures = {"MS3D000000"}},
    {.extension = "smd"},
};

/// Compares the length with the header's count; the rest of the header may have any contents.
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
    const MeshFormat* const found = std::ranges::find(kRows, lowerCase(extension), &MeshFormat::extension);
    return found == std::end(kRows) ? nullptr : found;
}

std::optional<std::string> otherFormat(std::string_view extension, std::span<const std::byte> bytes) {
    const auto begins = [bytes](const MeshFormat& row) {
        return std::ranges::any_of(row.signatures, [bytes](std::string_view begin) {
            return !begin.empty() && textOf(bytes).starts_with(begin);
        });
    };
    const MeshFormat* const own = meshFormat(extension);
    if ((own != nullptr && begins(*own)) || isBinaryStl(extension, bytes)) {
        return std::nullopt;
    }
    const MeshFormat* const found = std::ranges::find_if(kRows, begins);
    return found == std::end(kRows) ? std::nullopt : std::optional(std::string(found->extension));
}

}  // namespace relief
