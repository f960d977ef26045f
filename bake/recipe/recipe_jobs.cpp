#include "bake/recipe/recipe_jobs.h"

#include <algorithm>
#include <array>
#include <set>
#include <span>

#include "bake/recipe/glob.h"
#include "formats/base/file_io.h"
#include "formats/base/hash.h"
#include "formats/base/text.h"
#include "formats/config/confined_path.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

/// Options whose value is a file to be read.
constexpr std::array<std::string_view, 2> kFileOptions = {"plan", "clips"};

tl::unexpected<Error> at(const RecipePlace& place, const std::string& message,
                         ErrorCode code = ErrorCode::kInvalidInput) {
    return fail(code, place + ": " + message);
}

/// "x" -> "'x'", on one line.
std::string inQuotes(const std::string& text) {
    return "'" + cleanUtf8(text, 400) + "'";
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
        for (const std::string_view name : kFileOptions) {
            const auto found = opened.find(std::string(name));
            if (found == opened.end()) {
                continue;
            }
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
        const std::vector<std::string> options = recipeArguments(asset.options);
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

    /// Once all are known: no output may be an input, or another output under another name.
    Result<RecipeJobs> finish(const fs::path& recipe) {
        FileGuard& files = result_.files;
        RELIEF_TRY(files.reads(recipe));
        for (const fs::path& input : inputs_) {
            RELIEF_TRY(files.reads(input));
        }
        for (std::size_t i = 0; i < result_.jobs.size(); ++i) {
            const RecipeJob& job = result_.jobs[i];
            const FileGuard::File* other = files.claim(job.output_path, job.mesh);
            if (other != nullptr && other->input) {
                return at(places_[i], "the output " + inQuotes(job.output) + " is the input " +
                                          quotedPath(other->path) + "; name another file");
            }
            if (other != nullptr) {
                return at(places_[i], inQuotes(other->option) + " and " + inQuotes(job.mesh) +
                                          " would both be baked into " + inQuotes(job.output) +
                                          "; tell them apart by {stem}, {name} or {dir}");
            }
        }
        std::sort(result_.folders.begin(), result_.folders.end());
        result_.folders.erase(std::unique(result_.folders.begin(), result_.folders.end()),
                              result_.folders.end());
        return std::move(result_);
    }

  private:
    /// The files of all patterns, each once, without the excluded ones.
    Result<std::vector<std::string>> meshesOf(const RecipeAsset& asset) {
        std::vector<GlobPattern> excluded;
        for (const std::string& text : asset.exclude) {
            Result<GlobPattern> pattern = GlobPattern::parse(text);
            if (!pattern) {
                return at(asset.place, "exclude " + inQuotes(text) + " " + pattern.error().message,
                          pattern.error().code);
            }
            excluded.push_back(std::move(*pattern));
        }
        std::vector<std::string> meshes;
        std::set<std::string> seen;
        for (const std::string& text : asset.meshes) {
            const Result<GlobPattern> pattern = GlobPattern::parse(text);
            if (!pattern) {
                return at(asset.mesh_place, "mesh " + inQuotes(text) + " " + pattern.error().message,
                          pattern.error().code);
            }
            const Result<GlobResult> found = globFiles(folder_, *pattern);
            if (!found) {
                return at(asset.mesh_place, "mesh " + inQuotes(text) + ": " + found.error().message,
                          found.error().code);
            }
            if (found->files.empty() && !asset.optional) {
                return at(asset.mesh_place, "mesh " + inQuotes(text) + " matches no file in " +
                                                quotedPath(folder_) + "; mend it, or set optional = true");
            }
            for (const std::string& mesh : found->files) {
                const bool out = std::any_of(excluded.begin(), excluded.end(),
                                             [&](const GlobPattern& e) { return e.matches(mesh); });
                if (!out && seen.insert(mesh).second) {
                    meshes.push_back(mesh);
                }
            }
            if (pattern->wild()) {
                for (const std::string& folder : found->folders) {
                    result_.folders.push_back(folder.empty() ? folder_ : folder_ / folder);
                }
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
        std::string output = RELIEF_TRY(outputOf(asset, mesh));
        job.output = std::move(output);
        if (!resolveInside(output_folder_, job.output)) {
            return at(asset.output_place, "the output " + inQuotes(job.output) +
                                              " leads out of the output folder " +
                                              quotedPath(output_folder_) + "; name a file in it");
        }
        job.output_path = output_folder_ / job.output;
        job.arguments = arguments;
        job.options = options;
        inputs_.push_back(job.mesh_path);
        result_.jobs.push_back(std::move(job));
        places_.push_back(asset.output_place);
        return {};
    }

    /// The output's name for a mesh, in its shortest form.
    static Result<std::string> outputOf(const RecipeAsset& asset, const std::string& mesh) {
        const fs::path path(mesh);
        std::string name;
        for (std::size_t i = 0; i < asset.output.size(); ++i) {
            const char c = asset.output[i];
            if (c == '}') {
                return at(asset.output_place, "output has a } without {; use {stem}, {name} or {dir}");
            }
            if (c != '{') {
                name += c;
                continue;
            }
            const std::size_t end = asset.output.find('}', i);
            const std::string word =
                asset.output.substr(i + 1, end == std::string::npos ? std::string::npos : end - i - 1);
            if (word == "stem") {
                name += path.stem().string();
            } else if (word == "name") {
                name += path.filename().string();
            } else if (word == "dir") {
                name += path.has_parent_path() ? path.parent_path().string() : ".";
            } else {
                return at(asset.output_place,
                          "output has {" + cleanUtf8(word, 80) + "}, but known are {stem}, {name} and {dir}");
            }
            i = end;
        }
        if (name.find('\0') != std::string::npos || fs::path(name).is_absolute()) {
            return at(asset.output_place, "the output " + inQuotes(name) +
                                              " must be a relative path; choose the folder by --output");
        }
        name = fs::path(name).lexically_normal().string();
        if (!name.ends_with(kColliderExtension) || fs::path(name).filename() == kColliderExtension) {
            return at(asset.output_place,
                      "the output " + inQuotes(name) + " must end in .relief: a recipe writes nothing else");
        }
        return name;
    }

    fs::path folder_;
    fs::path output_folder_;
    RecipeJobs result_;
    std::vector<RecipePlace> places_;  // of the jobs' outputs
    std::vector<fs::path> inputs_;
};

}  // namespace

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
