// SPDX-License-Identifier: Apache-2.0
#include "runtime/scene/scene_births.h"
#include "runtime/births/point_list.h"

#include <map>
#include <string>
#include <utility>

#include "formats/animation/mesh_parts.h"
#include "formats/base/file_io.h"
#include "runtime/births/collider_surface.h"
#include "runtime/files/mesh_file.h"

namespace relief {
namespace {

/// Starts of messages: "scene.toml:3:9: 'a.obj': emitter.group".
struct Places {
    Places(const SceneEmitter& emitter, const std::filesystem::path& path)
        : surface(emitter.place + ": " + quotedPath(path)),
          group(emitter.group_origin + ": " + quotedPath(path) + ": emitter.group"),
          material(emitter.material_origin + ": " + quotedPath(path) + ": emitter.material") {}
    std::string surface, group, material;
};

Result<EmitterSurface> surfaceOf(const AnimatedMesh& mesh, const MeshPose& pose, const SceneEmitter& emitter,
                                 const Places& at) {
    std::vector<float> weights;
    if (!emitter.group.empty()) {
        weights = RELIEF_TRY(withPrefix(at.group, groupWeights(mesh, emitter.group)));
    }
    std::vector<glm::uvec3> triangles = mesh.triangles;
    if (!emitter.material.empty()) {
        triangles = RELIEF_TRY(withPrefix(at.material, materialTriangles(mesh, emitter.material)));
    }
    return withPrefix(at.surface, EmitterSurface::create(triangles, std::move(weights), posed(mesh, pose)));
}

/// Returns the triangles of a group and a material of a file.
Result<std::vector<glm::uvec3>> partOf(const NamedMesh& named, const SceneEmitter& emitter,
                                       const Places& at) {
    const std::vector<glm::uvec3> all = trianglesOf(named.mesh);
    std::vector<glm::uvec3> kept;
    std::vector<std::string> groups;
    std::vector<std::string> materials;
    bool has_group = emitter.group.empty();
    bool has_material = emitter.material.empty();
    for (std::size_t part = 0; part <= named.parts.size(); ++part) {
        // Triangles before the first part have no names.
        const PictureMeshPart own = part > 0 ? named.parts[part - 1] : PictureMeshPart{};
        const std::size_t end = part < named.parts.size() ? named.parts[part].begin : all.size();
        groups.push_back(own.group);
        materials.push_back(own.material);
        const bool in_group = emitter.group.empty() || own.group == emitter.group;
        const bool in_material = emitter.material.empty() || own.material == emitter.material;
        has_group = has_group || in_group;
        has_material = has_material || in_material;
        if (in_group && in_material) {
            kept.insert(kept.end(), all.begin() + static_cast<std::ptrdiff_t>(own.begin),
                        all.begin() + static_cast<std::ptrdiff_t>(end));
        }
    }
    if (!has_group) {
        return invalidInput(at.group + ": " + partNotFound("group or object", emitter.group, groups));
    }
    if (!has_material) {
        return invalidInput(at.material + ": " + partNotFound("material", emitter.material, materials));
    }
    return kept;
}

Result<EmitterSurface> surfaceOf(NamedMesh named, const SceneEmitter& emitter, const Places& at) {
    const std::vector<glm::uvec3> triangles = RELIEF_TRY(partOf(named, emitter, at));
    return withPrefix(at.surface, EmitterSurface::create(triangles, {}, std::move(named.mesh.positions)));
}

/// Cache of the surfaces of containers.
using Surfaces = std::map<const Collider*, ColliderSurface>;

Result<EmitterSurface> surfaceOf(const Collider& container, const SceneEmitter& emitter, const Places& at,
                                 Surfaces& known) {
    if (!container.animation.empty()) {
        const AnimatedMesh mesh = RELIEF_TRY(withPrefix(at.surface, readAnimatedMesh(container.animation)));
        return surfaceOf(mesh, restPose(mesh), emitter, at);
    }
    const bool unknown_material = !emitter.material.empty() && container.materials.empty();
    if (!emitter.group.empty() || unknown_material) {
        return invalidInput((emitter.group.empty() ? at.material : at.group) +
                            " needs a mesh, which the container lacks; set emitter.mesh to its source mesh, "
                            "or bake it with --animated");
    }
    if (!known.contains(&container)) {
        known[&container] = RELIEF_TRY(withPrefix(at.surface, colliderSurface(container)));
    }
    const ColliderSurface& surface = known[&container];
    std::vector<glm::uvec3> triangles = surface.triangles;
    if (!emitter.material.empty()) {
        triangles = RELIEF_TRY(
            withPrefix(at.material, materialTriangles(surface, container.materials, emitter.material)));
    }
    return withPrefix(at.surface, EmitterSurface::create(triangles, {}, surface.positions));
}

Result<EmitterSurface> surfaceOf(const SceneEmitter& emitter, const SceneMeshes& meshes, Surfaces& known) {
    if (!emitter.mesh_file.empty()) {
        const Places at(emitter, emitter.mesh_file);
        return surfaceOf(RELIEF_TRY(withPrefix(emitter.place, loadNamedMesh(emitter.mesh_file))), emitter,
                         at);
    }
    const std::size_t i = *emitter.attach;
    const std::optional<PlayedMesh>& played = meshes.played[i];
    const Places at(emitter, meshes.colliders[i].path);
    return played           ? surfaceOf(*played->mesh, played->poseAt(0.0), emitter, at)
           : meshes.live[i] ? surfaceOf(NamedMesh{meshes.live[i]->mesh, {}}, emitter, at)
                            : surfaceOf(*meshes.containers[i], emitter, at, known);
}

}  // namespace

Result<std::vector<Emitter>> makeEmitters(std::span<const SceneEmitter> emitters, const SceneMeshes& meshes) {
    std::vector<Emitter> made;
    Surfaces known;
    for (const SceneEmitter& emitter : emitters) {
        EmitterSettings settings = emitter;
        if (emitter.shape == EmitterShape::kPoints) {
            const std::string key = emitter.points_origin + ": emitter.points";
            settings.points = RELIEF_TRY(withPrefix(key, loadPointList(emitter.points_file)));
            if (emitter.aim && !emitter.aim->direction && settings.points.normals.empty()) {
                return invalidInput(key + ": " + quotedPath(emitter.points_file) +
                                    " has no normals; set emitter.direction, or add nx, ny and nz");
            }
        }
        if (emitter.shape == EmitterShape::kSurface) {
            auto surface = RELIEF_TRY(surfaceOf(emitter, meshes, known));
            settings.surface = BirthSurfaceValue(std::make_unique<EmitterSurface>(std::move(surface)));
        }
        RELIEF_TRY(Emitter::check(settings));
        made.emplace_back(std::move(settings), emitter.seed, made.size());
    }
    return made;
}

}  // namespace relief
