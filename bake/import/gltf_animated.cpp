// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "bake/import/gltf_scene.h"
#include "bake/import/import_readers.h"
#include "bake/import/import_scene.h"
#include "formats/base/finite.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// Maximum cosine of the angle between perpendicular matrix columns; allows for float rounding.
constexpr double kPerpendicular = 1e-6;
/// A vertex's weight sum may differ from 1 by this much without a warning; quantized weights differ less.
constexpr double kWeightSumTolerance = 0.03;

Affine rowsOf(const Transform& transform) {
    Affine affine;
    for (int row = 0; row < 3; ++row) {
        affine.row[row] = {transform.linear[0][row], transform.linear[1][row], transform.linear[2][row],
                           transform.offset[row]};
    }
    return affine;
}

glm::vec4 unitRotation(const glm::dvec4& q) {
    return q / std::sqrt(glm::dot(q, q));
}

/// Decomposes a matrix into translation, rotation and scale, which clips can animate. Sheared or flat matrices are
/// kept.
void separate(const Transform& transform, MeshNode& node) {
    glm::dmat3 turn = transform.linear;
    glm::dvec3 scale;
    for (int i = 0; i < 3; ++i) {
        scale[i] = glm::length(turn[i]);
        turn[i] /= scale[i];
    }
    if (Transform{turn, {}}.mirrors()) {
        scale.x = -scale.x;
        turn[0] = -turn[0];
    }
    const std::optional<RigidPose> rigid = rigidPose(turn);
    const double skew = std::max({std::abs(glm::dot(turn[0], turn[1])), std::abs(glm::dot(turn[0], turn[2])),
                                  std::abs(glm::dot(turn[1], turn[2]))});
    if (!rigid || !(skew <= kPerpendicular)) {
        node.matrix = rowsOf(transform);
        return;
    }
    const std::array<double, 4>& q = rigid->rotation;
    node.translation = transform.offset;
    node.rotation = unitRotation({q[0], q[1], q[2], q[3]});
    node.scale = scale;
}

MeshNode nodeOf(const GltfNode& from) {
    MeshNode node;
    node.name = cleanUtf8(from.name, kAnimatedNameMax);
    if (from.at.matrix) {
        separate(from.at.transform, node);
    } else {
        node.translation = from.at.translation;
        node.rotation = unitRotation(from.at.rotation);
        node.scale = from.at.scale;
    }
    return node;
}

class AnimatedReader {
  public:
    AnimatedReader(const ImportJob& job, const GltfDocument& file, ImportFiles& files)
        : job_(job),
          document_(*file.json),
          buffers_(file.chunks, files),
          meshes_(job.triangle_max, buffers_, out_.warnings) {
        out_.warnings = file.chunks.warnings;
    }

    Result<TriangleMesh> run() {
        const bool only_clips = job_.kind == ImportKind::kClips;
        RELIEF_TRY(checkGltf(document_, out_.warnings));
        from_ = RELIEF_TRY(readGltfNodes(document_, job_.options.hidden));
        // All nodes of a clip file, because its scene may contain none of them.
        RELIEF_TRY(only_clips ? addNodes(nodesBelow(rootsOf(from_), from_)) : readShown());
        RELIEF_TRY(readGltfClips(document_, buffers_, nodes_, mesh_, out_.warnings));
        RELIEF_TRY(only_clips ? validateClips(mesh_) : validate(mesh_));
        out_.animation = writeAnimatedMesh(mesh_);
        return std::move(out_);
    }

  private:
    struct Skin {
        GltfSkin joints;
        std::vector<Affine> binds;
    };

    Result<void> readShown() {
        const std::vector<std::uint32_t> roots = RELIEF_TRY(gltfRoots(document_, from_));
        const std::vector<std::uint32_t> shown = nodesBelow(roots, from_);
        RELIEF_TRY(meshes_.read(shown, from_, true));
        RELIEF_TRY(readSkins(shown));
        addFrame();
        RELIEF_TRY(addNodes(withJoints(shown)));
        for (const std::uint32_t index : shown) {
            const GltfNode& node = from_[index];
            if (node.mesh && !left_out_.leaveOut(node.shown, node.name, job_.options.hidden)) {
                RELIEF_TRY(place(index));
            }
        }
        mesh_.influence_begin.push_back(static_cast<std::uint32_t>(mesh_.influences.size()));
        mesh_.delta_begin.push_back(static_cast<std::uint32_t>(mesh_.deltas.size()));
        return countParts();
    }

