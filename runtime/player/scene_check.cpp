// SPDX-License-Identifier: Apache-2.0
#include "runtime/player/scene_check.h"

#include <set>
#include <system_error>

#include "formats/base/file_io.h"
#include "runtime/picture/frame.h"
#include "runtime/scene/scene_meshes.h"
#include "runtime/scene/scene_pictures.h"
#include "runtime/scene/scene_world.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

/// Maximum number of files in checkText(); a world has thousands.
constexpr std::size_t kFilesShown = 12;

}  // namespace

Result<CheckReport> checkScene(const PlayerOptions& options) {
    auto loaded = RELIEF_TRY(loadAll(options.input, options.overrides));
    const auto& render = loaded.scene.render;
    if (std::uint64_t{render.width} * render.height > Frame::kPixelsMax) {
        return fail(ErrorCode::kLimit, quotedPath(options.input) + ": render.size has more than " +
                                           std::to_string(Frame::kPixelsMax) +
                                           " pixels; choose a smaller size");
    }
    RELIEF_TRY(checkPictures(loaded.scene, loaded.bounds));
    CheckReport report;
    const auto add = [&](const fs::path& path, const char* kind) {
        if (!path.empty()) {
            std::error_code error;  // the file was read before, but a pipe has no size
            const std::uintmax_t bytes = fs::file_size(path, error);
            report.files.push_back({path, kind, error ? 0 : static_cast<std::uint64_t>(bytes)});
        }
    };
    const fs::path& world = loaded.scene.world;
    if (options.input != world && options.input != loaded.scene.colliders.front().path) {
        add(options.input, "scene");
    }
    add(world, "world");
    report.world_bodies = loaded.world.bodies.size();
    std::set<const Collider*> known;
    for (std::size_t i = 0; i < loaded.colliders.size(); ++i) {
        const SceneCollider& from = loaded.scene.colliders[i];
        if (known.insert(loaded.colliders[i].get()).second) {
            add(from.path, from.live ? "mesh" : "collider");
            report.collider_maps += loaded.colliders[i]->maps.size();
        }
    }
    // Only the coarse containers of a streamed world are loaded; check the others, too.
    for (std::size_t i = 0; loaded.scene.stream && i < loaded.world.colliders.size(); ++i) {
        const std::optional<WorldFile>& coarse = loaded.world.colliders[i].coarse;
        if (coarse) {
            static_cast<void>(RELIEF_TRY(withPrefix(
                loaded.scene.world_origin + ": world: " + quotedPath(world),
                loadWorldCollider(loaded.world, i, WorldDetail::kFine, world.parent_path(), loaded.limits))));
            add(containerOf(loaded.scene, *coarse), "collider");
        }
    }
    if (loaded.scene.flow) {
        add(loaded.scene.flow->path, "flow");
    }
    for (const SceneEmitter& emitter : loaded.scene.emitters) {
        add(emitter.points_file, "points");
        add(emitter.mesh_file, "mesh");
    }
    add(render.atlas, "atlas");
    add(render.mesh, "mesh");
    if (!render.meshes.empty()) {
        RELIEF_TRY(loadDrawnMeshes(loaded));
        for (const fs::path& file : RELIEF_TRY(drawnFiles(loaded))) {
            add(file, "mesh");
        }
    }
    report.steps = loaded.scene.time.steps;
    report.capacity = loaded.scene.particles.capacity;
    report.warnings = std::move(loaded.warnings);
    return report;
}

std::string checkText(const CheckReport& report) {
    std::string text = quotedPath(report.files.front().path) + " is valid: " + std::to_string(report.steps) +
                       " steps of up to " + std::to_string(report.capacity) + " particles, " +
                       std::to_string(report.collider_maps) + " maps";
    if (report.world_bodies > 0) {
        text += ", " + std::to_string(report.world_bodies) + " bodies of a world";
    }
    for (std::size_t i = 1; i < std::min(report.files.size(), kFilesShown); ++i) {
        text += ", " + report.files[i].kind + " " + quotedPath(report.files[i].path);
    }
    if (report.files.size() > kFilesShown) {
        text += " and " + std::to_string(report.files.size() - kFilesShown) + " more files";
    }
    return text + "\n";
}

void fields(FieldVisitor& visit, const CheckedFile& file) {
    visit("file", file.path, {"Path"});
    visit("kind", file.kind,
          {.help = "Purpose",
           .words = kWords<"scene", "world", "collider", "flow", "points", "atlas", "mesh">});
    visit("bytes", file.bytes, {"Size", "bytes"});
}

void fields(FieldVisitor& visit, const CheckReport& report) {
    visit("valid", true, {.help = "The scene is valid", .words = kWords<"true">});
    visit("steps", report.steps, {"Steps to play"});
    visit("capacity", report.capacity, {"Maximum number of particles"});
    visit("bodies", report.world_bodies, {"Bodies of the world"});
    visit("maps", report.collider_maps, {"Maps of all colliders"});
    visit("files", report.files, {"The input and the files that it names"});
    visit("warnings", report.warnings, {"Likely errors in the scene, one line each"});
}

void fields(FieldVisitor& visit, const CheckFailure& failure) {
    visit("valid", false, {.help = "The scene is not valid", .words = kWords<"false">});
    visit("code", static_cast<int>(failure.error.code), {"Exit code", {}, {1.0, 7.0}});
    visit("error", failure.error.message, {"Error message, one line"});
}

}  // namespace relief
