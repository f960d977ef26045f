// SPDX-License-Identifier: Apache-2.0
#include "formats/animation/mesh_parts.h"

#include <algorithm>
#include <set>

#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::size_t kListedMax = 20;

/// Returns 1 for each joint that moves a vertex.
std::vector<char> movingJoints(const AnimatedMesh& mesh) {
    std::vector<char> moves(mesh.joints.size(), 0);
    for (const VertexInfluence& influence : mesh.influences) {
        moves[influence.joint] = 1;
    }
    return moves;
}

}  // namespace

std::string listedNames(const std::vector<std::string>& names) {
    std::set<std::string> seen{""};
    std::string list;
    for (const std::string& name : names) {
        if (!seen.insert(name).second) {
            continue;
        }
        if (seen.size() > kListedMax + 1) {
            list += ", …";
            break;
        }
        list += (list.empty() ? "'" : ", '") + cleanUtf8(name) + "'";
    }
    return list;
}

std::string partNotFound(const char* kind, std::string_view name, const std::vector<std::string>& names) {
    const std::string list = listedNames(names);
    return "there is no " + std::string(kind) + " '" + cleanUtf8(name, kAnimatedNameMax) +
           "'; the mesh has " + (list.empty() ? "none with a name" : list);
}

std::vector<std::string> groupNames(const AnimatedMesh& mesh) {
    const std::vector<char> moves = movingJoints(mesh);
    std::vector<std::string> names;
    std::set<std::string> seen{""};
    for (std::size_t i = 0; i < mesh.joints.size(); ++i) {
        const std::string& name = mesh.nodes[mesh.joints[i].node].name;
        if (moves[i] != 0 && seen.insert(name).second) {
            names.push_back(name);
        }
    }
    return names;
}

Result<std::vector<float>> groupWeights(const AnimatedMesh& mesh, std::string_view name) {
    std::vector<char> wanted = movingJoints(mesh);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        wanted[i] = wanted[i] != 0 && !name.empty() && mesh.nodes[mesh.joints[i].node].name == name ? 1 : 0;
    }
    if (std::count(wanted.begin(), wanted.end(), 1) == 0) {
        return invalidInput(partNotFound("vertex group (joint or node)", name, groupNames(mesh)));
    }
    std::vector<float> weights(mesh.positions.size(), 0.0F);
    for (std::size_t vertex = 0; vertex < weights.size(); ++vertex) {
        for (std::uint32_t i = mesh.influence_begin[vertex]; i < mesh.influence_begin[vertex + 1]; ++i) {
            const VertexInfluence& influence = mesh.influences[i];
            weights[vertex] += wanted[influence.joint] != 0 ? influence.weight : 0.0F;
        }
        weights[vertex] = std::min(weights[vertex], 1.0F);
    }
    return weights;
}

Result<std::vector<glm::uvec3>> materialTriangles(const AnimatedMesh& mesh, std::string_view name) {
    const auto found = std::find(mesh.materials.begin(), mesh.materials.end(), name);
    if (name.empty() || found == mesh.materials.end()) {
        return invalidInput(partNotFound("material", name, mesh.materials));
    }
    const auto material = static_cast<std::uint16_t>(found - mesh.materials.begin());
    std::vector<glm::uvec3> triangles;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (mesh.triangle_materials[i] == material) {
            triangles.push_back(mesh.triangles[i]);
        }
    }
    return triangles;
}

}  // namespace relief
