// SPDX-License-Identifier: Apache-2.0
// The request to an importer, and the importer itself.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bake/import/import_units.h"
#include "bake/mesh/mesh.h"
#include "formats/base/field.h"
#include "formats/base/result.h"

namespace relief {

/// Geometry that the file has and does not show: hidden objects, and lower levels of detail.
enum class HiddenAs : std::uint8_t { kSkip, kKeep };
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<HiddenAs>{"skip", "keep"};

struct ImportOptions {
    /// The unit of the source's lengths, one of kLengthUnits; the mesh is then in metres. "": the file's unit; if it
    /// states none, lengths stay as they are and the mesh's unit is "".
    std::string unit;
    /// The source's axis that points upwards; the mesh is turned so that this becomes +Y. None: the file's axis; if it
    /// states none, axes stay as they are.
    std::optional<UpAxis> up;
    HiddenAs hidden = HiddenAs::kSkip;
    /// Names to mark triangles by (TriangleMesh::marks): of nodes, with everything below them, of meshes, of materials, of
    /// OBJ's groups and objects. Clean UTF-8 (cleanUtf8), at most kAskedNamesMax of at most kAskedNameBytesMax bytes; names
    /// of the file are cleaned and cut alike. A name that no triangle has is an error (kUsage) that lists existing ones.
    std::vector<std::string> names{};
    bool materials = true;  ///< in a level, meshes of the same shape and other materials are different ones
};

struct ImportLimits {
    std::uint64_t memory = 4'000'000'000;  ///< bytes for the importer beside its code and the file
    std::uint32_t seconds = 60;            ///< of processor time, and of wall time; at least 1
    /// Of the mesh, instances counted one by one: more is an error. 1 to kTriangleMax. A bake takes some 120 bytes for
    /// each.
    std::uint64_t triangles = 20'000'000;
};

/// The result of an import.
enum class ImportKind : std::uint8_t {
    kMesh,
    kLevel,     ///< each different mesh once, with its bodies (level.h)
    kAnimated,  ///< TriangleMesh::animation, of a glTF file
    kClips,     ///< the same, of nodes and clips alone
};
template <>
inline constexpr std::array<std::string_view, 4> kWordsOf<ImportKind>{"mesh", "level", "animated", "clips"};

/// The input of an importer.
struct ImportJob {
    std::string shown;      ///< the path for messages: quotedPath
    std::string file_name;  ///< of the mesh, in its folder
    std::string extension;  ///< lower case, without dot
    std::span<const std::byte> bytes;
    int folder = -1;  ///< descriptor; or -1
    ImportOptions options;
    std::uint64_t triangle_max = kTriangleMax;  ///< ImportLimits::triangles
    ImportKind kind = ImportKind::kMesh;
};

/// Reads the mesh, in the library bake_assimp. \return the input of ImportSource::finish. Errors: as importMesh.
[[nodiscard]] Result<TriangleMesh> importRaw(const ImportJob& job);

}  // namespace relief
