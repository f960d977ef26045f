// Objects that place one another, as 3MF and AMF files consist of them.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "bake/import/import_instances.h"
#include "bake/import/import_job.h"
#include "bake/import/import_units.h"
#include "bake/mesh/mesh.h"
#include "formats/base/result.h"

namespace relief {

/// Triangles of one material.
struct AssemblyPart {
    std::vector<std::string> names;
    std::vector<glm::uvec3> triangles;
};

/// An object as another one, or the scene, places it.
struct AssemblyUse {
    std::size_t object = 0;  ///< index
    Transform transform;
};

struct AssemblyObject {
    std::vector<std::string> names;
    std::vector<glm::vec3> positions;
    std::vector<AssemblyPart> parts;
    std::vector<AssemblyUse> uses;
};

struct Assembly {
    std::vector<AssemblyObject> objects;
    std::vector<AssemblyUse> roots;  ///< the scene
};

/// Everything that a file holds.
struct AssemblyFile {
    Assembly assembly;
    SourceFrame frame;
    std::vector<std::string> warnings;
};

/// Everything that the scene shows, with warnings of what it leaves out.
/// \param linear  applied last. \param mesh  what is known of it otherwise; no positions yet.
/// Errors: kInvalidInput (an index of a vertex that does not exist, an object within itself, no triangles), kUsage (names),
/// kLimit (triangles).
[[nodiscard]] Result<TriangleMesh> flatten(const Assembly& assembly, const glm::dmat3& linear,
                                           const ImportJob& job, TriangleMesh mesh);

}  // namespace relief
