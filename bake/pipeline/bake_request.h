// SPDX-License-Identifier: Apache-2.0
// All that decides what a bake makes, and how it goes about it. The options of `relief bake`, the keys of recipes, the
// arguments of relief.bake() in Python and the provenance of a collider are derived from fields().
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/import/import_fields.h"
#include "bake/maps/bake_maps.h"
#include "bake/repair/repair.h"
#include "bake/shape/shape.h"
#include "bake/views/map_spec.h"
#include "bake/views/prefer.h"
#include "formats/base/result.h"
#include "formats/container_limits.h"
#include "formats/fields/text.h"

namespace relief {

inline constexpr std::uint64_t kBudgetDefault = 1'000'000;  ///< bytes; where none is recorded too

enum class Holes : std::uint8_t { kClose, kKeep };
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<Holes>{"close", "keep"};

enum class MaterialsAs : std::uint8_t { kKeep, kNone };
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<MaterialsAs>{"keep", "none"};

enum class FrontBackDepth : std::uint8_t { kUnorm16, kHalf };
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<FrontBackDepth>{"unorm16", "half"};

template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<Decode>{"projected", "plane"};

struct BakeRequest {
    std::string mesh;                     ///< a file
    std::vector<std::string> map;         ///< MapSpecs; empty: patches, unless paper, animated or holes
    std::optional<Decode> decode;         ///< of `map`
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
    std::optional<VoidsAs> voids;
    std::optional<MaterialsAs> materials;
    bool animated = false;
    std::vector<std::string> clips;   ///< files, beside `mesh`, of `animated`
    std::string heights;              ///< HeightsSpec: `mesh` is a height map; empty: it is a mesh
    std::optional<float> time_limit;  ///< seconds; kept by the caller, who can end the bake
    /// Object units: a box that the roots of patches hold beside the mesh. No option; it is not recorded.
    std::optional<Bounds> roots_hold{};
};

void fields(FieldVisitor& visit, BakeRequest& request);

enum class MapSource : std::uint8_t { kPatches, kMaps, kPaper };

/// A request, read and found consistent.
struct BakeSettings {
    MapSource source = MapSource::kPatches;
    BakeOptions bake;
    ShapeOptions shape;  ///< without a thickness: it depends on the mesh
};

/// The rules across fields. Fails with kUsage for two ways to choose the maps, and for options that do nothing together; as
/// parseMapSpec, checkMapSize, parseShapeOptions and wrapAlpha.
[[nodiscard]] Result<BakeSettings> settingsOf(const BakeRequest& request);

/// A request as a container records it: the maps that were baked, with their sizes, and all else that the bytes depend on.
struct RecordedBake {
    BakeRequest request;
    /// Every option is known; otherwise another version baked it, or the record is made up.
    bool understood = true;
};

[[nodiscard]] RecordedBake recordedBake(const std::vector<RecordedOption>& options);
/// Hollow where the record says nothing: there were none, or they were no part of the shape yet.
[[nodiscard]] inline VoidsAs voidsOf(const BakeRequest& recorded) {
    return recorded.voids.value_or(VoidsAs::kHollow);
}

/// A bake of a mesh as a command line, quoted for a shell.
[[nodiscard]] std::string commandLine(const BakeRequest& request, const std::string& output);
/// The first option about the import that is set; empty: none.
[[nodiscard]] std::string importOptionOf(const ImportOptions& options, const ImportLimits& limits);
/// A path as a word of a command line.
[[nodiscard]] std::string shellWord(const std::string& path);

}  // namespace relief
