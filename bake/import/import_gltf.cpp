// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "bake/import/gltf_scene.h"
#include "bake/import/import_readers.h"

namespace relief {
namespace {

/// Returns the part in the given pose, flipped if most of it is mirrored.
ScenePart posed(ScenePart part, const GltfInfluences& influences, const std::vector<Transform>& joints) {
    double mirrored = 0.0;
    std::vector<bool> mirrors;
    for (const Transform& joint : joints) {
        mirrors.push_back(joint.mirrors());
    }
    const GltfInfluence* by = influences.all.data();
    for (glm::vec3& position : part.positions) {
        glm::dvec3 sum(0.0);
        double weights = 0.0;
        for (std::size_t k = 0; k < influences.per_vertex; ++k, ++by) {
            if (by->weight > 0.0F) {
                sum += double{by->weight} * joints[by->joint].apply(position);
                weights += double{by->weight};
                mirrored += mirrors[by->joint] ? double{by->weight} : -double{by->weight};
            }
        }
        position = sum / weights;
    }
    for (glm::uvec3& t : part.triangles) {
        t = mirrored > 0.0 ? glm::uvec3(t.x, t.z, t.y) : t;
    }
    return part;
}

class GltfReader {
  public:
    GltfReader(const ImportJob& job, const GltfDocument& file, ImportFiles& files)
        : hidden_(job.options.hidden),
          document_(*file.json),
          buffers_(file.chunks, files),
          meshes_(job.triangle_max, buffers_, scene_.warnings) {
        scene_.warnings = file.chunks.warnings;
    }

    Result<ImportScene> run() {
        scene_.frame = {1.0, UpAxis::kPlusY};
        RELIEF_TRY(checkGltf(document_, scene_.warnings));
        nodes_ = RELIEF_TRY(readGltfNodes(document_, hidden_));
        scene_.nodes.resize(nodes_.size());
        for (std::uint32_t index = 0; index < nodes_.size(); ++index) {
            SceneNode& node = scene_.nodes[index];
            node.index = index;
            node.is_shown = nodes_[index].shown;
            node.shown = nodes_[index].name;
            node.names = {node.shown};
            node.transform = nodes_[index].at.transform;
            node.children = nodes_[index].children;
            node.response = RELIEF_TRY(readSurfaceResponse(document_, nodes_[index], scene_.warnings));
        }
        scene_.roots = RELIEF_TRY(gltfRoots(document_, nodes_));
        RELIEF_TRY(readShown());
        scene_.counts = meshes_.counts(RELIEF_TRY(document_.objects("meshes")).size());
        if (!skins_.empty()) {
            warnOnce(scene_.warnings,
                     all_jointed_ ? "it is skinned; baked in the pose of its nodes"
                                  : "it is skinned; parts without joints are baked as modelled, without "
                                    "their skeleton");
        }
        return std::move(scene_);
    }

  private:
    struct Skin {
        GltfSkin joints;
        std::vector<Transform> transforms;  // by joint: from modelled to posed vertices
    };
    /// Mesh, primitive, and skin + 1, or 0 without a skin.
    using PlacedKey = std::tuple<std::uint64_t, std::size_t, std::uint64_t>;

    Result<void> readShown() {
        const std::vector<std::uint32_t> shown = nodesBelow(scene_.roots, nodes_);
        RELIEF_TRY(meshes_.read(shown, nodes_, false));
        for (const std::uint32_t index : shown) {
            if (nodes_[index].mesh) {
                RELIEF_TRY(placeMesh(nodes_[index], scene_.nodes[index]));
                RELIEF_TRY(placeInstances(nodes_[index], index));
            }
        }
        return {};
    }

    Result<void> placeMesh(const GltfNode& from, SceneNode& node) {
        const std::uint64_t key = from.skin ? from.skin->index() + 1 : 0;
        node.posed = from.skin.has_value();
        if (from.skin && !skins_.contains(key)) {
            skins_[key] = RELIEF_TRY(readSkin(*from.skin));
        }
        const GltfMesh& mesh = meshes_.at(*from.mesh);
        for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
            const GltfPrimitive& primitive = mesh.primitives[i];
            all_jointed_ = all_jointed_ && (!from.skin || primitive.influences);
            const auto [found, added] = placed_.try_emplace({from.mesh->index(), i, key},
                                                            static_cast<std::uint32_t>(scene_.parts.size()));
            node.parts.push_back(found->second);
            if (!added) {
                continue;
            }
            if (!from.skin || !primitive.influences) {
                scene_.parts.push_back(primitive.part);
                continue;
            }
            const Skin& skin = skins_[key];
            RELIEF_TRY(checkJoints(*primitive.influences, skin.joints, *from.mesh, *from.skin));
            scene_.parts.push_back(posed(primitive.part, *primitive.influences, skin.transforms));
        }
        return {};
    }

    /// Moves the node's mesh to one new child per instance, before the node's own children.
    Result<void> placeInstances(const GltfNode& from, std::uint32_t index) {
        const auto instances = RELIEF_TRY(gltfInstances(from, buffers_, instances_left_));
        if (instances && from.skin) {
            warnOnce(scene_.warnings, "instances of a skinned mesh are left out; export them as nodes");
        }
        if (!instances || from.skin) {
            return {};
        }
        std::vector<std::uint32_t> children;
        for (const Transform& transform : *instances) {
            SceneNode node;
            node.transform = transform;
            node.is_shown = scene_.nodes[index].is_shown;
            node.shown = scene_.nodes[index].shown;
            node.response = scene_.nodes[index].response;
            node.index = static_cast<std::uint32_t>(scene_.nodes.size());
            node.parts = scene_.nodes[index].parts;
            children.push_back(*node.index);
            scene_.nodes.push_back(std::move(node));
        }
        SceneNode& node = scene_.nodes[index];
        node.parts.clear();
        node.children.insert(node.children.begin(), children.begin(), children.end());
        return {};
    }

    Result<Skin> readSkin(const GltfValue& place) {
        Skin skin{RELIEF_TRY(readGltfSkin(place, buffers_)), {}};
        for (std::size_t i = 0; i < skin.joints.nodes.size(); ++i) {
            skin.transforms.push_back(transformInScene(nodes_, skin.joints.nodes[i]) * skin.joints.binds[i]);
        }
        return skin;
    }

    HiddenMode hidden_;
    const GltfValue document_;
    GltfBuffers buffers_;
    ImportScene scene_;
    GltfMeshes meshes_;
    std::vector<GltfNode> nodes_;                // by index in the file
    std::map<std::uint64_t, Skin> skins_;        // by index + 1
    std::map<PlacedKey, std::uint32_t> placed_;  // indices of scene parts
    bool all_jointed_ = true;
    std::uint64_t instances_left_ = kGltfInstancesMax;
};

}  // namespace

Result<ImportScene> readGltf(const ImportJob& job, ImportFiles& files) {
    const GltfDocument file = RELIEF_TRY(openGltf(job.bytes));
    return GltfReader(job, file, files).run();
}

}  // namespace relief
