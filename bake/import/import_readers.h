// SPDX-License-Identifier: Apache-2.0
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
/// edges. Vertices and faces may span several lines. The rest of their last line, mostly colours, is skipped. Several may share
/// a line if that gives the announced counts: faces without colours, and vertices with as many numbers behind their
/// coordinates as the header has letters for.
[[nodiscard]] Result<PolygonMesh> readOff(std::span<const std::byte> bytes);

/// STL, as text and binary.
///
/// Text begins with "solid" and the rest of its line; then words in any case and over any lines. Several solids may follow each other, and a triangle has
/// the first word of its solid's name. Normals are not looked at. A file that is at least as long as the count of its
/// header needs is binary, whatever it begins with; a warning counts the bytes behind its last triangle.
[[nodiscard]] Result<PolygonMesh> readStl(std::span<const std::byte> bytes);

/// AC3D, as text, with the triangle strips, normals and several textures that TORCS adds to it.
///
/// An object is a node, its kids are below it, and its surfaces have a part for each material. Lines are left out, and
/// subdivisions not made, both with a warning. `data` may be anything.
[[nodiscard]] Result<ImportScene> readAc3d(const ImportJob& job);

/// All other formats, by assimp. Throws std::bad_alloc.
[[nodiscard]] Result<ImportScene> readWithAssimp(AssimpFrame format, const ImportJob& job,
                                                 ImportFiles& files);

/// glTF 2.0, as text and binary; not by assimp, which accepts invalid files.
///
/// Everything that the triangles of the shown scene depend on must conform to the specification: version,
/// required extensions, JSON without equal keys, buffers (percent-encoded, base64, of their length), accessors (sparse ones,
/// KHR_mesh_quantization), instances (EXT_mesh_gpu_instancing), indices, modes, transforms, trees of nodes, skins. Skinned meshes
/// have the pose of the nodes; morph targets are left out; both with a warning.
[[nodiscard]] Result<ImportScene> readGltf(const ImportJob& job, ImportFiles& files);

/// TriangleMesh::animation of a glTF file, for jobs of kAnimated and kClips, with unit and warnings. Reads what readGltf() does,
/// and also morph targets and animations; which of them become part of the mesh is said in animated_import.h.
[[nodiscard]] Result<TriangleMesh> readAnimatedGltf(const ImportJob& job, ImportFiles& files);

}  // namespace relief
