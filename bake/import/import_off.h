// OFF, the Object File Format of Geomview, as text.
#pragma once

#include <cstddef>
#include <span>

#include "bake/import/polygon_mesh.h"

namespace relief {

/// Reads the header OFF, with the prefixes ST, C, N and 4 in this order or without it, and the counts of vertices, faces and,
/// if it is there, edges. Each vertex begins a line, and each face too, which may go on over several; what else stands on
/// their last line, colours mostly, is passed over. Files that keep to no lines are read word by word.
/// Errors, naming the line but not the file: kInvalidInput, kLimit.
[[nodiscard]] Result<PolygonMesh> readOff(std::span<const std::byte> bytes);

}  // namespace relief
