// SPDX-License-Identifier: Apache-2.0
#include "bake/cli/command.h"
#include "bake/cli/command_bake.h"
#include "bake/cli/world_info.h"
#include "bake/report/bake_report.h"
#include "bake/report/collider_report.h"
#include "bake/report/ground_report.h"
#include "bake/report/inspect_report.h"
#include "bake/report/mesh_check_report.h"
#include "bake/report/recipe_report.h"
#include "bake/report/world_report.h"
#include "formats/fields/json.h"

namespace relief {
namespace {

/// "         budget: Optional[Number] = None,"
std::string pythonArguments(const std::vector<FieldWords>& fields, const std::string& indent) {
    std::string text;
    for (const FieldWords& field : fields) {
        const std::string name = field.name == "map" ? "maps" : field.name == "as" ? "as_" : field.name;
        const std::string type = field.kind == FieldKind::kFlag   ? "bool = False"
                                 : field.kind == FieldKind::kList ? "Union[str, Sequence[str], None] = None"
                                 : field.number || !field.info.unit.empty() ? "Optional[Number] = None"
                                 : valueText(field) == "FILE"               ? "Optional[Path] = None"
                                                                            : "Optional[str] = None";
        text += indent + name + ": " + type + ",\n";
    }
    return text;
}

std::string recipeDictionary() {
    std::string text;
    for (const RecipeKey& key : recipeKeys()) {
        text += "\"" + key.name + "\"\n";
    }
    for (const FieldWords& field : fieldsOf(BakeRequest())) {
        for (const std::string_view choice : field.choices) {
            text += "\"" + std::string(choice) + "\"\n";
        }
    }
    return text;
}

}  // namespace

GeneratedTexts bakeTexts() {
    const std::vector<FieldWords> bake = fieldsOf(BakeRequest());
    const std::vector<FieldWords> check = fieldsOf(CheckRequest());
    const std::string init = "bake/python/relief/__init__.py";
    return {
        {init, "bake-arguments", pythonArguments(bake, "         ")},
        {init, "check-arguments", pythonArguments(check, "          ")},
        {.path = "recipe.dict", .part = {}, .text = recipeDictionary(), .built = true},
        schemaFile("bake", "relief bake --json", "A bake.", BakeJson{}),
        schemaFile("check", "relief check --mesh --json", "A collider measured against its mesh.",
                   MeshCheckReport{}),
        schemaFile("check-file", "relief check FILE --json",
                   "Issues of a container, and its usable sections. formats/README.md lists the codes.",
                   InspectionReport{}),
        schemaFile("info", "relief info --json", "The contents of a collider.", ColliderJson{}),
        schemaFile("world", "world.json of relief bake --world", "Placed colliders.", World{}),
        schemaFile("world-bake", "relief bake --world --json", "A bake of a level.", WorldBakeJson{}),
        schemaFile("world-info", "relief info world.json --json", "The contents of a world.", WorldInfo{}),
        schemaFile("ground-bake", "relief bake --heights --json", "A bake of a height map.", GroundJson{}),
        schemaFile("ground-check", "relief check --heights --json", "Ground measured against its height map.",
                   GroundCheckJson{}),
        schemaFile("world-check", "relief check world.json --json", "A world, and its accuracy.",
                   WorldCheckJson{}),
        schemaFile("recipe", "relief bake --recipe --json", "A run of a recipe.", RecipeJson{}),
        schemaFile("recipe-events", "relief bake --recipe --events",
                   "One line: an event of a run of a recipe.", RecipeEvent{})};
}

}  // namespace relief
