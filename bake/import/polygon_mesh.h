// The surface of a file that is read here and not by assimp: OBJ, OFF, PLY, RAW and STL.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "bake/import/import_job.h"
#include "bake/import/import_parts.h"
#include "bake/mesh/mesh.h"
#include "formats/base/result.h"

namespace relief {

/// Polygons in a row that have the same names.
struct PolygonGroup {
    std::size_t begin = 0;                 ///< index of the first; it ends where the next group begins
    std::vector<std::string> names;        ///< as the file has them
    std::vector<std::string> words_names;  ///< the same, but each of their words is a name as well
    std::string node;      ///< of SurfaceName: the group, object or solid; one of a name is one node
    std::string material;  ///< of SurfaceName
};

struct PolygonMesh {
    std::vector<glm::vec3> positions;  ///< of all its vertices; may be no numbers
    /// Positions, counter-clockwise seen from outside: the corners of all polygons, one polygon after the other.
    std::vector<std::uint32_t> corners;
    std::vector<std::uint32_t> sizes;   ///< of each polygon, in corners; 1 and 2 are possible, 0 is not
    std::vector<PolygonGroup> groups;   ///< by their beginnings; polygons before the first have no names
    std::vector<std::string> warnings;  ///< without the file's name
    /// Lines and points that are no polygons of it, free forms, and how many vertices only those use. The rest is counted
    /// from the polygons.
    MeshParts others;
    std::vector<std::uint8_t>
        in_others;  ///< of each position, 1 for those that lines and points use; empty: none does
};

/// Counts what the mesh holds. \param mesh  whose corners exist.
[[nodiscard]] MeshParts partsOf(const PolygonMesh& mesh);

/// Cuts the polygons into triangles, applies `linear`, and adds them to `mesh`, with marks if the job asks for names.
/// \param apart  whether each corner becomes a vertex of its own; true for a mesh that has groups.
/// Errors: kLimit (more triangles than the job allows), kInvalidInput (none), kUsage (a name that no triangle has).
[[nodiscard]] Result<TriangleMesh> flatten(const PolygonMesh& polygons, bool apart, const glm::dmat3& linear,
                                           const ImportJob& job, TriangleMesh mesh);

/// "line 12: WHAT", kInvalidInput.
[[nodiscard]] tl::unexpected<Error> wrongLine(std::size_t line, const std::string& what);

/// Of the error of a reader: with the file in front, and a cure behind it if it has none.
[[nodiscard]] tl::unexpected<Error> unreadable(const std::string& shown, const Error& error);

}  // namespace relief
