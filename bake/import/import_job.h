// What an importer is asked for, and the importer itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bake/import/import_units.h"
#include "bake/mesh/mesh.h"
#include "formats/base/result.h"

namespace relief {

struct ImportOptions {
    /// The unit of the source's lengths, a word of lengthUnits(); the mesh is then in metres. "": what the file
    /// says; where it says nothing, lengths stay as they are and the mesh's unit is "".
    std::string unit;
    /// The source's axis that points upwards; the mesh is turned so that this becomes +Y. None: what the file
    /// says, and where it says nothing, axes stay as they are.
    std::optional<UpAxis> up;
    /// What TriangleMesh::marks answers: names of nodes (all below one count), of meshes, of materials, of OBJ's groups
    /// and objects. Clean UTF-8 (cleanUtf8), at most kAskedNamesMax of at most kAskedNameBytesMax bytes; the file's are
    /// made clean and cut alike. A name that no triangle has is an error (kUsage) that lists those that exist.
    std::vector<std::string> names{};
};

struct ImportLimits {
    std::uint64_t memory = 4'000'000'000;  ///< bytes that the importer may take beside its code and the file
    std::uint32_t seconds = 60;            ///< of processor time, and of wall time; at least 1
    /// Of the mesh, instances counted one by one: more is an error. 1 to kTriangleMax. A bake takes some 120 bytes for
    /// each.
    std::uint64_t triangles = 20'000'000;
};

/// What an importer is given.
struct ImportJob {
    std::string shown;      ///< the path for messages: quotedPath
    std::string file_name;  ///< of the mesh, in its folder
    std::string extension;  ///< lower case, without dot
    std::span<const std::byte> bytes;
    int folder = -1;  ///< descriptor; or -1
    ImportOptions options;
    std::uint64_t triangle_max = kTriangleMax;  ///< ImportLimits::triangles
};

/// Reads the mesh, in the library bake_assimp. \return what ImportSource::finish wants. Errors: as importMesh.
[[nodiscard]] Result<TriangleMesh> importRaw(const ImportJob& job);

}  // namespace relief
