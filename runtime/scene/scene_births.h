// SPDX-License-Identifier: Apache-2.0
// The emitters of a scene, with the points and surfaces that they name, ready to give birth.
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
#include "runtime/scene/scene_play.h"

namespace relief {

/// The colliders of a scene, one entry each: those of a LoadedScene. Borrowed.
struct SceneMeshes {
    std::span<const SceneCollider> colliders;
    std::span<const std::shared_ptr<const Collider>> containers;
    std::span<const std::optional<LiveMesh>> live;
    std::span<const std::optional<PlayedMesh>> played;
};

/// Reads the files of points and of surfaces. Emitter i draws from stream i. A surface that followsShape() has the vertices of the collider's
/// mesh, in their order, as they are at time 0; that of a container without a mesh is found by colliderSurface().
/// \param emitters  complete. \param meshes  of the colliders that `attach` counts.
/// Fails as loadPointList, loadNamedMesh and EmitterSurface::create do, and with kInvalidInput (points without normals and without a
/// direction; a group or material of a collider without a mesh, or none such: the message lists those there are). Messages begin with
/// the place in the scene.
[[nodiscard]] Result<std::vector<Emitter>> makeEmitters(std::span<const SceneEmitter> emitters,
                                                        const SceneMeshes& meshes);

}  // namespace relief
