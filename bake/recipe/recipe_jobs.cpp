// SPDX-License-Identifier: Apache-2.0
#include "bake/recipe/recipe_jobs.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <system_error>

#include "bake/recipe/glob.h"
#include "formats/base/file_io.h"
#include "formats/base/hash.h"
#include "formats/base/text.h"
#include "formats/config/confined_path.h"
#include "formats/world/world.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

/// The option whose values are input files.
constexpr const char* kFileOption = "clips";

tl::unexpected<Error> at(const RecipePlace& place, const std::string& message,
                         ErrorCode code = ErrorCode::kInvalidInput) {
    return fail(code, place + ": " + message);
}

/// Quotes a text on one line: x becomes 'x'.
std::string inQuotes(const std::string& text) {
    return "'" + cleanUtf8(text, 400) + "'";
}

/// Returns the first link in a folder that leads out of `root`, through which any file could be read.
/// \param inside  the folder, relative to `root`.
std::optional<std::string> escapingLink(const fs::path& root, const fs::path& inside) {
    std::set<std::string> out;
    std::error_code error;
    for (fs::directory_iterator entry(root / inside, error), end; !error && entry != end;
         entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        std::error_code unknown;
        if (entry->is_symlink(unknown) && !resolveInside(root, (inside / name).string())) {
            out.insert(name);
        }
    }
    return out.empty() ? std::nullopt : std::optional(*out.begin());
}

class Expander {
  public:
    Expander(fs::path folder, fs::path output_folder, FileGuard files)
        : folder_(std::move(folder)), output_folder_(std::move(output_folder)) {
        result_.files = std::move(files);
    }

    Result<void> add(const RecipeAsset& asset) {
        std::vector<std::string> meshes = RELIEF_TRY(meshesOf(asset));
        RecipeOptions opened = asset.options;
        if (const auto found = opened.find(kFileOption); found != opened.end()) {
            for (std::string& value : found->second.values) {
                const Result<fs::path> path = resolveInside(folder_, value, "recipe");
                if (!path) {
                    return at(found->second.place, found->first + " " + path.error().message);
                }
                inputs_.push_back(*path);
                value = path->string();
            }
        }
        const std::vector<std::string> arguments = recipeArguments(opened);
        std::vector<std::string> options = recipeArguments(asset.options);
        if (asset.isWorld()) {
            options.insert(std::ranges::lower_bound(options, kWorldOption), kWorldOption);
        }
        for (const std::string& mesh : meshes) {
            if (result_.jobs.size() == kRecipeJobsMax) {
                return at(asset.place,
                          "more than " + std::to_string(kRecipeJobsMax) + " meshes; use several recipes",
                          ErrorCode::kLimit);
            }
            RELIEF_TRY(addJob(asset, mesh, arguments, options));
        }
        return {};
    }

    /// Checks that no output is an input, or another output under a different name.
    Result<RecipeJobs> finish(const fs::path& recipe) {
        FileGuard& files = result_.files;
        RELIEF_TRY(files.reads(recipe));
        for (const fs::path& input : inputs_) {
            RELIEF_TRY(files.reads(input));
        }
        for (std::size_t i = 0; i < result_.jobs.size(); ++i) {
            const RecipeJob& job = result_.jobs[i];
            const auto other = files.claim(job.output_path, bakeOf(job));
            if (other && other->use == FileGuard::Use::kRead) {
                return at(places_[i], "the output " + inQuotes(job.output) + " is the input " +
                                          quotedPath(other->path) + "; name another file");
            }
            if (other) {
                return at(places_[i], other->option + " and " + bakeOf(job) + " would both write " +
                                          inQuotes(job.output) + "; use {stem}, {name} or {dir} in output");
            }
        }
        RELIEF_TRY(keepWorldsApart());
        std::sort(result_.folders.begin(), result_.folders.end());
        result_.folders.erase(std::unique(result_.folders.begin(), result_.folders.end()),
                              result_.folders.end());
        return std::move(result_);
    }

