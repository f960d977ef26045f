// STL, as text and binary.
#pragma once

#include <cstddef>
#include <span>

#include "bake/import/polygon_mesh.h"

namespace relief {

/// Text begins with "solid", words in any case and over any lines; several solids may follow each other, and a triangle has
/// the first word of its solid's name. Normals are not looked at. A file that is at least as long as the count of its
/// header says is binary, whatever it begins with; a warning counts the bytes behind its last triangle.
/// Errors, naming the line of a text but not the file: kInvalidInput, kLimit.
[[nodiscard]] Result<PolygonMesh> readStl(std::span<const std::byte> bytes);

}  // namespace relief
