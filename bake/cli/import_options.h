// The command line of every verb that reads a mesh.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "bake/import/mesh_import.h"
#include "formats/base/result.h"

namespace relief {

/// As they were typed.
struct ImportArguments {
    std::string unit;
    std::string up;
    std::string memory;
    std::string seconds;
};

/// Adds --unit, --up, --import-memory and --import-time.
void addImportOptions(CLI::App& verb, ImportArguments& arguments);

/// Errors: kUsage; nothing is read. For before the long work.
[[nodiscard]] Result<void> checkImportArguments(const ImportArguments& arguments);

/// Imports a mesh in a worker, as the arguments say. Errors: kUsage, and as importMeshInWorker.
[[nodiscard]] Result<TriangleMesh> importByArguments(const std::string& path,
                                                     const ImportArguments& arguments);

/// " --unit mm --up +z" for the provenance: those that change the mesh; "" by default.
[[nodiscard]] std::string importProvenance(const ImportArguments& arguments);

}  // namespace relief
