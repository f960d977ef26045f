// SPDX-License-Identifier: Apache-2.0
#include "formats/world/world.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "formats/base/file_io.h"
#include "formats/base/hash.h"
#include "formats/base/text.h"
#include "formats/config/confined_path.h"
#include "formats/container.h"
#include "formats/container_reader.h"
#include "formats/fields/json.h"
#include "formats/fields/json_reader.h"
#include "formats/fields/json_value.h"
#include "formats/fields/strict_json.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

/// A body has 15 values, a collider has 17.
constexpr std::size_t kValuesMax = 20 * (kWorldBodiesMax + kWorldCollidersMax) + 100;
constexpr std::size_t kDepthMax = 8;
/// Tolerance for the length of a rotation that is written with few decimals.
constexpr double kUnitTolerance = 1e-3;
constexpr const char* kBakeAgain = "; bake the level again";

std::string placeOf(const char* list, std::size_t i) {
    return std::string(list) + "[" + std::to_string(i) + "]";
}

/// \param files  files of the preceding colliders.
Result<void> checkFile(const WorldFile& file, const std::string& place, std::set<std::string>& files) {
    if (!isHash(file.hash)) {
        return invalidInput(place + ".hash must be 32 digits of 0 to 9 and a to f" + kBakeAgain);
    }
    if (file.file.find('\0') != std::string::npos) {
        return invalidInput(place + ".file contains a zero byte; remove it");
    }
    const fs::path path(file.file);
    if (file.file.empty() || path.is_absolute() || std::find(path.begin(), path.end(), "..") != path.end()) {
        return invalidInput(place + ".file = " + quotedPath(path) +
                            " must be a path inside the world's folder; move the file there");
    }
    if (!files.insert(path.lexically_normal().string()).second) {
        return invalidInput(
            place + ".file = " + quotedPath(path) +
            " is also used by another collider; list each file once, and place it with bodies");
    }
    return {};
}

Result<void> checkColliders(const std::vector<WorldCollider>& colliders) {
    std::set<std::string> files;
    for (std::size_t i = 0; i < colliders.size(); ++i) {
        const WorldCollider& collider = colliders[i];
        const std::string place = placeOf("colliders", i);
        RELIEF_TRY(checkFile(collider, place, files));
        if (collider.coarse) {
            RELIEF_TRY(checkFile(*collider.coarse, place + ".coarse", files));
        }
        for (int axis = 0; axis < 3; ++axis) {
            if (!(collider.box.min[axis] <= collider.box.max[axis])) {
                return invalidInput(place + ".min is above its max; swap them");
            }
        }
    }
    return {};
}

Result<void> checkBodies(World& world) {
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        WorldBody& body = world.bodies[i];
        if (body.collider >= world.colliders.size()) {
            return invalidInput(placeOf("bodies", i) + ".collider = " + std::to_string(body.collider) +
                                " is not one of the " + std::to_string(world.colliders.size()) +
                                " colliders; the first is 0");
        }
        double square = 0.0;
        for (const float part : body.rotation) {
            square += double{part} * double{part};
        }
        const double length = std::sqrt(square);
        if (!(std::abs(length - 1.0) <= kUnitTolerance)) {
            return invalidInput(placeOf("bodies", i) + ".rotation is not a unit quaternion: its length is " +
                                shortest(static_cast<float>(length)) + "; normalize it, or use [0, 0, 0, 1]");
        }
        for (float& part : body.rotation) {
            part = static_cast<float>(double{part} / length);
        }
    }
    return {};
}

/// Call it before reading the fields, which differ between versions.
Result<void> checkVersion(const nlohmann::json& json) {
    if (!json.is_object() || !json.contains("format") || json["format"] != kWorldFormat) {
        return invalidInput("it is not a world: its format is not \"" + std::string(kWorldFormat) +
                            "\"; name a world.json that relief bake --world wrote");
    }
    const auto version = json.find("version");
    if (version != json.end() && version->is_number_unsigned() &&
        version->get<std::uint64_t>() > kWorldVersion) {
        return fail(ErrorCode::kUnsupported, "version " + std::to_string(version->get<std::uint64_t>()) +
                                                 " is newer than this program, which reads version " +
                                                 std::to_string(kWorldVersion) + "; use a newer Relief");
    }
    return {};
}

std::string placeOf(const World& world, std::size_t collider, WorldDetail detail) {
    const bool coarse = detail == WorldDetail::kCoarse && world.colliders[collider].coarse;
    return placeOf("colliders", collider) + (coarse ? ".coarse" : "");
}

/// Returns the path of a container; links may not leave the world's folder.
Result<fs::path> pathOf(const World& world, std::size_t collider, WorldDetail detail,
                        const fs::path& folder) {
    return withPrefix(placeOf(world, collider, detail) + ".file",
                      resolveInside(folder, fileOf(world.colliders[collider], detail).file, "world"));
}

