// SPDX-License-Identifier: Apache-2.0
// Recipes: any input gives assets with valid options of a bake, or one line with file, line and column.
#include "bake/recipe/recipe.h"

#include <regex>
#include <string_view>

#include "tests/fuzz/target.h"

namespace {

using relief::RecipeAsset;
using relief::RecipeKey;

using Kind = relief::FieldKind;
const std::vector<RecipeKey> kKeys = {{"map", Kind::kList},         {"paper", Kind::kFlag},
                                      {"strict", Kind::kFlag},      {"clips", Kind::kList},
                                      {"budget", Kind::kValue},     {"max-error", Kind::kValue},
                                      {"resolution", Kind::kValue}, {"decode", Kind::kValue},
                                      {"prefer", Kind::kValue},     {"compress", Kind::kValue}};

void mustBePlace(const std::string& place) {
    static const std::regex kPlace("r\\.toml:[0-9]+:[0-9]+");
    mustHold(std::regex_match(place, kPlace), "a place is a file, a line and a column");
}

void mustBeText(const std::string& text) {
    mustHold(!text.empty() && text.find('\0') == std::string::npos,
             "no value is empty or contains a zero byte");
}

void mustBeAsset(const RecipeAsset& asset) {
    mustHold(!asset.meshes.empty() && asset.meshes.size() <= relief::kRecipePatternsMax,
             "an asset has one mesh or more, but not too many");
    mustHold(asset.exclude.size() <= relief::kRecipePatternsMax, "an asset has not too many exclusions");
    for (const std::vector<std::string>* texts : {&asset.meshes, &asset.exclude}) {
        for (const std::string& text : *texts) {
            mustBeText(text);
        }
    }
    mustBeText(asset.output);
    mustBePlace(asset.place);
    mustBePlace(asset.mesh_place);
    mustBePlace(asset.output_place);
    for (const auto& [name, value] : asset.options) {
        mustBePlace(value.place);
        for (const RecipeKey& key : kKeys) {
            mustHold(key.name != name || key.kind != relief::FieldKind::kValue || value.values.size() == 1,
                     "the option has one value");
        }
    }
    // Each command-line argument is one known option.
    for (const std::string& argument : relief::recipeArguments(asset.options)) {
        bool known = false;
        for (const RecipeKey& key : kKeys) {
            const std::string option = "--" + key.name;
            known = known || argument == option || argument.starts_with(option + "=");
        }
        mustHold(known && argument.find('\0') == std::string::npos, "an argument is a known option");
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto assets = relief::parseRecipe(text, kKeys, "r.toml");
    if (!assets) {
        const std::string& message = assets.error().message;
        mustBePlace(message.substr(0, message.find(": ")));
        mustBeLine(message);
        return 0;
    }
    mustHold(!assets->empty() && assets->size() <= relief::kRecipeTablesMax, "a recipe has assets");
    for (const RecipeAsset& asset : *assets) {
        mustBeAsset(asset);
    }
    return 0;
}
