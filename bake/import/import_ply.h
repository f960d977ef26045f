// PLY meshes, read here and not by assimp, which keeps one triangle of a strip and passes over what it does not know
// without a word.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// The surface of a PLY file.
struct PlyMesh {
    std::vector<glm::vec3> positions;  ///< of all its vertices; may be no numbers
    /// Positions, counter-clockwise seen from outside: the corners of all polygons, one polygon after the other.
    std::vector<std::uint32_t> corners;
    std::vector<std::uint32_t> sizes;   ///< of each polygon, in corners; 1 and 2 are possible, 0 is not
    std::vector<std::string> warnings;  ///< without the file's name
};

/// Reads text and binary of either byte order: the element `vertex`, and the lists `vertex_indices` (or
/// `vertex_index`) of the elements `face` and `tristrips`. In a strip, three indices in a row are a triangle, every
/// other one wound the other way; -1 ends it and begins the next. Elements of other names are passed over, with a
/// warning where they look like faces.
/// \param shown  the file's name for messages.
/// \return at least one polygon.
/// Errors, naming the file: kInvalidInput (no PLY, cut off, a vertex that is not there, no faces), kLimit.
[[nodiscard]] Result<PlyMesh> readPly(std::span<const std::byte> bytes, const std::string& shown);

}  // namespace relief
