#include "bake/recipe/recipe_stamp.h"

#include <set>
#include <span>
#include <system_error>

#include "bake/recipe/depfile.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

fs::path realFolder(const fs::path& path) {
    std::error_code error;
    // A slash at the end would make another path of the same folder.
    return fs::weakly_canonical(fs::absolute(path / ".", error), error).lexically_normal() / "";
}

}  // namespace

Result<void> writeRecipeDepfile(const fs::path& path, const std::string& stamp,
                                const std::vector<std::string>& beside, const RecipeRun& run,
                                const std::vector<fs::path>& folders,
                                const std::vector<AssetResult>& assets) {
    const fs::path folder = recipeFolder(run.recipe);
    // As they were given, in their shortest form: as a build file has them.
    const auto name = [](const fs::path& file) { return file.lexically_normal().string(); };
    std::vector<std::string> targets;
    std::vector<std::string> inputs;
    if (run.recipe != "-") {
        inputs.push_back(name(run.recipe));
    }
    std::set<fs::path> written = {realFolder(run.output_folder)};
    for (const std::string& file : beside) {
        if (!file.empty()) {
            const fs::path parent = fs::path(file).parent_path();
            written.insert(realFolder(parent.empty() ? fs::path(".") : parent));
        }
    }
    for (const AssetResult& asset : assets) {
        targets.push_back(name(asset.job.output_path));
        written.insert(realFolder(asset.job.output_path.parent_path()));
        for (const InputFile& input : asset.inputs) {
            inputs.push_back(name(folder / input.path));
        }
    }
    for (const fs::path& searched : folders) {
        if (!written.contains(realFolder(searched))) {
            // "rocks/" and "rocks" are two files to Make.
            const fs::path normal = (searched / "").lexically_normal();
            inputs.push_back(normal == "./" || normal == "." ? "." : normal.parent_path().string());
        }
    }
    if (!stamp.empty()) {
        targets = {stamp};
    }
    // A shard may have nothing to do.
    return targets.empty() ? Result<void>() : writeDepfile(path, targets, inputs);
}

Result<void> writeRecipeStamp(const fs::path& path, const std::vector<AssetResult>& assets) {
    std::string text;
    for (const AssetResult& asset : assets) {
        text += asset.hash + "  " + cleanUtf8(asset.job.output) + "\n";
    }
    return writeFile(path, std::as_bytes(std::span(text)));
}

}  // namespace relief
