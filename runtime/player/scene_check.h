// The check of a scene and of every file that it names, without a GPU.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "formats/fields/field.h"
#include "runtime/player/player.h"
#include "runtime/scene/scene.h"

namespace relief {

struct CheckedFile {
    std::filesystem::path path;
    std::string kind;         ///< "scene", "world", "collider", "flow", "points", "atlas" or "mesh"
    std::uint64_t bytes = 0;  ///< on disk
};

struct CheckReport {
    std::vector<CheckedFile> files;  ///< the input first
    std::size_t world_bodies = 0;    ///< of the scene's world
    std::size_t collider_maps = 0;
    std::uint32_t steps = 0;
    std::uint32_t capacity = 0;
    std::vector<std::string> warnings;  ///< of scene_warnings.h
};

/// Loads everything and checks what else a run would refuse whatever the GPU.
/// Fails as loadAll, makeEmitters and checkPictures do, and with kLimit (a picture above Frame::kPixelsMax).
[[nodiscard]] Result<CheckReport> checkScene(const PlayerOptions& options);

/// "scene.toml is valid: …", one line with a newline.
[[nodiscard]] std::string checkText(const CheckReport& report);

// --- `relief-sim --check --json`. Keys: README.md beside this file, "Checking a scene".

template <class Visitor, FieldsOf<CheckedFile> F>
void fields(Visitor& visit, F& file) {
    visit("file", file.path, {"Path"});
    visit("kind", file.kind,
          {.help = "Purpose",
           .words = kWords<"scene", "world", "collider", "flow", "points", "atlas", "mesh">});
    visit("bytes", file.bytes, {"Size", "bytes"});
}

template <class Visitor, FieldsOf<CheckReport> R>
void fields(Visitor& visit, R& report) {
    visit("valid", true, {.help = "The scene is valid", .words = kWords<"true">});
    visit("steps", report.steps, {"Steps to play"});
    visit("capacity", report.capacity, {"Particles, at most"});
    visit("bodies", report.world_bodies, {"Bodies of the world"});
    visit("maps", report.collider_maps, {"Maps of all colliders"});
    visit("files", report.files, {"The input and the files that it names"});
    visit("warnings", report.warnings, {"Probable mistakes, one line each"});
}

/// Of a scene that is not valid.
struct CheckFailure {
    Error error;
};

template <class Visitor, FieldsOf<CheckFailure> F>
void fields(Visitor& visit, F& failure) {
    visit("valid", false, {.help = "The scene is not valid", .words = kWords<"false">});
    visit("code", static_cast<int>(failure.error.code), {"Exit code", {}, {1.0, 7.0}});
    visit("error", failure.error.message, {"One line for people"});
}

}  // namespace relief