template <class T>
void appendLines(std::string& text, const char* name, const std::vector<T>& all) {
    text += std::string("  \"") + name + "\": [";
    for (std::size_t i = 0; i < all.size(); ++i) {
        const std::string line = jsonLineOf(all[i]);
        text += (i == 0 ? "\n    " : ",\n    ") + line.substr(0, line.size() - 1);
    }
    text += "\n  ]";
}

}  // namespace

std::vector<std::size_t> findBodies(const World& world, std::string_view node) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        if (world.bodies[i].node == node) {
            found.push_back(i);
        }
    }
    return found;
}

Pose poseOf(const WorldBody& body) {
    const auto& [x, y, z, w] = body.rotation;
    return {body.position, glm::quat(w, x, y, z), body.scale};
}

Bounds worldBounds(const World& world) {
    Bounds bounds;
    for (const WorldBody& body : world.bodies) {
        const Bounds box = toWorld(poseOf(body), world.colliders[body.collider].box);
        bounds.add(box.min);
        bounds.add(box.max);
    }
    return bounds;
}

std::string worldText(const World& world) {
    const auto line = [](const char* name, FieldRef value) {
        const std::string json = jsonLineOf(value);
        return std::string("  \"") + name + "\": " + json.substr(0, json.size() - 1) + ",\n";
    };
    std::string text =
        "{\n" + line("format", world.format) + line("version", world.version) + line("unit", world.unit);
    appendLines(text, "colliders", world.colliders);
    text += ",\n";
    appendLines(text, "bodies", world.bodies);
    if (!world.materials.empty()) {
        text += ",\n";
        appendLines(text, "materials", world.materials);
    }
    return text + "\n}\n";
}

Result<World> parseWorld(std::string_view text) {
    const Result<nlohmann::json> json = parseStrictJson(withoutByteOrderMark(text), {kDepthMax, kValuesMax});
    if (!json) {
        return fail(json.error().code, json.error().message + kBakeAgain);
    }
    RELIEF_TRY(checkVersion(*json));
    World world;
    RELIEF_TRY(readJson(*json, world));
    if (world.unit != "m" && !world.unit.empty()) {
        return invalidInput("unit must be \"m\" or \"\"; scale the lengths to metres");
    }
    RELIEF_TRY(checkColliders(world.colliders));
    RELIEF_TRY(checkBodies(world));
    if (const auto again = repeatedName(world.materials)) {
        return invalidInput(placeOf("materials", *again) + ".name = '" + world.materials[*again].name +
                            "' is not unique; merge the entries");
    }
    return world;
}

const WorldFile& fileOf(const WorldCollider& collider, WorldDetail detail) {
    return detail == WorldDetail::kCoarse && collider.coarse ? *collider.coarse : collider;
}

Result<World> loadWorldFile(const fs::path& path) {
    const auto bytes = RELIEF_TRY(readFile(path, kWorldBytesMax));
    World world = RELIEF_TRY(withPrefix(quotedPath(path), parseWorld(textOf(bytes))));
    for (std::size_t i = 0; i < world.colliders.size(); ++i) {
        const auto check = [&](WorldDetail detail) {
            return withPrefix(quotedPath(path), pathOf(world, i, detail, path.parent_path()));
        };
        static_cast<void>(RELIEF_TRY(check(WorldDetail::kFine)));
        if (world.colliders[i].coarse) {
            static_cast<void>(RELIEF_TRY(check(WorldDetail::kCoarse)));
        }
    }
    return world;
}

Result<Collider> readWorldCollider(const World& world, std::size_t index, WorldDetail detail,
                                   std::span<const std::byte> bytes, const ContainerLimits& limits) {
    const WorldCollider& of = world.colliders[index];
    const WorldFile& from = fileOf(of, detail);
    const std::string named = placeOf(world, index, detail) + " (" + quotedPath(from.file) + ")";
    if (xxh3_128Hex(bytes) != from.hash) {
        return invalidInput(named + " does not match its hash" + kBakeAgain);
    }
    Collider collider = RELIEF_TRY(withPrefix(named, readContainer(bytes, limits)));
    if (!(collider.bounds == of.box)) {
        return invalidInput(named + " does not match its min and max" + kBakeAgain);
    }
    if (collider.texelBytes() != from.gpu_bytes) {
        return invalidInput(named + " takes " + std::to_string(collider.texelBytes()) +
                            " bytes on the GPU, not " + std::to_string(from.gpu_bytes) + kBakeAgain);
    }
    MaterialResponses(world.materials).apply(collider.materials);
    return collider;
}

