// SPDX-License-Identifier: Apache-2.0
#include "bake/import/gltf_scene.h"

#include <cmath>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <set>
#include <utility>

#include "formats/base/finite.h"

namespace relief {
namespace {

enum Mode : std::uint64_t { kPoints, kLines, kLineLoop, kLineStrip, kTriangles, kStrip, kFan };
constexpr std::uint8_t kByTriangle = 1;
constexpr std::uint8_t kByOther = 2;
constexpr std::uint64_t kJointsMax = 65536;
/// Maximum number of joint sets, each with four joints per vertex.
constexpr std::size_t kSetsMax = 4;

std::uint64_t linesOf(std::uint64_t mode, std::uint64_t corners) {
    return mode == kLines ? corners / 2 : corners < 2 ? 0 : mode == kLineLoop ? corners : corners - 1;
}

/// Returns the corners of triangle i of a primitive. Every other triangle of a strip is flipped.
glm::uvec3 cornersOf(std::uint64_t mode, std::uint32_t i) {
    return mode == kFan         ? glm::uvec3(0, i + 1, i + 2)
           : mode == kTriangles ? glm::uvec3(3 * i, 3 * i + 1, 3 * i + 2)
           : i % 2 == 0         ? glm::uvec3(i, i + 1, i + 2)
                                : glm::uvec3(i + 1, i, i + 2);
}

/// Whether the weights of every vertex are not negative and sum to more than 0.
bool areWeightsValid(const GltfInfluences& influences) {
    for (std::size_t at = 0; at < influences.all.size(); at += influences.per_vertex) {
        double sum = 0.0;
        for (std::size_t k = at; k < at + influences.per_vertex; ++k) {
            const float weight = influences.all[k].weight;
            sum += weight >= 0.0F && weight <= 1e6F ? double{weight} : std::nan("");
        }
        if (!(sum >= 1e-6)) {
            return false;
        }
    }
    return true;
}

/// Reads JOINTS_0, WEIGHTS_0, JOINTS_1, …
/// \param vertices  number of vertices of the primitive.
/// \return nullopt if the primitive has no joints.
Result<std::optional<GltfInfluences>> readInfluences(const GltfValue& attributes, GltfBuffers& buffers,
                                                     std::uint64_t vertices) {
    std::vector<std::pair<std::vector<glm::vec4>, std::vector<glm::vec4>>> sets;
    for (std::size_t i = 0; i < kSetsMax; ++i) {
        const std::string joints = "JOINTS_" + std::to_string(i);
        const std::string weights = "WEIGHTS_" + std::to_string(i);
        const auto joint_accessor = RELIEF_TRY(attributes.named(joints.c_str(), "accessors"));
        const auto weight_accessor = RELIEF_TRY(attributes.named(weights.c_str(), "accessors"));
        if (!joint_accessor && !weight_accessor) {
            break;
        }
        if (!joint_accessor || !weight_accessor) {
            return attributes.wrong("have only one of " + joints + " and " + weights);
        }
        auto& [joint, weight] = sets.emplace_back();
        joint = RELIEF_TRY(readAccessor<glm::vec4>(*joint_accessor, GltfUse::kJoints, buffers, vertices));
        weight = RELIEF_TRY(readAccessor<glm::vec4>(*weight_accessor, GltfUse::kWeights, buffers, vertices));
        if (joint.size() != vertices || weight.size() != vertices) {
            return attributes.wrong("have different counts of " + joints + ", " + weights + " and positions");
        }
    }
    if (sets.empty()) {
        return std::nullopt;
    }
    GltfInfluences influences{4 * sets.size(), {}};
    for (std::uint64_t vertex = 0; vertex < vertices; ++vertex) {
        for (const auto& [joint, weight] : sets) {
            for (int k = 0; k < 4; ++k) {
                influences.all.push_back({static_cast<std::uint32_t>(joint[vertex][k]), weight[vertex][k]});
            }
        }
    }
    return areWeightsValid(influences)
               ? Result<std::optional<GltfInfluences>>(std::move(influences))
               : attributes.wrong(
                     "have weights that are negative, not numbers, or 0 for all joints of a vertex");
}

Result<void> checkIndices(const GltfValue& accessor, const std::vector<std::uint32_t>& indices,
                          std::size_t vertices) {
    const std::uint64_t type = RELIEF_TRY(accessor.number("componentType"));
    const std::uint32_t restart = type == 5121 ? 0xFF : type == 5123 ? 0xFFFF : 0xFFFFFFFF;
    for (const std::uint32_t vertex : indices) {
        if (vertex == restart) {
            return accessor.wrong("has the index " + std::to_string(restart) +
                                  ", which is reserved for primitive restart; export it with wider indices");
        }
        if (vertex >= vertices) {
            return accessor.wrong("has the index " + std::to_string(vertex) +
                                  ", which is not below the number of vertices, " + std::to_string(vertices));
        }
    }
    return {};
}

}  // namespace

Result<GltfSkin> readGltfSkin(const GltfValue& skin, GltfBuffers& buffers) {
    const auto joints = RELIEF_TRY(skin.get<std::vector<std::uint64_t>>("joints", {}));
    if (joints.empty() || joints.size() > kJointsMax) {
        return skin.wrong("has no joints, or more than " + std::to_string(kJointsMax));
    }
    std::vector<glm::mat4> binds(joints.size(), glm::mat4(1.0F));
    if (const auto inverse = RELIEF_TRY(skin.named("inverseBindMatrices", "accessors"))) {
        binds = RELIEF_TRY(readAccessor<glm::mat4>(*inverse, GltfUse::kMatrices, buffers, kJointsMax));
    }
    if (binds.size() < joints.size()) {
        return skin.wrong("has fewer inverseBindMatrices than joints");
    }
    GltfSkin out;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        static_cast<void>(RELIEF_TRY(skin.at(joints[i], "nodes", "joints")));
        const std::optional<Transform> bind = affineOf(&binds[i][0][0]);
        if (!bind) {
            return skin.wrong("has inverseBindMatrices whose last row is not 0 0 0 1");
        }
        out.nodes.push_back(static_cast<std::uint32_t>(joints[i]));
        out.binds.push_back(*bind);
    }
    return out;
}

