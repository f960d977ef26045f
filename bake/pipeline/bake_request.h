// SPDX-License-Identifier: Apache-2.0
// All options of a bake. The options of `relief bake`, the keys of recipes, the arguments of relief.bake() in Python
// and the provenance of a collider are derived from fields().
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/import/import_job.h"
#include "bake/maps/bake_maps.h"
#include "bake/repair/repair.h"
#include "bake/shape/shape.h"
#include "bake/views/map_spec.h"
#include "formats/base/result.h"
#include "formats/container_limits.h"
#include "formats/fields/text.h"

namespace relief {

inline constexpr std::uint64_t kBudgetDefault = 1'000'000;  ///< bytes; also used if no budget is recorded

enum class Holes : std::uint8_t { kClose, kKeep };
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<Holes>{"close", "keep"};

enum class MaterialMode : std::uint8_t { kKeep, kDrop };
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<MaterialMode>{"keep", "drop"};

enum class FrontBackDepth : std::uint8_t { kUnorm16, kHalf };
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<FrontBackDepth>{"unorm16", "half"};

template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<Decode>{"projected", "plane"};

struct BakeRequest {
    std::string mesh;              ///< a file
    std::vector<std::string> map;  ///< MapSpecs; empty: patches, unless `paper`, `animated` or Holes::kKeep
    std::optional<Decode> decode;  ///< of `map`
    std::optional<FrontBackDepth> depth;  ///< of `map`
    bool paper = false;
    std::optional<std::uint64_t> resolution;
    std::optional<std::uint64_t> budget;
    std::optional<float> texel;  ///< object units
    std::optional<float> max_error;
    std::optional<Quality> quality;
    std::optional<Prefer> prefer;
    std::optional<unsigned> threads;
    Holes holes = Holes::kClose;
    bool no_check = false;
    ImportOptions import;
    ImportLimits import_limits;
    RepairOptions repair;
    std::vector<std::string> as;
    std::optional<Thickness> thickness;
    std::optional<VoidMode> voids;
    std::optional<MaterialMode> materials;
    bool animated = false;
    std::vector<std::string> clips;  ///< files with additional clips for `animated`
    std::string heights;             ///< HeightsSpec if `mesh` is a height map; empty if it is a mesh
    std::optional<float> timeout;    ///< seconds; enforced by the caller, who can end the bake
    /// Object units: a box that the roots of patches contain in addition to the mesh. Not an option, and not recorded.
    std::optional<Bounds> roots_contain{};
};

void fields(FieldVisitor& visit, BakeRequest& request);

enum class MapSource : std::uint8_t { kPatches, kMaps, kPaper };

/// A request, parsed and validated.
struct BakeSettings {
    MapSource source = MapSource::kPatches;
    BakeOptions bake;
    ShapeOptions shape;  ///< without a thickness, which depends on the mesh
};

/// Returns the shape options without a thickness. Errors: those of parseShapeOptions.
[[nodiscard]] Result<ShapeOptions> shapeOptionsOf(const BakeRequest& request);

/// Validates the combination of fields. Errors: kUsage (two ways to select the maps, options without effect), those of
/// parseMapSpec, checkMapSize, parseShapeOptions and wrapAlpha.
[[nodiscard]] Result<BakeSettings> settingsOf(const BakeRequest& request);

/// A request as recorded in a container: the baked maps with their sizes, and everything else that affects the bytes.
struct RecordedBake {
    BakeRequest request;
    /// All options are known. If false, another version baked the collider, or the record is forged.
    bool understood = true;
};

[[nodiscard]] RecordedBake recordedBake(const std::vector<RecordedOption>& options);
/// Returns the recorded mode; kKeep if none is recorded: the mesh had no voids, or the baker's version ignored them.
[[nodiscard]] inline VoidMode voidsOf(const BakeRequest& recorded) {
    return recorded.voids.value_or(VoidMode::kKeep);
}

/// Returns a bake of a mesh as a command line, quoted for a shell.
[[nodiscard]] std::string commandLine(const BakeRequest& request, const std::string& output);
/// Returns the first import option that is set; empty if none is.
[[nodiscard]] std::string importOptionOf(const ImportOptions& options, const ImportLimits& limits);
/// Returns a path as a word of a command line.
[[nodiscard]] std::string shellWord(const std::string& path);

}  // namespace relief
