#include <algorithm>
#include <limits>
#include <string>

#include "runtime/particles/particle_system.h"
#include "runtime/scene/scene_readers.h"
#include "runtime/scene/scene_spawn.h"

namespace relief {
namespace {

constexpr double kSeedMax = 9007199254740992.0;
constexpr double kShareMax = 1000.0;

void readCount(SceneTable& table, SpawnSettings& settings) {
    const toml::node* node = table.find("count");
    if (node == nullptr) {
        return;
    }
    const SceneSpan span =
        table.spanOf(*node, "count", {1.0, kSpawnCountMax}, "a whole number, or two [least, most]");
    settings.count_min = static_cast<std::uint32_t>(span.least);
    settings.count_max = static_cast<std::uint32_t>(span.most);
    if (span.least != static_cast<double>(settings.count_min) ||
        span.most != static_cast<double>(settings.count_max)) {
        table.wrongType(*node, "count", "a whole number, or two [least, most]");
    }
}

void readMotion(SceneTable& table, SpawnSettings& settings) {
    table.number("inherit", {0.0, kShareMax}, settings.inherit);
    if (const toml::node* node = table.find("speed"); node != nullptr) {
        const SceneSpan span =
            table.spanOf(*node, "speed", {0.0, kSpeedMax}, "a number, or two [least, most]");
        settings.speed_min = static_cast<float>(span.least);
        settings.speed_max = static_cast<float>(span.most);
    }
    table.number("kick", {0.0, kShareMax}, settings.kick);
    settings.cone_degrees = settings.on == SpawnOn::kCollision ? 60.0F : 180.0F;
    if (table.number("cone", {0.0, 180.0}, settings.cone_degrees) && settings.speed_max == 0.0F &&
        settings.kick == 0.0F) {
        table.failUseless("cone", "without spawn.speed and spawn.kick; say how fast, or remove it");
    }
}

SceneSpawn readSpawn(SceneTable& table, const toml::source_position& at) {
    SceneSpawn spawn;
    SpawnSettings& settings = spawn.settings;
    if (!table.word("on", {"collision", "death"}, settings.on)) {
        table.failAt(at, "spawn.on is missing; choose \"collision\" or \"death\"");
    }
    readTypeOf(table, "of", settings.of, spawn.of_name, spawn.of_origin);
    readTypeOf(table, "type", settings.type, spawn.type_name, spawn.type_origin);
    if (table.number("min_speed", {0.0, kSpeedMax}, settings.min_speed) && settings.on == SpawnOn::kDeath) {
        table.failUseless("min_speed", "for spawn.on = \"death\"; remove it");
    }
    readCount(table, settings);
    table.integer("most", {1.0, ParticleSystem::kCapacityMax}, settings.most);
    readMotion(table, settings);
    if (const toml::node* node = table.find("lifetime"); node != nullptr) {
        const SceneSpan span = table.spanOf(*node, "lifetime", {0.0, kSecondsMax, false},
                                            "a number of seconds, or two [least, most]");
        const auto positive = [](double value) {
            return std::max(static_cast<float>(value), std::numeric_limits<float>::min());
        };
        settings.lifetime_min = positive(span.least);
        settings.lifetime_max = positive(span.most);
    }
    table.integer("seed", {0.0, kSeedMax}, spawn.seed);
    table.finish();
    return spawn;
}

}  // namespace

std::vector<SceneSpawn> readSpawns(SceneTable& top, std::string_view file) {
    std::vector<SceneSpawn> spawns;
    for (const toml::table* one : top.tables("spawn", kSpawnsMax)) {
        SceneTable table(one, "spawn", file);
        spawns.push_back(readSpawn(table, one->source().begin));
    }
    return spawns;
}

}  // namespace relief
