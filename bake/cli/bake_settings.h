// What `relief bake` is told, and what that means before the mesh is read.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/cli/backend.h"
#include "bake/cli/command.h"
#include "bake/cli/command_recipe.h"
#include "bake/cli/gl_options.h"
#include "bake/cli/import_options.h"
#include "bake/pipeline/bake.h"
#include "bake/repair/mesh_care.h"
#include "formats/container.h"

namespace relief {

/// The options of the verb, as they were written.
struct BakeCommand {
    CommonOptions common;
    std::string mesh;
    std::string output;
    std::vector<std::string> maps;
    bool paper = false;
    std::string plan;
    std::string plan_out;
    std::string budget;
    std::string max_error;
    std::string decode;
    std::string depth;
    std::string resolution;
    std::string quality;
    std::string prefer;
    std::string threads;
    std::string compress = "0";
    std::string holes = "close";
    BackendOptions backend;
    GlOptions gl;
    ImportArguments import;
    MeshCareOptions care;
    std::string depfile;
    RecipeOptionsOfBake recipe;
    bool json = false;
};

/// Who chooses the maps.
enum class MapSource : std::uint8_t { kPlanner, kMaps, kPaper, kPlanFile };

/// What they say.
struct BakeSettings {
    MapSource source = MapSource::kPlanner;
    BakeOptions bake;
    std::optional<std::uint64_t> budget;  ///< bytes of texels
    std::optional<double> max_error;      ///< percent
    ContainerWriteOptions write;
    std::optional<Quality> plan_quality;  ///< of the plan file
};

/// Errors: kUsage (a value out of range, two ways to choose the maps, options that do nothing together).
[[nodiscard]] Result<BakeSettings> settingsOf(const BakeCommand& command);

/// Whether every output can be written, and none is an input or another output.
[[nodiscard]] Result<void> preflight(const BakeCommand& command);

}  // namespace relief
