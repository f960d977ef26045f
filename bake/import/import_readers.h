// The readers of single formats, without those that the runtime has too (formats/polygons) and glTF's.
// Errors name the line of a text, but not the file: kInvalidInput, kLimit.
#pragma once

#include <cstddef>
#include <span>

#include "bake/import/import_assembly.h"
#include "formats/polygons/polygon_mesh.h"

namespace relief {

/// OFF, the Object File Format of Geomview, as text.
///
/// Reads the header OFF, with the prefixes ST, C, N and 4 in this order or without it, and the counts of vertices, faces and,
/// if it is there, edges. Each vertex begins a line, and each face too, which may go on over several; what else stands on
/// their last line, colours mostly, is passed over. Files that keep to no lines are read word by word.
[[nodiscard]] Result<PolygonMesh> readOff(std::span<const std::byte> bytes);

/// RAW: three corners a line, as POV-Ray's tools write them.
///
/// A line is a triangle of 9 numbers, or of 12 with a colour in front; the name of a texture may stand behind them. Other
/// lines name the group that the next belong to. Triangles come group by group, and texture by texture.
[[nodiscard]] Result<PolygonMesh> readRaw(std::span<const std::byte> bytes);

/// STL, as text and binary.
///
/// Text begins with "solid", words in any case and over any lines; several solids may follow each other, and a triangle has
/// the first word of its solid's name. Normals are not looked at. A file that is at least as long as the count of its
/// header needs is binary, whatever it begins with; a warning counts the bytes behind its last triangle.
[[nodiscard]] Result<PolygonMesh> readStl(std::span<const std::byte> bytes);

/// AMF (ISO/ASTM 52915): objects of volumes, and constellations that place them.
///
/// An instance of a constellation is turned about x, then y, then z, by degrees, and then moved. The scene is what no
/// instance places.
[[nodiscard]] Result<AssemblyFile> readAmf(std::span<const std::byte> bytes);

/// 3MF (core specification 1.3, and production 1.1): a ZIP archive of models, which are objects and what places them.
///
/// The scene is what the model's <build> has. Objects in other models of the archive are read where one names them.
/// Errors: also kUnsupported (an extension that the file requires).
[[nodiscard]] Result<AssemblyFile> read3mf(std::span<const std::byte> bytes);

/// \return true for an AC3D file that holds less than its counts announce: assimp, which reads it, takes zeros for the rest.
[[nodiscard]] bool isAcCutOff(std::span<const std::byte> bytes);

}  // namespace relief
