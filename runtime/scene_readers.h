// Readers of parts of a scene file, called by scene.cpp. They throw SceneError.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "runtime/scene.h"
#include "runtime/scene_table.h"

namespace relief {

// scene_looks.cpp

/// What a [[type]] says of its look: size, color, opacity, rotation, turn, spin, cell, lit, fade. Leaves
/// finish() to the caller. \param cells  of the atlas; 0: there is none.
void readLook(SceneTable& table, std::uint32_t cells, ParticleLook& look);
/// [[type]]. After [render].
void readTypes(SceneTable& top, std::string_view file, Scene& scene);
/// What [render] says of sprites and of the collider's mesh.
void readSprites(SceneTable& render, const std::filesystem::path& folder, Scene& scene);

// scene_camera.cpp

/// [[camera.key]] and camera.path. After eye, target and fov.
void readCameraPath(SceneTable& camera, std::string_view file, Scene& scene);

}  // namespace relief
