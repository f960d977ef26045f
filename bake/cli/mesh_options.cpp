#include "bake/cli/mesh_options.h"

#include <spdlog/spdlog.h>

namespace relief {

CLI::Option* addMeshOptions(CLI::App& verb, CheckRequest& request) {
    CLI::Option* mesh =
        verb.add_option("--mesh", request.mesh, "The mesh that it was baked from")->option_text("MESH");
    FieldOptions visitor(verb);
    measurementFields(visitor, request);
    for (CLI::Option* option : visitor.options()) {
        option->needs(mesh);
    }
    return mesh;
}

void showCheckWarnings(const MeshCheck& check) {
    for (const std::string& warning : check.warnings) {
        spdlog::warn(warning);
    }
    spdlog::debug("truth {:.2f} s, field {:.2f} s", check.original.samples.seconds,
                  check.original.accuracy.field.seconds);
}

}  // namespace relief