Result<void> checkJoints(const GltfInfluences& influences, const GltfSkin& joints, const GltfValue& mesh,
                         const GltfValue& skin) {
    for (const GltfInfluence& by : influences.all) {
        if (by.weight > 0.0F && by.joint >= joints.nodes.size()) {
            return mesh.wrong("has vertices with a joint that is missing in its skin, skins[" +
                              std::to_string(skin.index()) + "]");
        }
    }
    return {};
}

Result<void> GltfMeshes::read(const std::vector<std::uint32_t>& shown, const std::vector<GltfNode>& nodes,
                              bool targets) {
    std::set<std::uint64_t> skinned;
    for (const std::uint32_t index : shown) {
        if (nodes[index].mesh && nodes[index].skin) {
            skinned.insert(nodes[index].mesh->index());
        }
    }
    for (const std::uint32_t index : shown) {
        if (const std::optional<GltfValue>& mesh = nodes[index].mesh) {
            RELIEF_TRY(readMesh(*mesh, {skinned.contains(mesh->index()), targets}));
        }
    }
    return {};
}

Result<void> GltfMeshes::readMesh(const GltfValue& mesh, Needs needs) {
    const auto [found, added] = meshes_.try_emplace(mesh.index());
    if (!added) {
        return {};
    }
    const std::string name = RELIEF_TRY(mesh.get<std::string>("name", ""));
    std::optional<std::size_t> targets;
    for (const GltfValue& place : RELIEF_TRY(mesh.objects("primitives"))) {
        GltfPrimitive primitive = RELIEF_TRY(readPrimitive(place, needs));
        const std::size_t count = needs.targets ? RELIEF_TRY(place.objects("targets")).size() : 0;
        if (targets.value_or(count) != count) {
            return place.wrong("has " + std::to_string(count) +
                               " morph targets, but an earlier primitive has " + std::to_string(*targets) +
                               "; all primitives of a mesh must have the same number");
        }
        targets = count;
        if (!primitive.part.triangles.empty()) {
            primitive.part.names = {name, primitive.part.material};
            found->second.primitives.push_back(std::move(primitive));
        }
    }
    return {};
}

MeshParts GltfMeshes::counts(std::size_t meshes) const {
    MeshParts counts = counts_;
    for (const auto& [key, vertices] : vertices_) {
        counts.vertices += vertices.uses.size();
        for (const std::uint8_t use : vertices.uses) {
            counts.unused += (use & kByTriangle) == 0 ? 1 : 0;
            counts.loose += use == 0 ? 1 : 0;
        }
    }
    counts.meshes = meshes;
    counts.unplaced = meshes - meshes_.size();
    return counts;
}

Result<GltfPrimitive> GltfMeshes::readPrimitive(const GltfValue& place, Needs needs) {
    const std::optional<GltfValue> attributes = RELIEF_TRY(place.object("attributes"));
    const std::uint64_t mode = RELIEF_TRY(place.get<std::uint64_t>("mode", kTriangles));
    if (!attributes || mode > kFan) {
        return place.wrong(attributes ? "has a mode that is not 0 to 6" : "has no attributes");
    }
    const std::vector<GltfValue> targets = RELIEF_TRY(place.objects("targets"));
    if (!targets.empty() && !needs.targets) {
        warnOnce(warnings_, "it has morph targets; baked as modelled, without them");
    }
    GltfPrimitive out;
    if (const auto material = RELIEF_TRY(place.named("material", "materials"))) {
        out.part.material = RELIEF_TRY(material->get<std::string>("name", ""));
    }
    const std::optional<GltfValue> accessor = RELIEF_TRY(attributes->named("POSITION", "accessors"));
    if (!accessor) {
        warnOnce(warnings_, "a primitive without positions is left out");
        return out;
    }
    Vertices& used = *RELIEF_TRY(vertices(*accessor));
    RELIEF_TRY(readTriangles(place, mode, used, out.part));
    const std::vector<std::uint32_t> kept = compact(used.positions, out.part);
    if (needs.joints) {
        const std::optional<GltfInfluences> all =
            RELIEF_TRY(readInfluences(*attributes, buffers_, used.positions.size()));
        if (all) {
            out.influences.emplace().per_vertex = all->per_vertex;
        }
        for (std::size_t i = 0; all && i < kept.size(); ++i) {
            const auto from = all->all.begin() + static_cast<std::ptrdiff_t>(all->per_vertex * kept[i]);
            out.influences->all.insert(out.influences->all.end(), from,
                                       from + static_cast<std::ptrdiff_t>(all->per_vertex));
        }
    }
    if (needs.targets) {
        RELIEF_TRY(readTargets(targets, used.positions.size(), kept, out));
    }
    return out;
}

