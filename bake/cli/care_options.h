// --strict, --check-intersections and --repair of `relief bake`.
#pragma once

#include <CLI/CLI.hpp>

#include "bake/repair/mesh_care.h"

namespace relief {

void addMeshCareOptions(CLI::App& verb, MeshCareOptions& options);

}  // namespace relief
