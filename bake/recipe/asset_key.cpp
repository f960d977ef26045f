#include "bake/recipe/asset_key.h"

#include <algorithm>
#include <span>

#include "formats/base/hash.h"

namespace relief {

std::string assetKey(const std::string& tool, const std::vector<std::string>& options,
                     std::vector<InputFile> inputs) {
    std::sort(inputs.begin(), inputs.end(),
              [](const InputFile& a, const InputFile& b) { return a.path < b.path; });
    // Each part behind its length, so that no two lists give one text.
    std::string text;
    const auto add = [&](const std::string& part) { text += std::to_string(part.size()) + ":" + part; };
    add(tool);
    add(std::to_string(options.size()));
    std::for_each(options.begin(), options.end(), add);
    for (const InputFile& input : inputs) {
        add(input.path);
        add(input.hash);
    }
    return xxh3_128Hex(std::as_bytes(std::span(text)));
}

std::string nameInRecipe(const std::filesystem::path& file, const std::filesystem::path& recipe_folder) {
    const std::filesystem::path inside =
        file.lexically_normal().lexically_relative(recipe_folder.lexically_normal());
    return inside.empty() ? file.string() : inside.string();
}

}  // namespace relief
