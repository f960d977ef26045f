// SPDX-License-Identifier: Apache-2.0
// PLY meshes. Not by assimp 5.2, which keeps one triangle of a strip, makes up the faces of a cut file, and accepts wrong
// counts (import_text_test.cpp, PlyByLinesWithTrueCounts); the runtime, which links no assimp, needs it too.
#pragma once

#include <cstddef>
#include <span>

#include "formats/polygons/polygon_mesh.h"

namespace relief {

/// Reads text and binary of either byte order: the element `vertex`, and the lists `vertex_indices` (or
/// `vertex_index`) of the elements `face` and `tristrips`. In a strip, three indices in a row are a triangle, every
/// other one wound the other way; -1 ends it and begins the next. Elements of other names are passed over, with a
/// warning where they look like faces.
/// Colours are red, green and blue of vertices: bytes, integers of 16 bits, or floats 0…1.
/// \return at least one polygon.
/// Errors, naming the line of a text but not the file: kInvalidInput (no PLY, cut off, a vertex that is not there, no faces), kLimit.
[[nodiscard]] Result<PolygonMesh> readPly(std::span<const std::byte> bytes,
                                          PolygonColors colors = PolygonColors::kSkip);

}  // namespace relief
