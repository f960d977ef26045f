// SPDX-License-Identifier: Apache-2.0
#include "bake/recipe/recipe.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <span>

#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/config/toml_value.h"
#include "formats/world/world.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kRecipeVersion = 1;
constexpr std::size_t kTextMax = 4096;  // limit on the bytes of a value
constexpr std::array<std::string_view, 3> kTopKeys = {"version", "defaults", "asset"};
/// Options that select or refine the maps. Worlds, and assets that set an option that selects maps, inherit none of them.
constexpr std::array<std::string_view, 8> kMapChoice = {"map",       "paper",  "budget", "texel",
                                                        "max-error", "decode", "depth",  "resolution"};
/// Number of options of kMapChoice that select the maps; they come first.
constexpr std::size_t kSelectors = 5;

/// Defaults that an asset with `heights` inherits; all others are for meshes.
constexpr std::array<std::string_view, 2> kGroundDefaults = {"compress", "timeout"};

/// Thrown if a recipe exceeds a limit.
struct LimitExceeded {
    std::string message;
};

void rejectUnknown(const TomlValue& table, std::span<const std::string_view> known) {
    for (const toml::key* key : keysInOrder(*table.node().as_table())) {
        if (std::ranges::find(known, key->str()) == known.end()) {
            const std::string guess = didYouMean(key->str(), known);
            table.failAt(*key, "unknown key '" + cleanUtf8(key->str(), 80) + "'" +
                                   (guess.empty() ? "; use one of " + listed(known) : guess));
        }
    }
}

/// Returns a string; accepts numbers if the option takes a number.
std::string textOf(const TomlValue& value, bool number) {
    std::string text;
    if (number && value.node().is_integer()) {
        text = std::to_string(*value.node().value_exact<std::int64_t>());
    } else if (number && value.node().is_floating_point()) {
        text = numberWord(*value.node().value_exact<double>());
    } else if (value.node().is_string()) {
        text = value.text();
    } else {
        value.wrongType(number ? "a string or a number" : "a string");
    }
    if (text.empty()) {
        value.fail(value.name() + " is empty; leave the key out");
    }
    if (text.size() > kTextMax) {
        throw LimitExceeded{value.place() + ": " + value.name() + " is longer than " +
                            std::to_string(kTextMax) + " bytes"};
    }
    if (text.find('\0') != std::string::npos) {
        value.fail(value.name() + " contains a zero byte; remove it");
    }
    return text;
}

/// Returns a string or a list of strings.
std::vector<std::string> textsOf(const TomlValue& value) {
    if (value.array() == nullptr) {
        return {textOf(value, false)};
    }
    if (value.array()->size() > kRecipePatternsMax) {
        throw LimitExceeded{value.place() + ": " + value.name() + " lists more than " +
                            std::to_string(kRecipePatternsMax) + " entries; use patterns"};
    }
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < value.array()->size(); ++i) {
        texts.push_back(textOf(value[i], false));
    }
    return texts;
}

RecipeValue optionOf(const TomlValue& value, FieldKind kind) {
    RecipeValue option{{}, value.place()};
    if (kind == FieldKind::kList) {
        option.values = textsOf(value);
    } else if (kind == FieldKind::kValue) {
        option.values = {textOf(value, true)};
    } else if (value.boolean()) {
        option.values = {""};
    }
    return option;
}

/// \param is_asset  false for the defaults.
RecipeAsset readTable(const TomlValue& table, bool is_asset, const std::vector<RecipeKey>& keys) {
    if (!table.node().is_table()) {
        table.fail(is_asset ? "an asset must be a table; write [[asset]]"
                            : "defaults must be a table; write [defaults]");
    }
    std::vector<std::string_view> known = {"output"};
    if (is_asset) {
        known.insert(known.end(), {"mesh", "exclude", "optional"});
    }
    std::ranges::transform(keys, std::back_inserter(known), &RecipeKey::name);
    rejectUnknown(table, known);
    RecipeAsset asset;
    asset.place = table.place();
    // Messages contain only the key, without its table.
    const auto find = [&](const std::string& key) -> std::optional<TomlValue> {
        const toml::node* node = table.node().as_table()->get(key);
        return node == nullptr ? std::nullopt : std::optional(TomlValue(*node, key, table.file()));
    };
    if (const auto output = find("output")) {
        asset.output = textOf(*output, false);
        asset.output_place = output->place();
    }
    if (const auto mesh = find("mesh")) {
        asset.meshes = textsOf(*mesh);
        asset.mesh_place = mesh->place();
        if (asset.meshes.empty()) {
            mesh->fail("mesh is an empty list; name a file or a pattern");
        }
    }
    if (const auto exclude = find("exclude")) {
        asset.exclude = textsOf(*exclude);
    }
    if (const auto optional = find("optional")) {
        asset.optional = optional->boolean();
    }
    for (const RecipeKey& key : keys) {
        if (const auto value = find(key.name)) {
            asset.options[key.name] = optionOf(*value, key.kind);
        }
    }
    return asset;
}

