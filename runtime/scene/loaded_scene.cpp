// SPDX-License-Identifier: Apache-2.0
#include "runtime/scene/loaded_scene.h"

#include <algorithm>
#include <glm/vector_relational.hpp>
#include <limits>
#include <map>

#include "formats/animation/mesh_parts.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/config/toml_reader.h"
#include "formats/container.h"
#include "runtime/files/flow_file.h"
#include "runtime/scene/scene_world.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kNoLast = std::numeric_limits<std::uint32_t>::max();

Result<Scene> openScene(const fs::path& input, const fs::path& root) {
    const std::string extension = lowerCase(input.extension().native());
    if (extension == ".toml") {
        return loadScene(input, root);
    }
    if (extension == ".relief") {
        Scene scene;
        scene.colliders.resize(1);
        scene.colliders.front().path = input;
        return scene;
    }
    if (extension == ".json") {
        Scene scene;
        scene.world = input;
        return scene;
    }
    RELIEF_TRY(rejectMeshName(input));
    return fail(
        ErrorCode::kUsage,
        quotedPath(input) + " is not a scene, collider or world; use a .toml, .relief or world.json file");
}

Result<Collider> openCollider(const SceneCollider& from, const ContainerLimits& limits) {
    auto collider = loadCollider(from.path, limits);
    return from.origin.empty() ? std::move(collider)
                               : withPrefix(from.origin + ": collider.file", std::move(collider));
}

using Colliders = std::map<fs::path, std::shared_ptr<const Collider>>;
/// The animated mesh of a container, and its extent.
struct AnimatedFile {
    std::shared_ptr<const AnimatedMesh> mesh;
    PoseExtent extent;
};
using AnimatedFiles = std::map<fs::path, AnimatedFile>;

/// Loads the clip that a collider plays. \param known  meshes read by other colliders.
Result<PlayedMesh> openPlayed(const SceneCollider& from, const ContainerLimits& limits,
                              AnimatedFiles& known) {
    AnimatedFile& file = known[from.path];
    if (file.mesh == nullptr) {
        const Collider collider = RELIEF_TRY(openCollider(from, limits));
        const std::string place = from.origin + ": collider.play: " + quotedPath(from.path);
        if (collider.animation.empty()) {
            return invalidInput(place + " has no animated mesh; bake it with --animated, or remove play");
        }
        file.mesh = std::make_shared<const AnimatedMesh>(
            RELIEF_TRY(withPrefix(place, readAnimatedMesh(collider.animation))));
        file.extent = poseExtent(*file.mesh);
    }
    for (const SceneMaterialColor& material : from.materials) {
        RELIEF_TRY(withPrefix(material.origin + ": collider.material",
                              materialTriangles(*file.mesh, material.name)));
    }
    return loadPlayedMesh(from, file.mesh, file.extent);
}

/// Reads the world of the scene, if any, and places its bodies.
Result<void> openWorld(Scene& scene, LoadedScene& to, const ContainerLimits& limits,
                       MaterialResponses& responses) {
    if (scene.world.empty()) {
        return {};
    }
    auto read = loadWorld(scene.world, limits, scene.stream ? WorldDetail::kCoarse : WorldDetail::kFine);
    auto loaded =
        RELIEF_TRY(scene.world_origin.empty() ? std::move(read)
                                              : withPrefix(scene.world_origin + ": world", std::move(read)));
    for (Collider& collider : loaded.colliders) {
        responses.apply(collider.materials);
        to.world_colliders.push_back(std::make_shared<const Collider>(std::move(collider)));
    }
    to.world = std::move(loaded.world);
    return placeBodies(scene, to.world);
}

bool withinLengths(const Bounds& bounds) {
    return glm::all(glm::greaterThanEqual(bounds.min, glm::vec3(-kLengthMax))) &&
           glm::all(glm::lessThanEqual(bounds.max, glm::vec3(kLengthMax)));
}

}  // namespace

