// SPDX-License-Identifier: Apache-2.0
// Validates a scene and every file that it names, without a GPU.
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
    std::vector<CheckedFile> files;  ///< starts with the input
    std::size_t world_bodies = 0;    ///< of the scene's world
    std::size_t collider_maps = 0;
    std::uint32_t steps = 0;
    std::uint32_t capacity = 0;
    std::vector<std::string> warnings;  ///< from loadAll()
};

/// Loads everything, and checks all further conditions of a run that do not depend on the GPU.
/// Errors: those of loadAll, makeEmitters and checkPictures; kLimit (a picture above Frame::kPixelsMax).
[[nodiscard]] Result<CheckReport> checkScene(const PlayerOptions& options);

/// Returns the line "scene.toml is valid: …", with a newline.
[[nodiscard]] std::string checkText(const CheckReport& report);

// --- `relief-sim --check --json`. fields() describes the keys.

void fields(FieldVisitor& visit, const CheckedFile& file);

void fields(FieldVisitor& visit, const CheckReport& report);

/// Output for an invalid scene.
struct CheckFailure {
    Error error;
};

void fields(FieldVisitor& visit, const CheckFailure& failure);

}  // namespace relief
