// --mesh of the verbs that measure a collider against its mesh.
#pragma once

#include "bake/director/mesh_check.h"
#include "runtime/command_line/field_options.h"

namespace relief {

/// Adds --mesh, and the fields that need it.
/// \return --mesh
CLI::Option* addMeshOptions(CLI::App& verb, CheckRequest& request);

/// Logs the warnings, and with -v the times.
void showCheckWarnings(const MeshCheck& check);

}  // namespace relief
