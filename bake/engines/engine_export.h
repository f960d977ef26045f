// SPDX-License-Identifier: Apache-2.0
// The files that another engine needs to collide particles with a collider or a level.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "formats/world/world.h"

namespace relief {

enum class Engine : std::uint8_t { kC, kGodot, kUnity, kUnreal, kThree, kPlaycanvas };

/// Names, indexed by Engine.
inline constexpr std::array<std::string_view, 6> kEngineNames{"c",      "godot", "unity",
                                                              "unreal", "three", "playcanvas"};

/// A file of an export.
struct EngineFile {
    std::string name;  ///< path below the export's folder, with `/`
    std::vector<std::byte> bytes;
};

/// Returns the data, the engine's source files, and a guide, RELIEF.md. Data: uncompressed NAME.relief for engines with
/// a loader; NAME.texels and NAME.constants for C, Unity and Unreal.
/// \param name  of the collider, a file name without extension.
/// Errors: those of engineMap() and writeContainer().
[[nodiscard]] Result<std::vector<EngineFile>> engineFiles(const Collider& collider, std::string_view name,
                                                          Engine engine);

/// Returns NAME.texels, NAME.bodies and NAME.cells of a level, the collision function, and a guide, RELIEF.md.
/// Errors: those of engineMap(); kLimit (more than kEngineTexelsMax texels).
[[nodiscard]] Result<std::vector<EngineFile>> engineFiles(const LoadedWorld& world, std::string_view name,
                                                          Engine engine);

}  // namespace relief
