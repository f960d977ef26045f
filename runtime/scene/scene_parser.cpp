#include "runtime/scene/scene_parser.h"

#include <algorithm>
#include <exception>
#include <limits>

#include "formats/base/file_io.h"
#include "runtime/scene/scene_readers.h"
#include "runtime/scene/scene_table.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kSceneBytesMax = std::uint64_t{1} << 20;

constexpr double kStepsMax = 1e7;
constexpr double kPixelsMax = 65535;
constexpr double kSortFramesMax = 200;

void readForces(SceneTable table, Scene& scene) {
    auto& forces = scene.forces;
    table.vector("gravity", symmetric(kAccelerationMax), forces.gravity);
    const bool wind = table.vector("wind", symmetric(kSpeedMax), forces.wind);
    table.number("drag", {0.0, kDragMax}, forces.drag);
    readViscosity(table, scene);
    table.finish();
    if (wind && forces.wind != glm::vec3(0.0F) && forces.drag == 0.0F) {
        table.failUseless("wind", "while forces.drag is 0; raise the drag or remove the wind");
    }
}

void readCollision(SceneTable table, Scene& scene) {
    Collision& collision = scene.collision;
    table.number("restitution", {0.0, 1.0}, collision.restitution);
    table.number("friction", {0.0, 1.0}, collision.friction);
    table.number("friction_threshold", {0.0, kSpeedMax}, collision.friction_threshold);
    table.number("sweep", {0.0, kLengthMax}, scene.sweep);
    table.finish();
    if (collision.friction_threshold > 0.0F && collision.friction == 0.0F) {
        table.failUseless("friction_threshold",
                          "while collision.friction is 0; raise the friction or remove it");
    }
}

void readGround(SceneTable table, Scene& scene) {
    table.boolean("enabled", scene.ground.enabled);
    const bool found = table.number("height", symmetric(kLengthMax), scene.ground.height);
    table.finish();
    if (found && !scene.ground.enabled) {
        table.failUseless("height", "while ground.enabled is false; remove one of them");
    }
}

void readCamera(SceneTable table, std::string_view file, Scene& scene) {
    auto& camera = scene.camera;
    const bool eye = table.vector("eye", symmetric(kLengthMax), camera.eye);
    const bool target = table.vector("target", symmetric(kLengthMax), camera.target);
    table.number("fov", {1.0, 170.0}, camera.fov);
    readCameraPath(table, file, scene);
    table.finish();
    if (eye && target) {
        if (const std::string_view problem = cameraProblem(*camera.eye, *camera.target); !problem.empty()) {
            table.failAt(*table.find("eye"), std::string(problem));
        }
    }
}

/// The steps that are drawn.
void readFrames(SceneTable& table, Scene& scene) {
    auto& render = scene.render;
    table.integer("every", {1.0, kStepsMax}, render.every);
    const SceneRange steps{0.0, static_cast<double>(scene.steps)};
    table.integer("first", steps, render.first);
    table.integer("last", steps, render.last);
    if (render.last && *render.last < render.first.value_or(0)) {
        table.failAt(*table.find("last"), "render.last comes before render.first; exchange them");
    }
}

/// time.prewarm, after dt.
void readPrewarm(SceneTable& time, Scene& scene) {
    if (time.number("prewarm", {0.0, kSecondsMax}, scene.prewarm) &&
        scene.prewarm > kStepsMax * static_cast<double>(scene.dt)) {
        time.failAt(*time.find("prewarm"), "time.prewarm is more than " + numberText(kStepsMax) +
                                               " steps of time.dt; shorten it, or raise time.dt");
    }
}

void readRender(SceneTable table, const SceneFolder& folder, Scene& scene) {
    auto& render = scene.render;
    table.pair("size", {1.0, kPixelsMax}, "two whole numbers [width, height]", render.width, render.height);
    if (table.number("point_size", {0.0, kLengthMax, false}, render.point_size)) {
        render.point_size = std::max(*render.point_size, std::numeric_limits<float>::min());
    }
    table.vector("color", {0.0, 1.0}, render.color);
    table.number("opacity", {0.0, 1.0, false}, render.opacity);
    table.vector("background", {0.0, 1.0}, render.background);
    readFrames(table, scene);
    table.integer("sort_frames", {0.0, kSortFramesMax}, render.sort_frames);
    // 1 would be a whole sequence each frame, which spreading over frames is there to avoid.
    if (render.sort_frames == 1) {
        table.failAt(*table.find("sort_frames"),
                     table.full("sort_frames") + " = 1 is out of range; choose 0, for no sort, or 2 to 200");
    }
    readSprites(table, folder, scene);
    table.finish();
}

Scene readScene(const toml::table& root, const SceneFolder& folder, std::string_view file) {
    Scene scene;
    SceneTable top(&root, "", file);
    static_cast<void>(top.find("collider"));  // a table or an array: readColliders
    SceneTable time = top.sub("time");
    SceneTable particles = top.sub("particles");
    static_cast<void>(top.find("emitter"));
    SceneTable forces = top.sub("forces");
    SceneTable collision = top.sub("collision");
    SceneTable ground = top.sub("ground");
    SceneTable camera = top.sub("camera");
    SceneTable render = top.sub("render");
    nameAirTables(top);
    static_cast<void>(top.find("spawn"));
    static_cast<void>(top.find("type"));  // an array: readTypes
    top.finish();

    scene.colliders = readColliders(top, file, folder);
    time.number("dt", {1e-6, 1.0}, scene.dt);
    time.integer("steps", {0.0, kStepsMax}, scene.steps);
    readPrewarm(time, scene);
    time.word("integrator", {"euler", "verlet"}, scene.integrator);
    time.finish();
    particles.integer("capacity", {1.0, ParticleSystem::kCapacityMax}, scene.capacity);
    particles.finish();
    scene.emitters = readEmitters(top, file, folder, scene.capacity, scene.colliders.size());
    readForces(forces, scene);
    readAir(top, folder, scene);
    readCollision(collision, scene);
    readGround(ground, scene);
    readCamera(camera, file, scene);
    readRender(render, folder, scene);
    readTypes(top, file, scene);
    scene.spawns = readSpawns(top, file);
    return scene;
}

}  // namespace

Result<Scene> parseScene(std::string_view text, const fs::path& path, const fs::path& root) {
    const std::string file = oneLine(path.native());
    try {
        const toml::table tables = toml::parse(text, file);
        Scene scene = readScene(tables, {path.parent_path(), root}, file);
        RELIEF_TRY(resolveEmitterTypes(scene.emitters, scene.type_names));
        RELIEF_TRY(resolveSpawnTypes(scene.spawns, scene.type_names));
        return scene;
    } catch (const toml::parse_error& error) {
        const toml::source_position& at = error.source().begin;
        return fail(ErrorCode::kInvalidInput, file + ":" + std::to_string(at.line) + ":" +
                                                  std::to_string(at.column) +
                                                  ": not TOML: " + oneLine(error.description()));
    } catch (const SceneError& error) {
        return fail(ErrorCode::kInvalidInput, error.message);
    } catch (const std::exception& error) {
        return fail(ErrorCode::kInvalidInput, file + ":1:1: cannot be read: " + oneLine(error.what()));
    }
}

Result<Scene> loadScene(const fs::path& path, const fs::path& root) {
    const auto bytes = RELIEF_TRY(readFile(path, kSceneBytesMax));
    return parseScene({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path, root);
}

}  // namespace relief
