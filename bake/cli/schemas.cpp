#include "bake/cli/schemas.h"

#include "bake/director/bake_json.h"
#include "bake/director/mesh_check_report.h"
#include "bake/report/collider_report.h"
#include "bake/report/diff_report.h"
#include "bake/report/inspect_report.h"
#include "bake/report/recipe_report.h"
#include "formats/fields/json.h"

namespace relief {

GeneratedTexts bakeSchemas() {
    return {
        schemaFile("bake", "relief bake --json", "A bake.", schemaOf(BakeJson{})),
        schemaFile("check", "relief check --mesh --json", "A collider measured against its mesh.",
                   schemaOf(MeshCheckReport{})),
        schemaFile(
            "check-file", "relief check FILE --json",
            "Faults of a container, and the parts that can be trusted. formats/README.md lists the codes.",
            schemaOf(InspectionReport{})),
        schemaFile("diff", "relief diff --json", "The differences of two colliders.", schemaOf(DiffReport{})),
        schemaFile("info", "relief info --json", "The contents of a collider.", schemaOf(InfoReport{})),
        schemaFile("recipe", "relief bake --recipe --json", "A run of a recipe.", schemaOf(RecipeJson{})),
        schemaFile("recipe-events", "relief bake --recipe --events",
                   "One line: an event of a run of a recipe.", schemaOf(RecipeEvent{})),
    };
}

}  // namespace relief