  private:
    /// Checks that no other output is in or below the folder of a world: its bake removes containers that it no longer
    /// references, and names new containers by their contents.
    Result<void> keepWorldsApart() {
        if (std::ranges::none_of(result_.jobs, &RecipeJob::world)) {
            return {};
        }
        std::map<fs::path, std::size_t> worlds;  // job indices by folder
        std::vector<fs::path> folders;           // of all outputs
        for (std::size_t i = 0; i < result_.jobs.size(); ++i) {
            const RecipeJob& job = result_.jobs[i];
            std::error_code error;
            folders.push_back(destination(job.output_path.parent_path(), error));
            if (job.world) {
                worlds.emplace(folders.back(), i);
            }
        }
        for (std::size_t i = 0; i < folders.size(); ++i) {
            for (fs::path folder = folders[i];; folder = folder.parent_path()) {
                const auto found = worlds.find(folder);
                if (found != worlds.end() && found->second != i) {
                    return at(places_[i], "the output " + inQuotes(result_.jobs[i].output) +
                                              " is in the folder of the world " +
                                              inQuotes(result_.jobs[found->second].output) +
                                              ", which must not contain other outputs; use another folder");
                }
                if (!folder.has_relative_path()) {
                    break;
                }
            }
        }
        for (const auto& [folder, i] : worlds) {
            RELIEF_TRY(checkWorldFolder(result_.jobs[i], places_[i]));
        }
        return {};
    }

    Result<void> checkWorldFolder(const RecipeJob& job, const RecipePlace& place) {
        const auto owned = reserveWorldFolder(job.output_path.parent_path(), bakeOf(job), result_.files);
        return owned ? Result<void>() : at(place, owned.error().message);
    }

    static std::string bakeOf(const RecipeJob& job) { return "the bake of " + inQuotes(job.mesh); }

    /// \param key  of the pattern in the recipe
    static Result<GlobPattern> patternOf(const std::string& key, const std::string& text,
                                         const RecipePlace& place) {
        Result<GlobPattern> pattern = GlobPattern::parse(text);
        if (!pattern) {
            return at(place, key + " " + inQuotes(text) + " " + pattern.error().message,
                      pattern.error().code);
        }
        return pattern;
    }

    /// Returns the files that match the patterns, without duplicates and excluded files.
    Result<std::vector<std::string>> meshesOf(const RecipeAsset& asset) {
        std::vector<GlobPattern> excluded;
        for (const std::string& text : asset.exclude) {
            excluded.push_back(RELIEF_TRY(patternOf("exclude", text, asset.place)));
        }
        std::vector<std::string> meshes;
        bool of_folders = false;
        std::set<std::string> seen;
        for (const std::string& text : asset.meshes) {
            const GlobPattern pattern = RELIEF_TRY(patternOf("mesh", text, asset.mesh_place));
            const Result<GlobResult> found = globFiles(folder_, pattern);
            if (!found) {
                return at(asset.mesh_place, "mesh " + inQuotes(text) + ": " + found.error().message,
                          found.error().code);
            }
            of_folders = of_folders || pattern.ofFolders();
            if (pattern.ofFolders() && !asset.isWorld()) {
                return at(asset.mesh_place,
                          "mesh " + inQuotes(text) +
                              " matches folders, which are levels; write */* for the files in "
                              "them, or end output in /world.json");
            }
            if (found->files.empty() && !asset.optional) {
                std::error_code error;
                const bool folder = !pattern.ofFolders() && fs::is_directory(folder_ / text, error);
                return at(asset.mesh_place, "mesh " + inQuotes(text) + " matches no " +
                                                (pattern.ofFolders() ? "folder" : "file") + " in " +
                                                quotedPath(folder_) +
                                                (folder ? "; it is a folder: append / to bake it as a level"
                                                        : "; correct it, or set optional = true"));
            }
            for (const std::string& mesh : found->files) {
                const bool out = std::any_of(excluded.begin(), excluded.end(),
                                             [&](const GlobPattern& e) { return e.matches(mesh); });
                if (!out && seen.insert(mesh).second) {
                    meshes.push_back(mesh);
                }
            }
            if (pattern.wild()) {
                for (const std::string& folder : found->folders) {
                    result_.folders.push_back(folder.empty() ? folder_ : folder_ / folder);
                }
            }
        }
        for (std::size_t i = 0; i < excluded.size(); ++i) {
            if (excluded[i].ofFolders() && !of_folders) {
                return at(asset.place,
                          "exclude " + inQuotes(asset.exclude[i]) +
                              " matches folders, but mesh matches files; write **/* for the files in "
                              "them");
            }
        }
        return meshes;
    }

