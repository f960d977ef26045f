// [[spawn]] of a scene: births where particles hit or die. Keys, units, defaults, ranges: README.md beside this file.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/base/result.h"
#include "runtime/particles/spawner.h"

namespace relief {

struct SceneSpawn {
    SpawnSettings settings;
    std::uint64_t seed = 1;
    // Where the scene names types: resolveSpawnTypes() finds their indices. Origins are "scene.toml:3:8" of the keys.
    std::string of_name;
    std::string of_origin;
    std::string type_name;
    std::string type_origin;
    friend bool operator==(const SceneSpawn&, const SceneSpawn&) = default;
};

inline constexpr std::size_t kSpawnsMax = 16;
inline constexpr std::uint32_t kSpawnCountMax = 10'000;

/// Turns names of types into indices.
/// \param names  of the types there are, in order.
/// Errors: kInvalidInput, "file:line:column: …", for a name or an index that is not among them; where `names` is
/// empty, for a name alone.
[[nodiscard]] Result<void> resolveSpawnTypes(std::span<SceneSpawn> spawns,
                                             std::span<const std::string> names);

/// Spawner i draws from stream i of its seed, behind those of the emitters.
[[nodiscard]] std::vector<Spawner> makeSpawners(std::span<const SceneSpawn> spawns);

}  // namespace relief
