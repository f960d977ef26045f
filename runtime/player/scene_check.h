// What can be known of a scene without a GPU: whether it and every file that it names are valid.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "runtime/player/player.h"
#include "runtime/scene/scene.h"

namespace relief {

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
    std::vector<std::string> warnings;  ///< of scene_warnings.h
};

/// Loads everything and checks what else a run would refuse whatever the GPU.
/// Fails as loadAll, makeEmitters and checkPictures do, and with kLimit (a picture above Frame::kPixelsMax).
[[nodiscard]] Result<CheckReport> checkScene(const PlayerOptions& options);

/// "scene.toml is valid: …", one line with a newline.
[[nodiscard]] std::string checkText(const CheckReport& report);
/// One JSON object with a trailing newline. Keys: README.md beside this file, "Checking a scene".
[[nodiscard]] std::string checkJson(const CheckReport& report);
/// The same for a scene that is not valid.
[[nodiscard]] std::string checkJson(const Error& error);

}  // namespace relief