    Result<void> readSkins(const std::vector<std::uint32_t>& shown) {
        for (const std::uint32_t index : shown) {
            const std::optional<GltfValue>& place = from_[index].skin;
            if (!from_[index].mesh || !place || skins_.contains(place->index())) {
                continue;
            }
            Skin skin{RELIEF_TRY(readGltfSkin(*place, buffers_)), {}};
            for (const Transform& bind : skin.joints.binds) {
                skin.binds.push_back(rowsOf(bind));
                if (!skin.binds.back().isFinite()) {
                    return place->wrong("has inverseBindMatrices that are not numbers");
                }
            }
            skins_.emplace(place->index(), std::move(skin));
        }
        return {};
    }

    /// glTF uses metres and +Y up.
    void addFrame() {
        const FrameChange change = changeOf({1.0, UpAxis::kPlusY}, job_.options.unit, job_.options.up);
        out_.unit = change.unit;
        out_.warnings.insert(out_.warnings.end(), change.warnings.begin(), change.warnings.end());
        frame_.linear = change.scale * change.turn;
        MeshNode& node = mesh_.nodes.emplace_back();
        if (frame_.linear != glm::dmat3(1.0)) {
            node.matrix = rowsOf(frame_);
        }
    }

    /// Adds joints, which may be outside the shown scene.
    [[nodiscard]] std::vector<std::uint32_t> withJoints(std::vector<std::uint32_t> all) const {
        std::set<std::uint32_t> known(all.begin(), all.end());
        for (const auto& [key, skin] : skins_) {
            for (std::uint32_t joint : skin.joints.nodes) {
                while (!known.contains(joint) && from_[joint].parent) {
                    joint = *from_[joint].parent;
                }
                if (!known.contains(joint)) {
                    const std::vector<std::uint32_t> below = nodesBelow({joint}, from_);
                    all.insert(all.end(), below.begin(), below.end());
                    known.insert(below.begin(), below.end());
                }
            }
        }
        return all;
    }

    /// \param order  nodes of the file, parents first. They are added below the frame node, if there is one.
    Result<void> addNodes(const std::vector<std::uint32_t>& order) {
        if (order.size() + 1 > kMeshNodesMax) {
            return fail(ErrorCode::kLimit, "it has " + std::to_string(order.size()) + " nodes, but at most " +
                                               std::to_string(kMeshNodesMax - 1) +
                                               " are supported; export less of the scene");
        }
        const std::int32_t above = static_cast<std::int32_t>(mesh_.nodes.size()) - 1;
        nodes_.resize(from_.size());
        for (const std::uint32_t index : order) {
            nodes_[index] = static_cast<std::uint32_t>(mesh_.nodes.size());
            MeshNode& node = mesh_.nodes.emplace_back(nodeOf(from_[index]));
            const std::optional<std::uint32_t> parent = from_[index].parent;
            node.parent = parent ? static_cast<std::int32_t>(*nodes_[*parent]) : above;
            if (from_[index].mesh) {
                RELIEF_TRY(addWeights(from_[index], node));
            }
        }
        return {};
    }

    Result<void> addWeights(const GltfNode& from, MeshNode& node) {
        const GltfValue& mesh = *from.mesh;
        std::size_t count = 0;
        for (const GltfValue& primitive : RELIEF_TRY(mesh.objects("primitives"))) {
            count = std::max(count, RELIEF_TRY(primitive.objects("targets")).size());
        }
        node.first_weight = static_cast<std::uint32_t>(mesh_.weights.size());
        node.weights = static_cast<std::uint32_t>(count);
        if (count > kMorphTargetsMax - mesh_.weights.size()) {
            return mesh.wrong("exceeds the limit of " + std::to_string(kMorphTargetsMax) +
                                  " morph targets for all nodes together; export it with fewer",
                              ErrorCode::kLimit);
        }
        std::vector<float> weights(count, 0.0F);
        for (const GltfValue& place : {mesh, from.place}) {
            const auto own = RELIEF_TRY(place.get<std::vector<float>>("weights"));
            if (own && own->size() != count) {
                return place.wrong("has " + std::to_string(own->size()) + " weights for " +
                                   std::to_string(count) + " morph targets");
            }
            weights = own.value_or(weights);
        }
        mesh_.weights.insert(mesh_.weights.end(), weights.begin(), weights.end());
        return {};
    }

