#include "runtime/scene/scene_spawn.h"

#include "runtime/scene/scene_emitter.h"

namespace relief {
Result<void> resolveSpawnTypes(std::span<SceneSpawn> spawns, std::span<const std::string> names) {
    for (SceneSpawn& spawn : spawns) {
        SpawnSettings& s = spawn.settings;
        s.type = RELIEF_TRY(resolvedType("spawn.type", spawn.type_name, spawn.type_origin, s.type, names));
        if (s.of || !spawn.of_name.empty()) {
            s.of =
                RELIEF_TRY(resolvedType("spawn.of", spawn.of_name, spawn.of_origin, s.of.value_or(0), names));
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
