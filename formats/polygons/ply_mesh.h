// SPDX-License-Identifier: Apache-2.0
// Reads PLY meshes. assimp 5.2 is not used because it keeps only one triangle of a strip, invents the faces of a
// truncated file, and accepts wrong counts (import_text_test.cpp, PlyByLinesWithTrueCounts). The runtime also needs
// this reader and does not link assimp.
#pragma once

#include <cstddef>
#include <span>

#include "formats/polygons/polygon_mesh.h"

namespace relief {

/// Reads text, and binary of either byte order: the element `vertex`, and the lists `vertex_indices` (or
/// `vertex_index`) of the elements `face` and `tristrips`. In a strip, every three consecutive indices form a triangle,
/// with alternating winding; -1 starts a new strip. Other elements are skipped, with a warning if they look like faces.
/// Vertex colours are red, green and blue as bytes, 16-bit integers, or floats in 0…1.
/// \return at least one polygon.
/// Errors, with the line of a text file but not the file: kInvalidInput (not a PLY, truncated, a missing vertex, no
/// faces), kLimit.
[[nodiscard]] Result<PolygonMesh> readPly(std::span<const std::byte> bytes,
                                          PolygonColors colors = PolygonColors::kSkip);

}  // namespace relief