    Result<void> place(std::uint32_t index) {
        const GltfNode& from = from_[index];
        const GltfMesh& mesh = meshes_.at(*from.mesh);
        const auto instances = RELIEF_TRY(gltfInstances(from, buffers_, instances_left_));
        if (instances && from.skin) {
            out_.warnings.emplace_back("instances of a skinned mesh are left out; export them as nodes");
        }
        if (from.skin || !instances) {
            return placeAt(index, mesh, {});
        }
        for (const Transform& instance : *instances) {
            RELIEF_TRY(placeAt(index, mesh, instance));
        }
        return {};
    }

    /// \param below  transform relative to the node; identity for a skinned mesh.
    Result<void> placeAt(std::uint32_t index, const GltfMesh& mesh, const Transform& below) {
        const GltfNode& from = from_[index];
        for (const GltfPrimitive& primitive : mesh.primitives) {
            RELIEF_TRY(checkRoom(*from.mesh, primitive.part));
            double mirrored = 0.0;
            if (from.skin && primitive.influences) {
                const Skin& skin = skins_.at(from.skin->index());
                RELIEF_TRY(checkJoints(*primitive.influences, skin.joints, *from.mesh, *from.skin));
                mirrored = RELIEF_TRY(addInfluences(*primitive.influences, skin));
            } else {
                // A node does not move its skinned mesh, so primitives without joints stay in place.
                const std::uint32_t joint =
                    RELIEF_TRY(jointOf(from.skin ? 0 : *nodes_[index], rowsOf(below)));
                for (std::size_t i = 0; i < primitive.part.positions.size(); ++i) {
                    mesh_.influence_begin.push_back(static_cast<std::uint32_t>(mesh_.influences.size()));
                    mesh_.influences.push_back({joint, 1.0F});
                }
                const Transform at = from.skin ? Transform{} : transformInScene(from_, index) * below;
                mirrored = at.mirrors() ? 1.0 : -1.0;
            }
            RELIEF_TRY(addMaterial(primitive.part));
            addSurface(primitive, mesh_.nodes[*nodes_[index]].first_weight, mirrored > 0.0);
        }
        return {};
    }

    Result<void> checkRoom(const GltfValue& mesh, const ScenePart& part) {
        if (part.positions.size() > kAnimatedVerticesMax - mesh_.positions.size()) {
            return fail(ErrorCode::kLimit, "it has more than " + std::to_string(kAnimatedVerticesMax) +
                                               " moving vertices, counting each instance; "
                                               "simplify the mesh");
        }
        if (part.triangles.size() > job_.triangle_max - mesh_.triangles.size()) {
            return tooManyTriangles(job_);
        }
        return std::ranges::all_of(part.positions,
                                   [](const glm::vec3& position) { return isFinite(position); })
                   ? Result<void>()
                   : mesh.wrong("has positions that are not numbers");
    }

    /// Returns the mirrored weight minus the unmirrored weight in the rest pose: positive if most of the weight is
    /// mirrored.
    Result<double> addInfluences(const GltfInfluences& influences, const Skin& skin) {
        double mirrored = 0.0;
        std::map<std::uint32_t, bool> mirrors;
        for (std::size_t at = 0; at < influences.all.size(); at += influences.per_vertex) {
            const std::span<const GltfInfluence> own =
                std::span(influences.all).subspan(at, influences.per_vertex);
            double sum = 0.0;
            for (const GltfInfluence& by : own) {
                sum += double{by.weight};
            }
            odd_sums_ += std::abs(sum - 1.0) > kWeightSumTolerance ? 1 : 0;
            mesh_.influence_begin.push_back(static_cast<std::uint32_t>(mesh_.influences.size()));
            for (const GltfInfluence& by : own) {
                const auto weight = static_cast<float>(double{by.weight} / sum);
                if (!(weight > 0.0F)) {
                    continue;
                }
                const auto [found, added] = mirrors.try_emplace(by.joint, false);
                if (added) {
                    found->second =
                        (transformInScene(from_, skin.joints.nodes[by.joint]) * skin.joints.binds[by.joint])
                            .mirrors();
                }
                mirrored += found->second ? double{weight} : -double{weight};
                mesh_.influences.push_back(
                    {RELIEF_TRY(jointOf(*nodes_[skin.joints.nodes[by.joint]], skin.binds[by.joint])),
                     weight});
            }
        }
        return mirrored;
    }

