// The options of every verb that reads a mesh.
#pragma once

#include <string>

#include "bake/import/mesh_import.h"

namespace CLI {
class App;
}

namespace relief {

struct ImportSettings {
    ImportOptions options;
    ImportLimits limits;
};

/// Adds --unit, --up, --import-memory, --import-time and --max-triangles.
void addImportOptions(CLI::App& verb, ImportSettings& settings);

/// " --unit mm --up +z" for the provenance: those that change the mesh; "" by default.
[[nodiscard]] std::string importProvenance(const ImportOptions& options);

}  // namespace relief