std::vector<fs::path> filesOf(const Scene& scene) {
    std::vector<fs::path> files{scene.world};
    for (const SceneCollider& collider : scene.colliders) {
        files.push_back(collider.path);
    }
    for (const SceneEmitter& emitter : scene.emitters) {
        files.push_back(emitter.points_file);
        files.push_back(emitter.mesh_file);
    }
    if (scene.flow) {
        files.push_back(scene.flow->path);
    }
    files.push_back(scene.render.atlas);
    files.push_back(scene.render.mesh);
    std::sort(files.begin(), files.end());
    files.erase(std::unique(files.begin(), files.end()), files.end());
    files.erase(std::remove(files.begin(), files.end(), fs::path()), files.end());
    return files;
}

Result<void> checkMaterials(const Scene& scene, const LoadedScene& of) {
    MaterialResponses known({});
    for (const auto* colliders : {&of.world_colliders, &of.colliders}) {
        for (const auto& collider : *colliders) {
            known.recordNames(collider->materials);
        }
    }
    const auto check = [&](const std::string& place, const std::string& key,
                           const std::string& name) -> Result<void> {
        const std::optional<std::string> fault = known.faultOf(name);
        return fault ? invalidInput(place + ": " + key + " = '" + cleanUtf8(name, kMaterialNameMax) + "' " +
                                    *fault)
                     : Result<void>();
    };
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const MaterialResponse& one = scene.materials[i];
        RELIEF_TRY(check(one.origin.text, "material[" + std::to_string(i) + "].name", one.name));
    }
    for (std::size_t i = 0; i < scene.spawns.size(); ++i) {
        const SceneSpawn& one = scene.spawns[i];
        if (!one.on_material.empty()) {
            RELIEF_TRY(check(one.material_origin.text, "spawn[" + std::to_string(i) + "].material",
                             one.on_material));
        }
    }
    for (std::size_t i = 0; i < scene.emitters.size(); ++i) {
        const SceneEmitter& one = scene.emitters[i];
        const SceneTouching touching = one.touching.value_or(SceneTouching{});
        for (std::size_t k = 0; k < touching.materials.size(); ++k) {
            const bool placed = k < touching.material_origins.size();  // read from a file
            RELIEF_TRY(check(placed ? touching.material_origins[k] : one.place,
                             "emitter[" + std::to_string(i) + "].touching.material", touching.materials[k]));
        }
    }
    return {};
}

Result<void> checkOverlap(const LoadedScene& loaded) {
    const std::size_t count = loaded.colliders.size();
    if (count <= kOverlapMax) {
        return {};
    }
    std::vector<std::optional<Bounds>> boxes;
    for (const auto& collider : loaded.colliders) {
        boxes.push_back(insideBox(*collider));
    }
    constexpr std::size_t kTried = 64;
    for (std::size_t i = 0; i < kTried; ++i) {
        const std::size_t tried = (i * count / kTried + i) % count;  // odd and even indices
        const glm::vec3 center =
            toWorld(loaded.scene.colliders[tried].pose, loaded.colliders[tried]->bounds.center());
        std::size_t overlapping = 0;
        for (std::size_t body = 0; body < count; ++body) {
            const glm::vec3 q = toObject(loaded.scene.colliders[body].pose, center);
            overlapping += !boxes[body] || boxes[body]->contains(q) ? 1 : 0;
        }
        if (overlapping > kOverlapMax) {
            return fail(ErrorCode::kLimit, std::to_string(overlapping) + " bodies overlap at " +
                                               shortest(center) + "; place at most " +
                                               std::to_string(kOverlapMax) +
                                               " at one point, or bake them into one collider");
        }
    }
    return {};
}

Result<LoadedScene> loadAll(const fs::path& input, const SceneOverrides& overrides) {
    return loadAll(RELIEF_TRY(openScene(input, overrides.root)), input, overrides);
}

