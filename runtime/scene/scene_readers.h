// The readers that parseScene calls for parts of a scene. All throw SceneError. Those that get a table which is not
// `top` leave its finish() to the caller.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "runtime/scene/scene.h"
#include "runtime/scene/scene_emitter.h"
#include "runtime/scene/scene_table.h"

namespace relief {

// scene_air.cpp

/// Makes the tables of readAir known to `top`; call before its finish().
void nameAirTables(SceneTable& top);
/// [[attractor]], [[vortex]], [flow] and [curl_noise]; call when scene.forces is read.
/// \param folder  of the scene, as for the readers below.
void readAir(SceneTable& top, const SceneFolder& folder, Scene& scene);
/// forces.viscosity.
void readViscosity(SceneTable& forces, Scene& scene);

// scene_emitter_reader.cpp

/// [emitter], or [[emitter]] as often as wanted; one emitter with every default where there is neither.
/// \param capacity   of the particles.
/// \param colliders  as many as emitters may be attached to.
[[nodiscard]] std::vector<SceneEmitter> readEmitters(SceneTable& top, std::string_view file,
                                                     const SceneFolder& folder, std::uint32_t capacity,
                                                     std::size_t colliders);

// scene_collider_reader.cpp

/// [collider], or [[collider]] as often as wanted.
[[nodiscard]] std::vector<SceneCollider> readColliders(SceneTable& top, std::string_view file,
                                                       const SceneFolder& folder);

// scene_pose_reader.cpp

/// position, axis and angle; whether any is there.
bool readPose(SceneTable& table, Pose& pose);
/// The [[key]] of a table: two or more, or none.
/// \param pose     what keys leave open.
/// \param instead  of a single key, in words.
[[nodiscard]] std::vector<PoseKey> readPoseKeys(SceneTable& table, std::string_view file, const Pose& pose,
                                                std::string_view instead);

// for [emitter] and [[spawn]]

/// The number or the name of a type, and its place; nothing if the key is absent.
template <class Index>
void readTypeOf(SceneTable& table, std::string_view key, Index& index, std::string& name,
                std::string& origin) {
    const toml::node* node = table.find(key);
    if (node == nullptr) {
        return;
    }
    origin = table.place(node->source().begin);
    if (!node->is_string() && !node->is_integer()) {
        table.wrongType(*node, key, "a whole number or the name of a type");
    }
    if (node->is_integer()) {
        table.integer(key, {0.0, kEmitterTypeMax}, index);
        return;
    }
    table.text(key, name);
    if (name.empty()) {
        table.failAt(*node, table.full(key) + " is an empty name; name a type");
    }
}

// scene_live_reader.cpp

/// collider.mesh, collider.deform and collider.resolution: sets path, origin and live.
/// \return whether the collider deforms; else it needs a file.
[[nodiscard]] bool readLive(SceneTable& collider, std::string_view file, const SceneFolder& folder,
                            SceneCollider& out);

// scene_spawn_reader.cpp

/// [[spawn]].
[[nodiscard]] std::vector<SceneSpawn> readSpawns(SceneTable& top, std::string_view file);

// scene_types.cpp

/// [[type]]. After [render] and [collision].
void readTypes(SceneTable& top, std::string_view file, Scene& scene);

// scene_looks.cpp

/// What a [[type]] says of its look: size, color, opacity, rotation, turn, spin, stretch, cell, lit, fade.
/// \param cells  of the atlas; 0: there is none.
void readLook(SceneTable& type, std::uint32_t cells, Sprite sprite, ParticleLook& look);
/// What [render] says of sprites and of the collider's mesh.
void readSprites(SceneTable& render, const SceneFolder& folder, Scene& scene);

// scene_camera.cpp

/// [[camera.key]] and camera.path. After eye, target and fov.
void readCameraPath(SceneTable& camera, std::string_view file, Scene& scene);

}  // namespace relief