Result<Collider> loadWorldCollider(const World& world, std::size_t index, WorldDetail detail,
                                   const fs::path& folder, const ContainerLimits& limits) {
    const std::string place = placeOf(world, index, detail);
    const fs::path path = RELIEF_TRY(pathOf(world, index, detail, folder));
    const auto bytes = RELIEF_TRY(withPrefix(place, readFile(path, containerSizeMax(limits))));
    return readWorldCollider(world, index, detail, bytes, limits);
}

Result<LoadedWorld> loadWorld(const fs::path& path, const ContainerLimits& limits, WorldDetail detail) {
    LoadedWorld loaded;
    loaded.world = RELIEF_TRY(loadWorldFile(path));
    MaterialResponses known(loaded.world.materials);
    ContainerLimits left = limits;
    for (std::size_t i = 0; i < loaded.world.colliders.size(); ++i) {
        Collider collider = RELIEF_TRY(withPrefix(
            quotedPath(path), loadWorldCollider(loaded.world, i, detail, path.parent_path(), left)));
        left.texel_bytes -= std::min(left.texel_bytes, collider.texelBytes());
        known.apply(collider.materials);
        loaded.colliders.push_back(std::move(collider));
    }
    for (std::size_t i = 0; i < loaded.world.materials.size(); ++i) {
        const std::string& name = loaded.world.materials[i].name;
        if (const std::optional<std::string> fault = known.faultOf(name)) {
            return invalidInput(quotedPath(path) + ": " + placeOf("materials", i) + ".name = '" + name +
                                "' " + *fault);
        }
    }
    return loaded;
}

void fields(FieldVisitor& visit, WorldFile& file) {
    visit(
        "file", file.file,
        {.help = "Path of the container, relative to the world's folder and inside it", .rules = kRequired});
    visit("hash", file.hash,
          {.help = "XXH3-128 hash of the container, in hexadecimal",
           .rules = kRequired,
           .pattern = "^[0-9a-f]{32}$"});
    visit("gpu_bytes", file.gpu_bytes,
          {.help = "Bytes of the container's maps on the GPU",
           .range = {1.0, kWorldFileBytesMax},
           .rules = kRequired});
}

void fields(FieldVisitor& visit, WorldCollider& collider) {
    fields(visit, static_cast<WorldFile&>(collider));
    visit("mesh", collider.mesh, {.help = "Name of its mesh in the level; may be empty", .rules = kRequired});
    visit("min", collider.box.min,
          {.help = "Lower corner of its box",
           .unit = "object units",
           .range = within(kWorldCoordinateMax),
           .rules = kRequired});
    visit("max", collider.box.max,
          {.help = "Upper corner of its box",
           .unit = "object units",
           .range = within(kWorldCoordinateMax),
           .rules = kRequired});
    visit("coarse", collider.coarse,
          leftOut({.help = "Coarse container, used while the full one is not on the GPU; if absent, the full "
                           "one is always resident"}));
}

void fields(FieldVisitor& visit, WorldBody& body) {
    visit("collider", body.collider, {.help = "Index of its collider, from 0", .rules = kRequired});
    visit("node", body.node, {.help = "Name of its node in the level; may be empty", .rules = kRequired});
    visit("position", body.position,
          {.help = "Position of the collider's origin",
           .unit = "world units",
           .range = within(kWorldCoordinateMax),
           .rules = kRequired});
    visit("rotation", body.rotation,
          {.help = "A unit quaternion [x, y, z, w]", .range = within(1.001), .rules = kRequired});
    visit("scale", body.scale,
          {.help = "World units per object unit", .range = {1e-9, 1e9}, .rules = kRequired});
    visit("restitution", body.restitution,
          {.help = "Multiplies the restitution of particles", .range = kFractionRange, .rules = kRequired});
    visit("friction", body.friction,
          {.help = "1 − friction multiplies 1 − friction of particles",
           .range = kFractionRange,
           .rules = kRequired});
}

void fields(FieldVisitor& visit, World& world) {
    visit("format", world.format,
          {.help = "Identifies the file format", .rules = kRequired, .words = kWords<"relief-world">});
    visit("version", world.version,
          {.help = "Version of the format", .range = {1.0, double{kWorldVersion}}, .rules = kRequired});
    visit("unit", world.unit,
          {.help = "Unit of length, also of the colliders: m, or empty if the level has none",
           .rules = kRequired,
           .words = kWorldUnits});
    visit("colliders", world.colliders,
          {.help = "Distinct shapes, each listed once",
           .rules = kRequired,
           .items = {1.0, double{kWorldCollidersMax}}});
    visit("bodies", world.bodies,
          {.help = "Placed colliders; if two are equally deep at a point, the first decides",
           .rules = kRequired,
           .items = {1.0, double{kWorldBodiesMax}}});
    visit("materials", world.materials,
          leftOut({.help = "Responses of the colliders' materials, by name",
                   .items = {0.0, double{kWorldMaterialsMax}}}));
}

}  // namespace relief
