// What `relief bake` is told, and what that means before the mesh is read.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/cli/backend.h"
#include "bake/cli/command.h"
#include "bake/cli/command_recipe.h"
#include "bake/cli/import_options.h"
#include "bake/pipeline/bake.h"
#include "bake/plan/view_planner.h"
#include "bake/repair/mesh_care.h"
#include "bake/shape/shape.h"
#include "formats/container.h"

namespace relief {

inline constexpr std::uint64_t kBudgetDefault = 1'000'000;  ///< bytes; where none is recorded too

enum class Holes : std::uint8_t { kClose, kKeep };

/// The options of the verb.
struct BakeCommand {
    CommonOptions common;
    std::string mesh;
    std::string output;
    std::vector<std::string> maps;
    bool paper = false;
    std::string plan;
    std::string plan_out;
    std::optional<std::uint64_t> budget;  ///< bytes of texels
    std::optional<float> max_error;       ///< percent
    std::uint32_t max_maps = kPlannedMapsMax;
    std::optional<Decode> decode;
    std::optional<MapFormat> depth;  ///< kFrontBackHalf or kFrontBackFixed
    std::optional<std::uint64_t> resolution;
    std::optional<Quality> quality;
    std::optional<Prefer> prefer;
    std::optional<unsigned> threads;
    int compress = 0;  ///< zstd's level; 0: none
    Holes holes = Holes::kClose;
    bool no_check = false;
    std::vector<std::string> as;
    std::optional<float> thickness;  ///< of shells, object units
    BackendChoice backend = BackendChoice::kRaycast;
    GpuOptions gpu;
    std::optional<float> time_limit;  ///< seconds
    ImportSettings import;
    MeshCareOptions care;
    std::string depfile;
    RecipeOptionsOfBake recipe;
    bool json = false;
};

/// Adds the options to the verb. `command` must outlive it.
void addBakeOptions(CLI::App& verb, BakeCommand& command);

/// Who chooses the maps.
enum class MapSource : std::uint8_t { kPlanner, kMaps, kPaper, kPlanFile };

/// What they say.
struct BakeSettings {
    MapSource source = MapSource::kPlanner;
    BakeOptions bake;
    ShapeOptions shape;  ///< without a thickness: it depends on the mesh
    ContainerWriteOptions write;
    std::optional<Quality> plan_quality;  ///< of the plan file
};

/// Fails with kUsage for two ways to choose the maps, and for options that do nothing together; as parseMapSpec,
/// checkMapSize and parseShapeOptions.
[[nodiscard]] Result<BakeSettings> settingsOf(const BakeCommand& command);

/// Whether every output can be written, and none is an input or another output.
[[nodiscard]] Result<void> preflight(const BakeCommand& command, FileGuard& files);

}  // namespace relief
