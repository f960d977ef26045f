#include "runtime/scene/scene_spawn.h"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "runtime/scene/scene_emitter.h"

namespace relief {
namespace {

/// \param type  the index that was given instead of a name.
Result<std::uint32_t> resolved(const std::string& key, const std::string& name, const std::string& origin,
                               std::uint32_t type, std::span<const std::string> names) {
    if (name.empty()) {
        if (!names.empty() && type >= names.size()) {
            return fail(ErrorCode::kInvalidInput, origin + ": " + key + " = " + std::to_string(type) +
                                                      " is none of the " + std::to_string(names.size()) +
                                                      " types; the first is 0");
        }
        return type;
    }
    const std::vector<std::string_view> known(names.begin(), names.end());
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
        const std::string hint = didYouMean(name, known);
        return fail(ErrorCode::kInvalidInput, origin + ": " + key + " = " +
                                                  quotedPath(std::filesystem::path(name)) + " is unknown" +
                                                  (hint.empty() ? "; name a type of this scene" : hint));
    }
    return static_cast<std::uint32_t>(found - known.begin());
}

}  // namespace

Result<void> resolveSpawnTypes(std::span<SceneSpawn> spawns, std::span<const std::string> names) {
    for (SceneSpawn& spawn : spawns) {
        SpawnSettings& s = spawn.settings;
        s.type = RELIEF_TRY(resolved("spawn.type", spawn.type_name, spawn.type_origin, s.type, names));
        if (s.of || !spawn.of_name.empty()) {
            s.of = RELIEF_TRY(resolved("spawn.of", spawn.of_name, spawn.of_origin, s.of.value_or(0), names));
        }
    }
    return {};
}

std::vector<Spawner> makeSpawners(std::span<const SceneSpawn> spawns) {
    std::vector<Spawner> made;
    for (const SceneSpawn& spawn : spawns) {
        made.emplace_back(spawn.settings, spawn.seed, kEmittersMax + made.size());
    }
    return made;
}

}  // namespace relief
