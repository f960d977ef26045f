// The content of a mesh file beside triangles: nothing is left out without a warning.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "formats/polygons/polygon_mesh.h"

namespace relief {

/// The refusal of a file that has vertices or lines, but no polygon. \return nullopt for all others.
[[nodiscard]] std::optional<std::string> partsRefusal(const MeshParts& parts);

/// Lines, points, free forms and meshes that are left out, and many loose vertices: each a line without the file's name.
void warnOfParts(const MeshParts& parts, std::vector<std::string>& warnings);

}  // namespace relief