    /// Returns the joint for a node and bind matrix; skins of one skeleton share joints.
    Result<std::uint32_t> jointOf(std::uint32_t node, const Affine& bind) {
        std::array<float, 12> numbers{};
        for (std::size_t i = 0; i < 12; ++i) {
            numbers.at(i) = bind.row[i / 4][static_cast<int>(i % 4)];
        }
        const auto [found, added] =
            joints_.try_emplace({node, numbers}, static_cast<std::uint32_t>(mesh_.joints.size()));
        if (added) {
            if (mesh_.joints.size() == kMeshJointsMax) {
                return fail(ErrorCode::kLimit, "more than " + std::to_string(kMeshJointsMax) +
                                                   " joints, nodes and instances move its vertices; join "
                                                   "meshes, or export less of the scene");
            }
            mesh_.joints.push_back({node, bind});
        }
        return found->second;
    }

    /// Adds the material of the following triangles; materials with equal names are merged.
    Result<void> addMaterial(const ScenePart& part) {
        const std::string name = cleanUtf8(part.material, kAnimatedNameMax);
        const auto [found, added] =
            materials_.try_emplace(name, static_cast<std::uint16_t>(mesh_.materials.size()));
        if (added) {
            if (mesh_.materials.size() == kMeshMaterialsMax) {
                return fail(ErrorCode::kLimit, "it has more than " + std::to_string(kMeshMaterialsMax) +
                                                   " materials; merge some, or export less of the scene");
            }
            mesh_.materials.push_back(name);
        }
        mesh_.triangle_materials.insert(mesh_.triangle_materials.end(), part.triangles.size(), found->second);
        return {};
    }

    void addSurface(const GltfPrimitive& primitive, std::uint32_t first_target, bool flips) {
        const auto base = static_cast<std::uint32_t>(mesh_.positions.size());
        mesh_.positions.insert(mesh_.positions.end(), primitive.part.positions.begin(),
                               primitive.part.positions.end());
        for (std::size_t vertex = 0; vertex < primitive.part.positions.size(); ++vertex) {
            mesh_.delta_begin.push_back(static_cast<std::uint32_t>(mesh_.deltas.size()));
            for (std::uint32_t target = 0; target < primitive.targets.size(); ++target) {
                const std::vector<glm::vec3>& deltas = primitive.targets[target];
                if (!deltas.empty() && deltas[vertex] != glm::vec3(0.0F)) {
                    mesh_.deltas.push_back({first_target + target, deltas[vertex]});
                }
            }
        }
        for (const glm::uvec3& t : primitive.part.triangles) {
            mesh_.triangles.push_back(base + (flips ? glm::uvec3(t.x, t.z, t.y) : t));
        }
    }

    Result<void> countParts() {
        const MeshParts counts = meshes_.counts(RELIEF_TRY(document_.objects("meshes")).size());
        if (const std::optional<std::string> refusal = partsError(counts)) {
            return invalidInput(*refusal);
        }
        if (mesh_.triangles.empty()) {
            return noTriangles(left_out_.any());
        }
        if (mesh_.materials == std::vector<std::string>{""}) {  // no material has a name
            mesh_.materials.clear();
            mesh_.triangle_materials.clear();
        }
        out_.unused_vertices = counts.unused;
        warnAboutParts(counts, out_.warnings);
        left_out_.warn(out_.warnings);
        if (odd_sums_ > 0) {
            out_.warnings.push_back(
                std::to_string(odd_sums_) +
                (odd_sums_ == 1 ? " vertex has joint weights" : " vertices have joint weights") +
                " that do not sum to 1; they are normalized");
        }
        return {};
    }

    const ImportJob& job_;
    const GltfValue document_;
    GltfBuffers buffers_;
    TriangleMesh out_;
    GltfMeshes meshes_;
    AnimatedMesh mesh_;
    Transform frame_;
    SkippedObjects left_out_;
    std::vector<GltfNode> from_;
    std::vector<std::optional<std::uint32_t>> nodes_;  // by node index in the file: index in mesh_
    std::map<std::uint64_t, Skin> skins_;
    std::map<std::pair<std::uint32_t, std::array<float, 12>>, std::uint32_t> joints_;
    std::map<std::string, std::uint16_t> materials_;
    std::uint64_t instances_left_ = kGltfInstancesMax;
    std::uint64_t odd_sums_ = 0;
};

}  // namespace

Result<TriangleMesh> readAnimatedGltf(const ImportJob& job, ImportFiles& files) {
    const GltfDocument file = RELIEF_TRY(openGltf(job.bytes));
    return AnimatedReader(job, file, files).run();
}

}  // namespace relief
