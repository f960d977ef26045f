// SPDX-License-Identifier: Apache-2.0
// Counts and triangulates the polygons of a file, and adds them to a scene.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/import/import_scene.h"
#include "formats/polygons/polygon_mesh.h"

namespace relief {

/// Counts the contents of a mesh. \param mesh  its corners are valid indices.
[[nodiscard]] MeshParts partsOf(const PolygonMesh& mesh);

/// Counts the polygons, triangulates them, and adds them as parts below a node with the file's name.
/// \param apart  each corner becomes a separate vertex; true for a mesh with groups.
/// Errors: kLimit (more triangles than the job allows).
[[nodiscard]] Result<void> addPolygons(const PolygonMesh& polygons, bool apart, const ImportJob& job,
                                       ImportScene& scene);

/// Triangulates the polygons into one part without names.
[[nodiscard]] ScenePart cutPolygons(const PolygonMesh& polygons);

/// Returns the error for a file with vertices or lines, but without polygons; nullopt for other files.
[[nodiscard]] std::optional<std::string> partsRefusal(const MeshParts& parts);
/// Warns of skipped lines, points, free forms and meshes, and of many loose vertices; one line each, without the file
/// name.
void warnOfParts(const MeshParts& parts, std::vector<std::string>& warnings);

}  // namespace relief
