// The polygons of a file as a mesh of triangles.
#pragma once

#include <glm/mat3x3.hpp>
#include <string>

#include "bake/import/import_job.h"
#include "bake/mesh/mesh.h"
#include "formats/base/result.h"
#include "formats/polygons/polygon_mesh.h"

namespace relief {

static_assert(kPolygonTrianglesMax == kTriangleMax);

/// Counts what the mesh holds. \param mesh  whose corners exist.
[[nodiscard]] MeshParts partsOf(const PolygonMesh& mesh);

/// Cuts the polygons into triangles, applies `linear`, and adds them to `mesh`, with marks if the job asks for names.
/// \param apart  whether each corner becomes a vertex of its own; true for a mesh that has groups.
/// Errors: kLimit (more triangles than the job allows), kInvalidInput (none), kUsage (a name that no triangle has).
[[nodiscard]] Result<TriangleMesh> flatten(const PolygonMesh& polygons, bool apart, const glm::dmat3& linear,
                                           const ImportJob& job, TriangleMesh mesh);

/// Of the error of a reader: with the file in front, and a cure behind it if it has none.
[[nodiscard]] tl::unexpected<Error> unreadable(const std::string& shown, const Error& error);

}  // namespace relief
