// What a mesh file holds beside triangles, and what a reader says of it: nothing is left out without a word.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// Counts of a file, before anything is left out or triangulated; what is used twice counts once.
struct MeshParts {
    std::uint64_t polygons = 0;  ///< faces of at least three corners
    std::uint64_t lines = 0;
    std::uint64_t points = 0;
    std::uint64_t free_forms = 0;  ///< curves, surfaces and patches without polygons
    std::uint64_t vertices = 0;
    std::uint64_t unused = 0;  ///< vertices that no polygon uses
    std::uint64_t loose = 0;   ///< and neither a line nor a point
    std::uint64_t meshes = 0;
    std::uint64_t unplaced = 0;  ///< meshes that no node of the scene places
};

/// What to do about a file that has vertices or lines, but no polygon. \return nullopt for all others.
[[nodiscard]] std::optional<std::string> partsRefusal(const MeshParts& parts);

/// Lines, points, free forms and meshes that are left out, and many loose vertices: each a line without the file's name.
void warnOfParts(const MeshParts& parts, std::vector<std::string>& warnings);

}  // namespace relief
