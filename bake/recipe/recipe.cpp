#include "bake/recipe/recipe.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <exception>

#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/config/toml.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kRecipeVersion = 1;
constexpr std::size_t kTextMax = 4096;  // bytes of a value
constexpr std::array<std::string_view, 3> kTopKeys = {"version", "defaults", "asset"};
/// Who says how the maps are chosen says it alone: these go together.
constexpr std::array<std::string_view, 8> kMapChoice = {"map",       "paper",  "plan",  "budget",
                                                        "max-error", "decode", "depth", "resolution"};
/// Those of kMapChoice that choose, rather than refine the choice.
constexpr std::size_t kChoosers = 5;

/// The shortest number that reads back as the same.
std::string numberText(double value) {
    std::array<char, 64> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

class Reader {
  public:
    Reader(std::string file, const std::vector<RecipeKey>& keys) : file_(std::move(file)), keys_(keys) {}

    Result<std::vector<RecipeAsset>> read(std::string_view text) const {
        try {
            return readRecipe(toml::parse(text, file_));
        } catch (const toml::parse_error& error) {
            return invalid(error.source().begin, "not TOML: " + cleanUtf8(error.description()));
        } catch (const std::exception& error) {
            return invalid({1, 1}, "cannot be read: " + cleanUtf8(error.what()));
        }
    }

  private:
    [[nodiscard]] RecipePlace place(const toml::source_position& at) const {
        return file_ + ":" + std::to_string(at.line) + ":" + std::to_string(at.column);
    }
    [[nodiscard]] tl::unexpected<Error> failAt(const toml::source_position& at, ErrorCode code,
                                               const std::string& message) const {
        return fail(code, place(at) + ": " + message);
    }
    [[nodiscard]] tl::unexpected<Error> invalid(const toml::source_position& at,
                                                const std::string& message) const {
        return failAt(at, ErrorCode::kInvalidInput, message);
    }
    [[nodiscard]] tl::unexpected<Error> unknown(const toml::key& key,
                                                std::span<const std::string_view> known) const {
        const std::string guess = didYouMean(key.str(), known);
        return invalid(key.source().begin, "unknown key '" + cleanUtf8(key.str(), 80) + "'" +
                                               (guess.empty() ? "; known are " + listed(known) : guess));
    }

    [[nodiscard]] Result<std::vector<RecipeAsset>> readRecipe(const toml::table& root) const {
        const toml::node* version = root.get("version");
        if (version == nullptr) {
            return invalid({1, 1}, "a recipe starts with version = 1");
        }
        if (version->value_exact<std::int64_t>() != kRecipeVersion) {
            return invalid(version->source().begin, "version must be 1, the only one that is known");
        }
        for (const toml::key* key : keysInOrder(root)) {
            if (std::find(kTopKeys.begin(), kTopKeys.end(), key->str()) == kTopKeys.end()) {
                return unknown(*key, kTopKeys);
            }
        }
        RecipeAsset defaults;
        if (const toml::node* node = root.get("defaults"); node != nullptr) {
            const toml::table* table = node->as_table();
            if (table == nullptr) {
                return invalid(node->source().begin, "defaults must be a table; write [defaults]");
            }
            RELIEF_TRY(readTable(*table, false, defaults));
        }
        const toml::node* node = root.get("asset");
        const toml::array* tables = node == nullptr ? nullptr : node->as_array();
        if (tables == nullptr || tables->empty()) {
            return invalid(node == nullptr ? toml::source_position{1, 1} : node->source().begin,
                           "a recipe needs at least one [[asset]]");
        }
        if (tables->size() > kRecipeTablesMax) {
            return failAt(node->source().begin, ErrorCode::kLimit,
                          std::to_string(tables->size()) + " [[asset]] are more than the limit of " +
                              std::to_string(kRecipeTablesMax) + "; use patterns, or several recipes");
        }
        std::vector<RecipeAsset> assets;
        for (const toml::node& entry : *tables) {
            const toml::table* table = entry.as_table();
            if (table == nullptr) {
                return invalid(entry.source().begin, "an asset must be a table; write [[asset]]");
            }
            RecipeAsset asset;
            asset.place = place(table->source().begin);
            RELIEF_TRY(readTable(*table, true, asset));
            if (asset.meshes.empty()) {
                return invalid(table->source().begin, "an asset needs mesh = \"FILE or pattern\"");
            }
            if (asset.output.empty() && defaults.output.empty()) {
                return invalid(table->source().begin, "an asset needs output = \"{stem}.relief\" or such");
            }
            assets.push_back(merged(std::move(asset), defaults));
        }
        return assets;
    }

    static RecipeAsset merged(RecipeAsset asset, const RecipeAsset& defaults) {
        if (asset.output.empty()) {
            asset.output = defaults.output;
            asset.output_place = defaults.output_place;
        }
        const bool chooses = std::any_of(kMapChoice.begin(), kMapChoice.begin() + kChoosers, [&](auto name) {
            return asset.options.contains(std::string(name));
        });
        for (const auto& [name, value] : defaults.options) {
            const bool of_choice = std::find(kMapChoice.begin(), kMapChoice.end(), name) != kMapChoice.end();
            if (!(chooses && of_choice)) {
                asset.options.emplace(name, value);  // the asset's own stays
            }
        }
        return asset;
    }

    Result<void> readTable(const toml::table& table, bool is_asset, RecipeAsset& asset) const {
        std::vector<std::string_view> known = {"output"};
        if (is_asset) {
            known.insert(known.end(), {"mesh", "exclude", "optional"});
        }
        for (const RecipeKey& key : keys_) {
            known.push_back(key.name);
        }
        for (const toml::key* key : keysInOrder(table)) {
            const std::string_view name = key->str();
            const toml::node& node = *table.get(name);
            Result<void> done;
            if (name == "output") {
                done = readOutput(node, asset);
            } else if (is_asset && name == "mesh") {
                asset.mesh_place = place(node.source().begin);
                done = readTexts(node, name, asset.meshes);
                if (done && asset.meshes.empty()) {
                    done = invalid(node.source().begin, "mesh names nothing; name a file or a pattern");
                }
            } else if (is_asset && name == "exclude") {
                done = readTexts(node, name, asset.exclude);
            } else if (is_asset && name == "optional") {
                if (!node.is_boolean()) {
                    return invalid(node.source().begin, "optional must be true or false");
                }
                asset.optional = *node.value_exact<bool>();
            } else if (const RecipeKey* option = optionOf(name); option != nullptr) {
                done = readOption(node, *option, asset.options);
            } else {
                return unknown(*key, known);
            }
            if (!done) {
                return done;
            }
        }
        return {};
    }

    [[nodiscard]] const RecipeKey* optionOf(std::string_view name) const {
        const auto found =
            std::find_if(keys_.begin(), keys_.end(), [&](const RecipeKey& key) { return key.name == name; });
        return found == keys_.end() ? nullptr : &*found;
    }

    Result<void> readOutput(const toml::node& node, RecipeAsset& asset) const {
        const std::string text = RELIEF_TRY(readText(node, "output", false));
        asset.output = text;
        asset.output_place = place(node.source().begin);
        return {};
    }

    /// A string; numbers too, where an option takes one.
    [[nodiscard]] Result<std::string> readText(const toml::node& node, std::string_view name,
                                               bool number) const {
        std::string text;
        if (const auto value = node.value_exact<std::string>()) {
            text = *value;
        } else if (number && node.is_integer()) {
            text = std::to_string(*node.value_exact<std::int64_t>());
        } else if (number && node.is_floating_point()) {
            text = numberText(*node.value_exact<double>());
        } else {
            return invalid(node.source().begin,
                           std::string(name) + " must be a string" + (number ? " or a number" : ""));
        }
        if (text.empty()) {
            return invalid(node.source().begin, std::string(name) + " is empty; leave the key out");
        }
        if (text.size() > kTextMax) {
            return failAt(node.source().begin, ErrorCode::kLimit,
                          std::string(name) + " is longer than " + std::to_string(kTextMax) + " bytes");
        }
        if (text.find('\0') != std::string::npos) {
            return invalid(node.source().begin, std::string(name) + " holds a zero byte; remove it");
        }
        return text;
    }

    /// A string or a list of strings.
    Result<void> readTexts(const toml::node& node, std::string_view name,
                           std::vector<std::string>& texts) const {
        const toml::array* list = node.as_array();
        const std::size_t count = list == nullptr ? 1 : list->size();
        if (count > kRecipePatternsMax) {
            return failAt(node.source().begin, ErrorCode::kLimit,
                          std::string(name) + " lists more than " + std::to_string(kRecipePatternsMax) +
                              "; use patterns");
        }
        for (std::size_t i = 0; i < count; ++i) {
            std::string text = RELIEF_TRY(readText(list == nullptr ? node : *list->get(i), name, false));
            texts.push_back(std::move(text));
        }
        return {};
    }

    Result<void> readOption(const toml::node& node, const RecipeKey& key, RecipeOptions& options) const {
        RecipeValue value;
        value.place = place(node.source().begin);
        if (key.kind == FieldKind::kFlag) {
            if (!node.is_boolean()) {
                return invalid(node.source().begin, key.name + " must be true or false");
            }
            if (*node.value_exact<bool>()) {
                value.values.emplace_back();
            }
        } else if (key.kind == FieldKind::kList) {
            RELIEF_TRY(readTexts(node, key.name, value.values));
        } else {
            std::string text = RELIEF_TRY(readText(node, key.name, true));
            value.values.push_back(std::move(text));
        }
        options[key.name] = std::move(value);
        return {};
    }

    std::string file_;
    const std::vector<RecipeKey>& keys_;
};

}  // namespace

Result<std::vector<RecipeAsset>> parseRecipe(std::string_view text, const std::vector<RecipeKey>& keys,
                                             const fs::path& path) {
    // The name without its quotes, as a compiler writes it.
    const std::string quoted = quotedPath(path);
    return Reader(path == "-" ? "standard input" : quoted.substr(1, quoted.size() - 2), keys).read(text);
}

Result<std::vector<RecipeAsset>> loadRecipe(const fs::path& path, const std::vector<RecipeKey>& keys) {
    const auto bytes = RELIEF_TRY(readFile(path, kRecipeBytesMax));
    return parseRecipe({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, keys, path);
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
