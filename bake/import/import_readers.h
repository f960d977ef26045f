// SPDX-License-Identifier: Apache-2.0
// Declares the readers of mesh formats. The parts of the glTF reader have their own headers, and so do the readers that
// the runtime shares (formats/polygons).
// Errors: kInvalidInput, kLimit, kUnsupported. Messages give the line in a text file, but not the file name.
#pragma once

#include <cstddef>
#include <span>

#include "bake/import/import_files.h"
#include "bake/import/import_format.h"
#include "bake/import/import_scene.h"
#include "formats/polygons/polygon_mesh.h"

namespace relief {

/// Reads OFF (Object File Format of Geomview), as text.
///
/// The header OFF is optional and may have the prefixes ST, C and N. The counts of vertices, faces and, optionally,
/// edges follow. Vertices and faces may span several lines. The rest of their last line, usually colours, is skipped.
/// A line may hold several vertices or faces if the file then matches the header's counts. Faces that share a line have
/// no colours; vertices that share a line have as many numbers after their coordinates as the prefixes require.
[[nodiscard]] Result<PolygonMesh> readOff(std::span<const std::byte> bytes);

/// Reads STL, as text or binary.
///
/// Text starts with a line that begins with "solid"; keywords are case-insensitive, and line breaks count as spaces. A
/// file may contain several solids; each is a group named by the first word of its name. Normals are ignored. A file
/// is binary, regardless of its first bytes, if it is at least as long as its header's triangle count requires. Bytes
/// after the last triangle cause a warning.
[[nodiscard]] Result<PolygonMesh> readStl(std::span<const std::byte> bytes);

/// Reads AC3D, as text, including TORCS's extensions: triangle strips, normals and multiple textures.
///
/// Each object becomes a node with its child objects below it; its surfaces become one part per material. Line
/// primitives are skipped and subdivision is not applied, both with a warning. The contents of `data` are ignored.
[[nodiscard]] Result<ImportScene> readAc3d(const ImportJob& job);

/// Reads all other formats with assimp. Throws std::bad_alloc.
[[nodiscard]] Result<ImportScene> readWithAssimp(AssimpFrame format, const ImportJob& job,
                                                 ImportFiles& files);

/// Reads glTF 2.0, as text or binary, without assimp, which accepts invalid files.
///
/// Everything that the triangles of the shown scene depend on must conform to the specification: version, required
/// extensions, JSON without duplicate keys, buffers (percent-encoded, base64, length), accessors (sparse,
/// KHR_mesh_quantization), instances (EXT_mesh_gpu_instancing), indices, modes, transforms, node hierarchy, skins.
/// Skinned meshes get the pose of the nodes, and morph targets are ignored, both with a warning.
[[nodiscard]] Result<ImportScene> readGltf(const ImportJob& job, ImportFiles& files);

/// Reads TriangleMesh::animation of a glTF file, with unit and warnings, for jobs of kAnimated and kClips. For
/// kAnimated, reads the data of readGltf(), plus morph targets and animations; for kClips, only nodes and animations.
[[nodiscard]] Result<TriangleMesh> readAnimatedGltf(const ImportJob& job, ImportFiles& files);

}  // namespace relief
