// What can be known of a scene without a GPU: whether it and every file that it names are valid.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "formats/collider.h"
#include "formats/result.h"
#include "runtime/player.h"
#include "runtime/scene.h"

namespace relief {

/// A scene and what it names, read and complete.
struct LoadedScene {
    Scene scene;                      ///< overridden by the options, every default filled in
    std::vector<Collider> colliders;  ///< those of the scene, in its order
    /// As many: the meshes of those that deform, whose colliders have maps without texels.
    std::vector<std::optional<LiveMesh>> live;
    Bounds bounds;  ///< of what they occupy in the course of time, in the particles' space
};

/// Reads options.input, a scene or a collider, and the files that it names. Needs no context.
/// Errors: those of the files; a scene's name the scene's line and column.
[[nodiscard]] Result<LoadedScene> loadAll(const PlayerOptions& options);

struct CheckedFile {
    std::filesystem::path path;
    std::string kind;         ///< "scene", "collider", "flow", "atlas" or "mesh"
    std::uint64_t bytes = 0;  ///< on disk
};

struct CheckReport {
    std::vector<CheckedFile> files;  ///< the input first
    std::size_t collider_maps = 0;
    std::uint32_t steps = 0;
    std::uint32_t capacity = 0;
};

/// loadAll(), and what else a run would refuse whatever the GPU.
/// Errors: those of loadAll, kLimit (a picture above Frame::kPixelsMax).
[[nodiscard]] Result<CheckReport> checkScene(const PlayerOptions& options);

/// "scene.toml is valid: …", one line with a newline.
[[nodiscard]] std::string checkText(const CheckReport& report);
/// One JSON object with a trailing newline. Keys: runtime/README.md, "Checking a scene".
[[nodiscard]] std::string checkJson(const CheckReport& report);
/// The same for a scene that is not valid.
[[nodiscard]] std::string checkJson(const Error& error);

}  // namespace relief
