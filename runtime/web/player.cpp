// SPDX-License-Identifier: Apache-2.0
#include "runtime/web/player.h"

#include <cstdint>
#include <filesystem>
#include <glm/gtc/type_ptr.hpp>
#include <span>
#include <string_view>

#include "formats/base/file_io.h"
#include "formats/base/finite.h"
#include "formats/config/toml_reader.h"
#include "runtime/scene/scene.h"
#include "runtime/scene/scene_world.h"

namespace relief {
namespace {

Json json(const glm::vec3& v) {
    return {v.x, v.y, v.z};
}

Json describeStream(const std::optional<StreamCounts>& counts) {
    return counts ? Json{{"requested", counts->wanted},
                         {"loaded", counts->present},
                         {"failed", counts->failed},
                         {"gpu_bytes", counts->gpu_bytes}}
                  : Json();
}

/// Describes the colliders of a scene: file, node and current matrix, column-major.
/// \param poses  one per collider.
Json describeBodies(const std::vector<SceneCollider>& colliders, const std::vector<Pose>& poses) {
    Json bodies = Json::array();
    for (std::size_t at = 0; at < colliders.size(); ++at) {
        const SceneCollider& collider = colliders[at];
        const Pose& pose = poses[at];
        glm::mat4 matrix(pose.scale * glm::mat3_cast(pose.rotation));
        matrix[3] = glm::vec4(pose.position, 1.0F);
        const float* const numbers = glm::value_ptr(matrix);
        bodies.push_back({{"file", collider.path.string()},
                          {"node", collider.node},
                          {"deforms", collider.deforms()},
                          {"moves", !collider.keys.empty() || collider.play},
                          {"matrix", std::vector<float>(numbers, numbers + 16)}});
    }
    return bodies;
}

/// Adds a JSON value to a toml::table, or appends it to a toml::array.
template <class To>
void add(To& to, const std::string& key, const Json& value) {
    constexpr bool kTable = std::is_same_v<To, toml::table>;
    const auto put = [&](auto made) {
        if constexpr (kTable) {
            to.insert_or_assign(key, std::move(made));
        } else {
            to.push_back(std::move(made));
        }
    };
    const auto putAll = [&](auto made) {
        for (const auto& [name, one] : value.items()) {
            add(made, name, one);
        }
        put(std::move(made));
    };
    if (value.is_object()) {
        putAll(toml::table());
    } else if (value.is_array()) {
        putAll(toml::array());
    } else if (value.is_string()) {
        put(value.get<std::string>());
    } else if (value.is_boolean()) {
        put(value.get<bool>());
    } else if (value.is_number_integer()) {
        put(value.get<std::int64_t>());
    } else if (value.is_number()) {
        put(value.get<double>());
    } else if (!kTable) {
        put(std::string("null"));  // keys reject this text, and the error message names its position
    }
}

/// \param text  a scene file, or a JSON object with the same keys.
/// \param path  a path with extension .toml for a file; otherwise the name of the object in messages.
Result<Scene> readScene(std::string_view text, const std::filesystem::path& path) {
    if (path.extension() == ".toml") {
        return parseScene(text, path);
    }
    toml::array one;
    add(one, "", Json::parse(text));
    Scene scene;
    RELIEF_TRY(readTomlTable(*one[0].as_table(), {path.string(), path.parent_path(), {}, "scene"},
                             [&](const TomlValue& top) { readToml(top, scene); }));
    return scene;
}

/// Returns whether neither collider plays a clip, or both play clips with maps of the same size.
bool sameMaps(const SceneCollider& a, const SceneCollider& b) {
    return a.play.has_value() == b.play.has_value() &&
           (!a.play ||
            (a.play->resolution == b.play->resolution && a.play->bounds_scale == b.play->bounds_scale));
}

/// Applies the wanted poses and clips; fails if any other value of a collider changes.
Result<void> applyPoses(std::vector<SceneCollider>& now, const std::vector<SceneCollider>& wanted) {
    for (std::size_t i = 0; i < now.size(); ++i) {
        SceneCollider& body = now[i];
        const SceneCollider& to = wanted[i];
        if (to.path != body.path || to.node != body.node || to.live.has_value() != body.live.has_value() ||
            !sameMaps(to, body) || to.keys != body.keys || to.pose.scale != body.pose.scale ||
            to.restitution != body.restitution || to.friction != body.friction) {
            return fail(ErrorCode::kUsage, "collider " + std::to_string(i) +
                                               ": only position, axis, angle and clip can change; "
                                               "create a new system for other changes");
        }
        body.play = to.play;
        if (to.pose == body.pose) {
            continue;
        }
        if (!body.keys.empty()) {
            return fail(ErrorCode::kUsage, "collider " + std::to_string(i) +
                                               " follows its keys; remove 'key' to move it by set()");
        }
        if (now.size() == 1 && !body.posed && !body.deforms()) {
            return fail(
                ErrorCode::kUsage,
                "a single collider can only move if it has a pose from the beginning; create the system with "
                "collider: { position: [0, 0, 0] } in its scene");
        }
        body.pose = to.pose;
    }
    return {};
}

}  // namespace

Result<Player*> createPlayer(const char* text, const char* path, bool shaded, bool fetches) {
    auto player = std::make_unique<Player>();
    Scene read = RELIEF_TRY(readScene(text, path));
    if (fetches && !read.stream) {
        return fail(ErrorCode::kUsage, quotedPath(path) +
                                           " has no [stream], which streamWorld() requires in a scene "
                                           "given as text; add it, with a radius");
    }
    player->loaded = RELIEF_TRY(loadAll(std::move(read), path, {}));
    const Scene& scene = player->loaded.scene;
    SimulationOptions options{.path = StepPath::kFragment};
    if (fetches) {
        auto source = std::make_unique<FetchedSource>(player->loaded.world);
        player->source = source.get();
        options.source = std::move(source);
    }
    player->simulation.emplace(RELIEF_TRY(Simulation::create(player->loaded, std::move(options))));
    player->atlas = RELIEF_TRY(loadAtlas(scene));
    player->style = particleStyle(scene, player->atlas.get());
    const ColliderView view = colliderView(player->loaded, player->simulation->textures());
    player->renderer.emplace(
        RELIEF_TRY(ParticleRenderer::create(shaded ? std::optional<ColliderView>(view) : std::nullopt)));
    RELIEF_TRY(player->makeSorter(scene));
    return player.release();
}

Result<int> changePlayer(Player& player, const char* text, const char* path, bool emitters) {
    Scene& now = player.loaded.scene;
    Scene read = RELIEF_TRY(readScene(text, path));
    if (!read.world.empty()) {
        RELIEF_TRY(placeBodies(read, player.loaded.world));
    }
    Scene wanted = RELIEF_TRY(withDefaults(std::move(read), player.loaded.bounds));
    if (wanted.particles.capacity != now.particles.capacity ||
        wanted.time.integrator != now.time.integrator || wanted.colliders.size() != now.colliders.size() ||
        wanted.world != now.world) {
        return fail(
            ErrorCode::kUsage,
            "the world, number of colliders, capacity and integrator cannot change; create a new system");
    }
    if (wanted.stream.has_value() != now.stream.has_value() ||
        (now.stream && wanted.stream->memory != now.stream->memory)) {
        return fail(ErrorCode::kUsage,
                    "only the radius of 'stream' can change; create a new system for other changes");
    }
    if (wanted.materials != now.materials) {
        return fail(ErrorCode::kUsage, "materials cannot change; create a new system");
    }
    RELIEF_TRY(checkMaterials(wanted, player.loaded));
    std::optional<std::vector<Emitter>> made;
    if (emitters) {
        made = RELIEF_TRY(makeEmitters(wanted.emitters, player.loaded.meshes()));
    }
    std::vector<SceneCollider> colliders = now.colliders;
    RELIEF_TRY(applyPoses(colliders, wanted.colliders));
    std::vector<std::optional<PlayedMesh>> played = player.loaded.played;
    for (std::size_t i = 0; i < colliders.size(); ++i) {
        RELIEF_TRY(played[i] ? changeClip(*played[i], colliders[i]) : Result<void>());
    }
    wanted.air.flow = now.air.flow;
    wanted.render.atlas = now.render.atlas;
    wanted.colliders = std::move(colliders);
    RELIEF_TRY(player.makeSorter(wanted));
    std::swap(now, wanted);
    std::swap(player.loaded.played, played);
    if (const Result<void> done = player.simulation->change(std::move(made)); !done) {
        now = std::move(wanted);
        player.loaded.played = std::move(played);
        return forward(done);
    }
    player.style = particleStyle(now, player.atlas.get());
    if (now.ground.enabled != wanted.ground.enabled || now.ground.height != wanted.ground.height ||
        now.render.meshes != wanted.render.meshes) {
        player.meshes.reset();
    }
    player.setPoints();
    return 0;
}

Result<int> drawPlayer(Player& player, const CameraMatrices& camera, const RenderTarget& target) {
    const ParticleSystem& particles = player.simulation->particles();
    ParticleOrder order;
    if (player.sorter && player.loaded.scene.render.sort_frames > 0) {
        order = sortedFor(player.loaded.scene, particles, camera.eye(), *player.sorter);
    }
    RELIEF_TRY(player.renderer->draw(particles, camera, player.style, target, order));
    if (isFinite(camera.eye())) {
        player.eye = camera.eye();
        player.setPoints();
    }
    return 0;
}

Result<int> drawPlayerMeshes(Player& player, const CameraMatrices& camera, const RenderTarget& target) {
    if (player.loaded.scene.render.meshes.empty()) {
        return fail(ErrorCode::kUsage, "drawMeshes() needs render.meshes in the scene; add it");
    }
    if (!player.meshes) {
        player.meshes = RELIEF_TRY(MeshPicture::create(player.loaded));
    }
    RELIEF_TRY(player.meshes->draw(camera, player.simulation->particles().time(), target));
    return 0;
}

Json describePlayer(const Player& player) {
    const ParticleSystem& particles = player.simulation->particles();
    const ParticleCounts counts = particles.counts();
    const Scene& scene = player.loaded.scene;
    const Bounds& bounds = player.loaded.bounds;
    const std::span<const std::string> materials = player.simulation->textures().materialNames();
    const Camera camera = sceneCamera(scene, bounds, particles.time());
    return Json{{"time", particles.time()},
                {"alive", counts.alive},
                {"born", counts.born},
                {"died", counts.died},
                {"rejected", counts.rejected + player.simulation->rejected()},
                {"extent", counts.extent},
                {"capacity", particles.capacity()},
                {"width", particles.textureWidth()},
                {"dt", scene.time.dt},
                {"steps", scene.time.steps},
                {"bounds", {{"min", json(bounds.min)}, {"max", json(bounds.max)}}},
                {"ground", scene.ground.enabled && scene.ground.height ? Json(*scene.ground.height) : Json()},
                {"camera", {{"eye", json(camera.eye)}, {"target", json(camera.target)}, {"fov", camera.fov}}},
                {"background", json(scene.render.background)},
                {"meshes", !scene.render.meshes.empty()},
                {"materials", std::vector<std::string>(materials.begin(), materials.end())},
                {"stream", describeStream(player.simulation->streamCounts())},
                {"bodies", describeBodies(scene.colliders, player.simulation->poses())}};
}

}  // namespace relief
