// --strict, --check-intersections and --repair of `relief bake`.
#pragma once

#include "bake/repair/mesh_care.h"

namespace CLI {
class App;
}

namespace relief {

void addMeshCareOptions(CLI::App& verb, MeshCareOptions& options);

}  // namespace relief
