// SPDX-License-Identifier: Apache-2.0
// Defines an import request, and declares the importer's entry point.
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

/// Treatment of geometry that the file hides: hidden objects and lower levels of detail.
enum class HiddenAs : std::uint8_t { kSkip, kKeep };
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<HiddenAs>{"skip", "keep"};

struct ImportOptions {
    /// Length unit of the source, one of kLengthUnits; the mesh is converted to metres. "": the file's unit. If the
    /// file has none, lengths are unchanged and the mesh's unit is "".
    std::string unit;
    /// Up axis of the source; the mesh is rotated so that it becomes +Y. nullopt: the file's axis. If the file has
    /// none, axes are unchanged.
    std::optional<UpAxis> up;
    HiddenAs hidden = HiddenAs::kSkip;
    /// Names that mark triangles (TriangleMesh::marks): of nodes, including their descendants, of meshes, of materials,
    /// and of OBJ groups and objects. Clean UTF-8 (cleanUtf8); at most kAskedNamesMax names of at most
    /// kAskedNameBytesMax bytes. Names in the file are cleaned and truncated in the same way. If a name matches no
    /// triangle, the import fails (kUsage) and lists the existing names.
    std::vector<std::string> names{};
    bool materials = true;  ///< in a level, meshes that differ only in materials stay separate
};

struct ImportLimits {
    std::uint64_t memory = 4'000'000'000;  ///< bytes for the importer, in addition to its code and the file
    std::uint32_t seconds = 60;            ///< limit on processor time and on wall time; at least 1
    /// Maximum number of triangles, counting each instance; 1 to kTriangleMax. A bake takes about 160 bytes for each.
    std::uint64_t triangles = 20'000'000;
};

/// The kind of result.
enum class ImportKind : std::uint8_t {
    kMesh,
    kLevel,     ///< each distinct mesh once, with its bodies (level.h)
    kAnimated,  ///< TriangleMesh::animation, from a glTF file
    kClips,     ///< the same with only nodes and clips
};
template <>
inline constexpr std::array<std::string_view, 4> kWordsOf<ImportKind>{"mesh", "level", "animated", "clips"};

/// The input of an importer.
struct ImportJob {
    std::string shown;      ///< the path for messages (quotedPath)
    std::string file_name;  ///< without its folder
    std::string extension;  ///< lower case, without the dot
    std::span<const std::byte> bytes;
    int folder = -1;  ///< descriptor, or -1
    ImportOptions options;
    std::uint64_t triangle_max = kTriangleMax;  ///< ImportLimits::triangles
    ImportKind kind = ImportKind::kMesh;
};

/// Reads the mesh; defined in the library bake_assimp. \return the input of ImportSource::finish. Errors: those of
/// importMesh.
[[nodiscard]] Result<TriangleMesh> importRaw(const ImportJob& job);

}  // namespace relief