/// \param kept  the part's positions, as indices into the accessor.
Result<void> GltfMeshes::readTargets(const std::vector<GltfValue>& places, std::size_t vertices,
                                     const std::vector<std::uint32_t>& kept, GltfPrimitive& out) {
    for (std::size_t i = 0; i < places.size(); ++i) {
        std::vector<glm::vec3>& target = out.targets.emplace_back();
        const auto accessor = RELIEF_TRY(places[i].named("POSITION", "accessors"));
        if (!accessor) {
            continue;
        }
        const std::uint64_t count = RELIEF_TRY(accessor->number("count"));
        if (count != vertices) {
            return places[i].wrong("moves " + std::to_string(count) + " vertices, but the primitive has " +
                                   std::to_string(vertices));
        }
        const std::vector<glm::vec3> deltas =
            RELIEF_TRY(readAccessor<glm::vec3>(*accessor, GltfUse::kDeltas, buffers_, vertices));
        for (const std::uint32_t vertex : kept) {
            if (!isFinite(deltas[vertex])) {
                return places[i].wrong("moves a vertex by a value that is not a number");
            }
            target.push_back(deltas[vertex]);
        }
    }
    return {};
}

Result<GltfMeshes::Vertices*> GltfMeshes::vertices(const GltfValue& accessor) {
    const bool plain = accessor.has("bufferView") && !accessor.has("sparse");
    const std::uint64_t view = plain ? RELIEF_TRY(accessor.number("bufferView")) : 0;
    const std::uint64_t offset = RELIEF_TRY(accessor.get<std::uint64_t>("byteOffset", 0));
    const std::uint64_t count = RELIEF_TRY(accessor.number("count"));
    const std::uint64_t type = RELIEF_TRY(accessor.number("componentType"));
    const bool normalized = RELIEF_TRY(accessor.get("normalized", false));
    const auto [found, added] =
        vertices_.try_emplace({view, offset, count, type, normalized, plain ? 0 : accessor.index() + 1});
    if (added) {
        found->second.positions = RELIEF_TRY(readAccessor<glm::vec3>(accessor, GltfUse::kPositions, buffers_,
                                                                     3 * triangle_max_ - vertex_count_));
        found->second.uses.resize(found->second.positions.size(), 0);
        vertex_count_ += found->second.positions.size();
    }
    return &found->second;
}

Result<void> GltfMeshes::readTriangles(const GltfValue& place, std::uint64_t mode, Vertices& vertices,
                                       ScenePart& part) {
    // Without indices, vertices are used in order.
    const std::optional<GltfValue> accessor = RELIEF_TRY(place.named("indices", "accessors"));
    std::vector<std::uint32_t> indices;
    if (accessor) {
        indices = RELIEF_TRY(
            readAccessor<std::uint32_t>(*accessor, GltfUse::kIndices, buffers_, 3 * triangle_max_));
        RELIEF_TRY(checkIndices(*accessor, indices, vertices.positions.size()));
    }
    const std::uint64_t corners = accessor ? indices.size() : vertices.positions.size();
    const auto vertexOf = [&](std::uint32_t corner) { return accessor ? indices[corner] : corner; };
    const bool surface = mode >= kTriangles;
    for (std::uint32_t i = 0; i < corners; ++i) {
        vertices.uses[vertexOf(i)] |= surface ? kByTriangle : kByOther;
    }
    counts_.points += mode == kPoints ? corners : 0;
    counts_.lines += surface || mode == kPoints ? 0 : linesOf(mode, corners);
    if (!surface) {
        return {};
    }
    if (mode == kTriangles && corners % 3 != 0) {
        return place.wrong("has " + std::to_string(corners) + " corners, which is not a multiple of 3");
    }
    const std::uint64_t count = mode == kTriangles ? corners / 3 : corners < 3 ? 0 : corners - 2;
    if (count > triangle_max_ - counts_.polygons) {
        return place.wrong("exceeds the limit of " + std::to_string(triangle_max_) +
                               " triangles for all meshes; simplify the mesh, or raise --max-triangles",
                           ErrorCode::kLimit);
    }
    counts_.polygons += count;
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::uvec3 corner = cornersOf(mode, i);
        part.triangles.emplace_back(vertexOf(corner.x), vertexOf(corner.y), vertexOf(corner.z));
    }
    return {};
}

}  // namespace relief
