#include "bake/cli/recipe_keys.h"

#include <algorithm>
#include <optional>
#include <string>

#include "bake/import/import_format.h"
#include "bake/import/mesh_import.h"
#include "bake/recipe/asset_key.h"
#include "formats/base/text.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPlan = "--plan=";

/// The mesh and all that it refers to; nullopt if that cannot be read.
std::optional<std::vector<InputFile>> filesOfMesh(const RecipeJob& job, const fs::path& folder) {
    const std::string extension = job.mesh_path.extension().string();
    const MeshFormat* const format = extension.empty() ? nullptr : meshFormat(extension.substr(1));
    if (format != nullptr && format->whole) {
        const std::optional<std::string> hash = hashOfFile(job.mesh_path);
        return hash ? std::optional(std::vector<InputFile>{{job.mesh, *hash}}) : std::nullopt;
    }
    const Result<TriangleMesh> mesh = importMeshInWorker(job.mesh_path);
    if (!mesh) {
        return std::nullopt;
    }
    std::vector<InputFile> files;
    for (std::size_t i = 0; i < mesh->dependencies.size(); ++i) {
        files.push_back(
            {i == 0 ? job.mesh : nameInRecipe(mesh->dependencies[i], folder), mesh->dependency_hashes[i]});
    }
    return files;
}

std::optional<std::string> keyOf(const RecipeJob& job, const std::string& tool, const fs::path& folder) {
    std::optional<std::vector<InputFile>> files = filesOfMesh(job, folder);
    for (const std::string& argument : job.arguments) {
        if (files && argument.starts_with(kPlan)) {
            const fs::path plan = argument.substr(kPlan.size());
            const std::optional<std::string> hash = hashOfFile(plan);
            if (!hash) {
                return std::nullopt;
            }
            files->push_back({nameInRecipe(plan, folder), *hash});
        }
    }
    return files ? std::optional(assetKey(tool, job.options, std::move(*files))) : std::nullopt;
}

}  // namespace

Result<void> addKeys(std::vector<AssetResult>& assets, const RecipeRun& run) {
    const std::string tool = RELIEF_TRY(toolIdentity());
    const fs::path folder = recipeFolder(run.recipe);
    for (AssetResult& asset : assets) {
        if (asset.key.empty()) {
            asset.key = keyOf(asset.job, tool, folder).value_or("");
        }
    }
    return {};
}

}  // namespace relief
