#include "bake/cli/care_options.h"

#include <CLI/CLI.hpp>

namespace relief {

void addMeshCareOptions(CLI::App& verb, MeshCareOptions& options) {
    verb.add_flag(
        "--strict", options.strict,
        "Refuse a mesh that is not a closed solid wound outwards, with exit code 3; with --repair,\n"
        "what is left after it");
    verb.add_flag("--check-intersections", options.check_intersections,
                  "Also count the pairs of triangles that intersect, for the report and --strict");
    verb.add_option(
            "--repair", options.repair,
            "Bake another surface: wrap[=ALPHA] (a closed one shrunk round the mesh, spanning gaps of\n"
            "ALPHA longest sides, 0.01 by default), orient (taken apart where it is not manifold, and\n"
            "wound outwards) or holes (the same with every hole filled)")
        ->option_text("WORD");
}

}  // namespace relief
