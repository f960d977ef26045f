// Readers of parts of a scene that have files of their own; parseScene calls them. All throw SceneError.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "runtime/scene/scene.h"
#include "runtime/scene/scene_emitter.h"
#include "runtime/scene/scene_table.h"

namespace relief {

/// The keys of [render] that say how particles are sorted (scene_sort.cpp). Throws SceneError.
void readSort(SceneTable& table, Scene& scene);
/// Makes the tables of readAir known to `top`; call before its finish().
void nameAirTables(SceneTable& top);
/// [[attractor]], [[vortex]], [flow] and [curl_noise]; call when scene.forces is read.
void readAir(SceneTable& top, const std::filesystem::path& folder, Scene& scene);
/// forces.viscosity; `forces` is the table of that name.
void readViscosity(SceneTable& forces, Scene& scene);
/// [emitter], or [[emitter]] as often as wanted; one emitter with every default where there is neither.
/// \param folder  of the scene. \param capacity  of the particles.
[[nodiscard]] std::vector<SceneEmitter> readEmitters(SceneTable& top, std::string_view file,
                                                     const std::filesystem::path& folder,
                                                     std::uint32_t capacity);
// scene_collider_reader.cpp

/// [collider], or [[collider]] as often as wanted.
/// \param folder  of the scene.
[[nodiscard]] std::vector<SceneCollider> readColliders(SceneTable& top, std::string_view file,
                                                       const std::filesystem::path& folder);
// scene_live_reader.cpp

/// collider.mesh, collider.deform and collider.resolution: sets path, origin and live. Leaves finish() to the
/// caller. \return whether the collider deforms; else it needs a file.
[[nodiscard]] bool readLive(SceneTable& table, std::string_view file, const std::filesystem::path& folder,
                            SceneCollider& collider);

// scene_collider_reader.cpp

/// What a [[type]] says of its motion: mass, radius, restitution, friction, friction_threshold, on_collision,
/// lifetime_loss. Leaves finish() to the caller. \param type  holds the defaults.
void readPhysics(SceneTable& table, ParticleType& type);

// scene_looks.cpp

/// What a [[type]] says of its look: size, color, opacity, rotation, turn, spin, cell, lit, fade. Leaves
/// finish() to the caller. \param cells  of the atlas; 0: there is none.
void readLook(SceneTable& table, std::uint32_t cells, ParticleLook& look);
/// [[type]]. After [render] and [collision].
void readTypes(SceneTable& top, std::string_view file, Scene& scene);
/// What [render] says of sprites and of the collider's mesh.
void readSprites(SceneTable& render, const std::filesystem::path& folder, Scene& scene);

// scene_camera.cpp

/// [[camera.key]] and camera.path. After eye, target and fov.
void readCameraPath(SceneTable& camera, std::string_view file, Scene& scene);

}  // namespace relief
