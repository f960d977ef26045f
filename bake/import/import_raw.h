// RAW: three corners a line, as POV-Ray's tools write them.
#pragma once

#include <cstddef>
#include <span>

#include "bake/import/polygon_mesh.h"

namespace relief {

/// A line is a triangle of 9 numbers, or of 12 with a colour in front; the name of a texture may stand behind them. Other
/// lines name the group that the next belong to. Triangles come group by group, and texture by texture.
/// Errors, naming the line but not the file: kInvalidInput.
[[nodiscard]] Result<PolygonMesh> readRaw(std::span<const std::byte> bytes);

}  // namespace relief