    Result<void> addJob(const RecipeAsset& asset, const std::string& mesh,
                        const std::vector<std::string>& arguments, const std::vector<std::string>& options) {
        RecipeJob job;
        job.mesh = mesh;
        const Result<fs::path> path = resolveInside(folder_, mesh, "recipe");
        if (!path) {
            return at(asset.mesh_place, "mesh " + path.error().message);
        }
        job.mesh_path = *path;
        std::error_code error;
        job.mesh_is_folder = fs::is_directory(*path, error);
        if (job.mesh_is_folder) {
            if (const auto link = escapingLink(folder_, mesh)) {
                return at(asset.mesh_place, "mesh " + inQuotes(mesh) + " contains the link " +
                                                inQuotes(*link) +
                                                ", which points outside the recipe's folder; remove it");
            }
        }
        job.output = RELIEF_TRY(outputOf(asset, mesh, job.mesh_is_folder));
        job.world = asset.isWorld();
        if (!resolveInside(output_folder_, job.output)) {
            return at(asset.output_place, "the output " + inQuotes(job.output) +
                                              " is outside the output folder " + quotedPath(output_folder_) +
                                              "; name a file inside it");
        }
        job.output_path = output_folder_ / job.output;
        job.arguments = arguments;
        job.options = options;
        inputs_.push_back(job.mesh_path);
        result_.jobs.push_back(std::move(job));
        places_.push_back(asset.output_place);
        return {};
    }

    /// Returns the normalized name of the output for a mesh.
    static Result<std::string> outputOf(const RecipeAsset& asset, const std::string& mesh, bool is_folder) {
        const fs::path path(mesh);
        std::string name;
        for (std::size_t i = 0; i < asset.output.size(); ++i) {
            const char c = asset.output[i];
            if (c == '}') {
                return at(asset.output_place, "output contains a } without a {; use {stem}, {name} or {dir}");
            }
            if (c != '{') {
                name += c;
                continue;
            }
            const std::size_t end = asset.output.find('}', i);
            const std::string word =
                asset.output.substr(i + 1, end == std::string::npos ? std::string::npos : end - i - 1);
            if (word == "stem") {
                name += (is_folder ? path.filename() : path.stem()).string();
            } else if (word == "name") {
                name += path.filename().string();
            } else if (word == "dir") {
                name += path.has_parent_path() ? path.parent_path().string() : ".";
            } else {
                return at(asset.output_place, "output contains the unknown {" + cleanUtf8(word, 80) +
                                                  "}; use {stem}, {name} or {dir}");
            }
            i = end;
        }
        if (name.find('\0') != std::string::npos || fs::path(name).is_absolute()) {
            return at(asset.output_place, "the output " + inQuotes(name) +
                                              " must be a relative path; set the folder with --output");
        }
        name = fs::path(name).lexically_normal().string();
        const fs::path file = fs::path(name).filename();
        if (asset.isWorld() ? file != kWorldFileName
                            : !name.ends_with(kColliderExtension) || file == kColliderExtension) {
            return at(asset.output_place, "the output " + inQuotes(name) +
                                              " must end in .relief, or in /world.json for a level: a recipe "
                                              "writes nothing else");
        }
        return name;
    }

    fs::path folder_;
    fs::path output_folder_;
    RecipeJobs result_;
    std::vector<RecipePlace> places_;  // of the outputs of the jobs
    std::vector<fs::path> inputs_;
};

}  // namespace

Result<void> reserveWorldFolder(const fs::path& folder, std::string_view option, FileGuard& files) {
    RELIEF_TRY(files.writes(FilesByEnding{folder, std::string(kColliderExtension)}, option));
    RELIEF_TRY(files.keeps(folder / kBakeCacheName, option));
    return files.keeps(folder / kErrorCurvesName, option);
}

fs::path recipeFolder(const fs::path& recipe) {
    return recipe == "-" || !recipe.has_parent_path() ? fs::path(".") : recipe.parent_path();
}

Result<RecipeJobs> recipeJobs(const std::vector<RecipeAsset>& assets, const fs::path& recipe,
                              const fs::path& output_folder, FileGuard files) {
    const fs::path folder = recipeFolder(recipe);
    Expander expander(folder, output_folder.empty() ? folder : output_folder, std::move(files));
    for (const RecipeAsset& asset : assets) {
        RELIEF_TRY(expander.add(asset));
    }
    return expander.finish(recipe);
}

bool inShard(const std::string& output, const Shard& shard) {
    return xxh3_64(std::as_bytes(std::span(output))) % shard.count == shard.index - 1;
}

}  // namespace relief