Result<LoadedScene> loadAll(Scene scene, const fs::path& input, const SceneOverrides& overrides) {
    scene.time.steps = overrides.steps.value_or(scene.time.steps);
    scene.render.width = overrides.width.value_or(scene.render.width);
    scene.render.height = overrides.height.value_or(scene.render.height);
    scene.render.steps_per_frame = overrides.steps_per_frame.value_or(scene.render.steps_per_frame);
    scene.render.first_frame = overrides.first_frame ? overrides.first_frame : scene.render.first_frame;
    scene.render.last_frame = overrides.last_frame ? overrides.last_frame : scene.render.last_frame;
    if (scene.render.first_frame.value_or(0) > scene.render.last_frame.value_or(kNoLast)) {
        return fail(ErrorCode::kUsage, "the first frame (step " + std::to_string(*scene.render.first_frame) +
                                           ") comes after the last frame (step " +
                                           std::to_string(*scene.render.last_frame) +
                                           "); swap --first-frame and --last-frame");
    }
    for (SceneEmitter& emitter : scene.emitters) {
        emitter.seed = overrides.seed.value_or(emitter.seed);
    }
    LoadedScene loaded;
    loaded.limits = overrides.limits;
    const std::size_t own = scene.colliders.size();
    const std::vector<MaterialResponse> given = scene.materials;
    MaterialResponses responses(given);
    RELIEF_TRY(openWorld(scene, loaded, overrides.limits, responses));
    Colliders world_files;
    for (std::size_t i = 0; i < loaded.world_colliders.size(); ++i) {
        world_files[containerOf(scene, loaded.world.colliders[i])] = loaded.world_colliders[i];
    }
    // A table that names a file uses that file, even if the world uses a coarse container instead.
    AnimatedFiles meshes;
    Colliders table_files = scene.stream ? Colliders() : world_files;
    for (const SceneCollider& from : scene.colliders) {
        const bool named = loaded.colliders.size() < own && from.node.empty();
        Colliders& known = named ? table_files : world_files;
        loaded.live.emplace_back();
        loaded.played.emplace_back();
        std::shared_ptr<const Collider> read;
        if (from.live) {
            loaded.live.back() = RELIEF_TRY(loadLiveMesh(from));
            read = std::make_shared<const Collider>(loaded.live.back()->frames);
        } else if (from.play) {
            loaded.played.back() = RELIEF_TRY(openPlayed(from, overrides.limits, meshes));
            read = std::make_shared<const Collider>(loaded.played.back()->frames);
        } else {
            std::shared_ptr<const Collider>& file = known[from.path];
            if (file == nullptr) {
                Collider opened = RELIEF_TRY(openCollider(from, overrides.limits));
                responses.apply(opened.materials);
                file = std::make_shared<const Collider>(std::move(opened));
            }
            read = file;
        }
        const Collider& collider = *read;
        const bool posed = from.posed || scene.colliders.size() > 1;
        const Bounds bounds = posed ? worldBounds(from, collider.bounds) : collider.bounds;
        if (!from.origin.empty() && withinLengths(collider.bounds) && !withinLengths(bounds)) {
            return invalidInput(from.origin + ": its position and scale move the collider beyond " +
                                numberText(kLengthMax) + "; place it nearer, or scale it less");
        }
        loaded.bounds.add(bounds.min);
        loaded.bounds.add(bounds.max);
        loaded.colliders.push_back(std::move(read));
    }
    RELIEF_TRY(checkMaterials(scene, loaded));
    loaded.scene = RELIEF_TRY(withPrefix(quotedPath(input), withDefaults(std::move(scene), loaded.bounds)));
    RELIEF_TRY(withPrefix(quotedPath(input), checkOverlap(loaded)));
    loaded.emitters = RELIEF_TRY(makeEmitters(loaded.scene.emitters, loaded.meshes()));
    if (loaded.scene.flow) {
        auto flow = RELIEF_TRY(loadFlow(*loaded.scene.flow));
        loaded.scene.air.flow = std::make_shared<const FlowField>(std::move(flow));
    }
    loaded.sweep = SceneSweep(loaded.scene, loaded.colliders, loaded.emitters, loaded.bounds);
    static_cast<void>(loaded.sweep.lengthFor(loaded.scene.time.dt, loaded.scene, loaded.warnings));
    return loaded;
}

}  // namespace relief