void merge(RecipeAsset& asset, const RecipeAsset& defaults) {
    if (asset.output.empty()) {
        asset.output = defaults.output;
        asset.output_place = defaults.output_place;
    }
    const auto has_one_of = [&](std::size_t first) {
        return std::ranges::any_of(std::span(kMapChoice).first(first), [&](std::string_view name) {
            return asset.options.contains(std::string(name));
        });
    };
    const auto is_one_of = [](std::span<const std::string_view> names, const std::string& name) {
        return std::ranges::find(names, name) != names.end();
    };
    // A budget for single meshes does not apply to a level.
    const bool selects_maps = has_one_of(kSelectors) || asset.isWorld();
    const bool is_ground = asset.options.contains("heights");
    for (const auto& [name, value] : defaults.options) {
        if (!(selects_maps && is_one_of(kMapChoice, name)) &&
            !(is_ground && !is_one_of(kGroundDefaults, name))) {
            asset.options.emplace(name, value);  // emplace() keeps the asset's own value
        }
    }
}

std::vector<RecipeAsset> readRecipe(const TomlValue& top, const std::vector<RecipeKey>& keys) {
    const auto version = top.find("version");
    if (!version) {
        top.fail("a recipe needs version = 1");
    }
    if (version->node().value_exact<std::int64_t>() != kRecipeVersion) {
        version->fail("version must be 1, the only supported version");
    }
    rejectUnknown(top, kTopKeys);
    const auto table = top.find("defaults");
    const RecipeAsset defaults = table ? readTable(*table, false, keys) : RecipeAsset();
    const auto tables = top.find("asset");
    if (!tables || tables->array() == nullptr || tables->array()->empty()) {
        tables.value_or(top).fail("a recipe needs at least one [[asset]]");
    }
    if (tables->array()->size() > kRecipeTablesMax) {
        throw LimitExceeded{tables->place() + ": " + std::to_string(tables->array()->size()) +
                            " [[asset]] tables exceed the limit of " + std::to_string(kRecipeTablesMax) +
                            "; use patterns, or several recipes"};
    }
    std::vector<RecipeAsset> assets;
    for (std::size_t i = 0; i < tables->array()->size(); ++i) {
        RecipeAsset& asset = assets.emplace_back(readTable((*tables)[i], true, keys));
        merge(asset, defaults);
        if (asset.meshes.empty()) {
            (*tables)[i].fail("an asset needs mesh = \"FILE or pattern\"");
        }
        if (asset.output.empty()) {
            (*tables)[i].fail("an asset needs an output such as output = \"{stem}.relief\"");
        }
    }
    return assets;
}

}  // namespace

bool RecipeAsset::isWorld() const {
    return fs::path(output).filename() == kWorldFileName;
}

Result<std::vector<RecipeAsset>> parseRecipe(std::string_view text, const std::vector<RecipeKey>& keys,
                                             const fs::path& path) {
    TomlFile file;
    file.name = path == "-" ? "standard input" : oneLine(path.native());
    std::vector<RecipeAsset> assets;
    try {
        RELIEF_TRY(readTomlFile(text, file, [&](const TomlValue& top) { assets = readRecipe(top, keys); }));
    } catch (const LimitExceeded& exceeded) {
        return fail(ErrorCode::kLimit, exceeded.message);
    }
    return assets;
}

Result<std::vector<RecipeAsset>> loadRecipe(const fs::path& path, const std::vector<RecipeKey>& keys) {
    const auto bytes = RELIEF_TRY(readFile(path, kRecipeBytesMax));
    return parseRecipe(textOf(bytes), keys, path);
}

std::string nameKeys(std::string message, const std::vector<RecipeKey>& keys) {
    for (std::size_t at = message.find("--"); at != std::string::npos; at = message.find("--", at + 1)) {
        const std::size_t end = message.find_first_not_of("abcdefghijklmnopqrstuvwxyz-", at);
        const std::string name = message.substr(at + 2, std::min(end, message.size()) - at - 2);
        const bool starts = at == 0 || message[at - 1] == ' ' || message[at - 1] == '(';
        if (starts && std::ranges::find(keys, name, &RecipeKey::name) != keys.end()) {
            message.erase(at, 2);
        }
    }
    return message;
}

std::vector<std::string> recipeArguments(const RecipeOptions& options) {
    std::vector<std::string> arguments;
    for (const auto& [name, value] : options) {
        for (const std::string& text : value.values) {
            arguments.push_back(text.empty() ? "--" + name : "--" + name + "=" + text);
        }
    }
    return arguments;
}

}  // namespace relief
