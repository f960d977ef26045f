// The readers of single formats, without those that the runtime has too (formats/polygons) and glTF's.
// Errors name the line of a text, but not the file: kInvalidInput, kLimit, kUnsupported.
#pragma once

#include <cstddef>
#include <span>

#include "bake/import/import_files.h"
#include "bake/import/import_format.h"
#include "bake/import/import_scene.h"
#include "formats/polygons/polygon_mesh.h"

namespace relief {

/// OFF, the Object File Format of Geomview, as text.
///
/// Reads the header OFF, with the prefixes ST, C and N or without it, and the counts of vertices, faces and, if it is there,
/// edges. Each vertex begins a line, and each face too, which may go on over several; what else stands on their last line,
/// colours mostly, is passed over.
[[nodiscard]] Result<PolygonMesh> readOff(std::span<const std::byte> bytes);

/// STL, as text and binary.
///
/// Text begins with "solid" and the rest of its line; then words in any case and over any lines. Several solids may follow each other, and a triangle has
/// the first word of its solid's name. Normals are not looked at. A file that is at least as long as the count of its
/// header needs is binary, whatever it begins with; a warning counts the bytes behind its last triangle.
[[nodiscard]] Result<PolygonMesh> readStl(std::span<const std::byte> bytes);

/// 3MF (core specification 1.3, and production 1.1): a ZIP archive of models, which are objects and what places them.
///
/// The scene is what the model's <build> has. Objects in other models of the archive are read where one names them.
[[nodiscard]] Result<ImportScene> read3mf(std::span<const std::byte> bytes);

/// Every other format, by assimp. Throws std::bad_alloc.
[[nodiscard]] Result<ImportScene> readWithAssimp(AssimpFrame format, const ImportJob& job,
                                                 ImportFiles& files);

/// glTF 2.0, as text and binary, read here and not by assimp, which reads on where the specification says otherwise.
///
/// Whatever has a part in the triangles that the file's scene shows keeps to the specification, or is an error: version,
/// required extensions, JSON without equal keys, buffers (percent-encoded, base64, of their length), accessors (sparse ones,
/// KHR_mesh_quantization, KHR_draco_mesh_compression), indices, modes, transforms, trees of nodes, skins. Skinned meshes
/// come in the pose that the nodes have, and targets of morphs are left out, with a warning each.
[[nodiscard]] Result<ImportScene> readGltf(const ImportJob& job, ImportFiles& files);

}  // namespace relief
