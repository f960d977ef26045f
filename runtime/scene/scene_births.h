// SPDX-License-Identifier: Apache-2.0
// Creates the emitters of a scene, with the points and surfaces that they name.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "runtime/births/emitter_surface.h"
#include "runtime/particles/emitter.h"
#include "runtime/scene/scene_collider.h"
#include "runtime/scene/scene_emitter.h"
#include "runtime/scene/scene_live.h"

namespace relief {

/// Non-owning views of the colliders of a LoadedScene. Every span has one entry per collider.
struct SceneMeshes {
    std::span<const SceneCollider> colliders;
    std::span<const std::shared_ptr<const Collider>> containers;
    std::span<const std::optional<LiveMesh>> live;
    std::span<const std::optional<PlayedMesh>> played;
};

/// Creates emitters, and reads their files of points and surfaces. Emitter i uses random stream i. If
/// followsShape() is true for an emitter, its surface has the vertices of the collider's mesh at time 0, in the same
/// order; for a container without a mesh, the surface is colliderSurface().
/// \param emitters  completed by completeEmitters(). \param meshes  of the colliders that `attach` refers to.
/// Errors: those of loadPointList, loadNamedMesh and EmitterSurface::create; kInvalidInput (a speed or cone for
/// points with neither normals nor a direction; a group of a collider without a mesh; a material of a collider without
/// materials; an unknown group or material, with a list of known names). Messages start with the place in the scene.
[[nodiscard]] Result<std::vector<Emitter>> makeEmitters(std::span<const SceneEmitter> emitters,
                                                        const SceneMeshes& meshes);

}  // namespace relief
