#include "bake/import/gltf_nodes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "formats/base/text.h"

namespace relief {
namespace {

/// How far the length of a rotation may be from 1, as in the Khronos validator: rounding to bytes gives as much.
constexpr double kUnitTolerance = 0.00674;
/// Of the last row of a matrix, which is 0 0 0 1.
constexpr float kRowTolerance = 1e-5F;

glm::dmat3 rotationOf(const glm::dvec3& v, double w) {
    const double x = v.x;
    const double y = v.y;
    const double z = v.z;
    return {{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
            {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
            {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}};
}

Result<Transform> transformOf(const GltfValue& node) {
    std::array<float, 16> matrix{};
    std::array<float, 3> translation{};
    std::array<float, 4> q = {0, 0, 0, 1};
    std::array<float, 3> scale = {1, 1, 1};
    const bool has_matrix = RELIEF_TRY(node.numbers("matrix", matrix));
    const bool moved = RELIEF_TRY(node.numbers("translation", translation));
    const bool turned = RELIEF_TRY(node.numbers("rotation", q));
    const bool scaled = RELIEF_TRY(node.numbers("scale", scale));
    if (has_matrix) {
        if (moved || turned || scaled) {
            return node.wrong("has a matrix and a translation, rotation or scale; only one may be");
        }
        const std::optional<Transform> transform = affine(matrix);
        return transform ? Result<Transform>(*transform)
                         : node.wrong("has a matrix whose last row is not 0 0 0 1 (is it transposed?)");
    }
    const double length =
        std::sqrt(double{q[0]} * q[0] + double{q[1]} * q[1] + double{q[2]} * q[2] + double{q[3]} * q[3]);
    if (!(std::abs(length - 1.0) <= kUnitTolerance)) {
        return node.wrong("has a rotation that is no unit quaternion: its length is " +
                          shortest(static_cast<float>(length)));
    }
    Transform transform;
    transform.linear = rotationOf(glm::dvec3(q[0], q[1], q[2]) / length, q[3] / length);
    for (glm::length_t i = 0; i < 3; ++i) {
        transform.linear[i] *= scale.at(static_cast<std::size_t>(i));
    }
    transform.offset = {translation[0], translation[1], translation[2]};
    return transform;
}

/// The mesh and the skin must exist.
Result<void> readMesh(const GltfValue& document, const GltfValue& place, GltfNode& node) {
    node.mesh = RELIEF_TRY(place.whole("mesh"));
    if (node.mesh) {
        const GltfList meshes = RELIEF_TRY(document.objects("meshes"));
        RELIEF_TRY(meshes.named(*node.mesh, place, "mesh"));
    }
    if (const std::optional<std::uint64_t> skin = RELIEF_TRY(place.whole("skin"))) {
        const GltfList skins = RELIEF_TRY(document.objects("skins"));
        RELIEF_TRY(skins.named(*skin, place, "skin"));
        node.skin = node.mesh ? skin : std::nullopt;
    }
    return {};
}

/// A node with two parents would be there twice for each node on the way, 2ⁿ times in n nodes.
Result<void> setParents(std::vector<GltfNode>& nodes) {
    const auto name = [](std::uint64_t i) { return "nodes[" + std::to_string(i) + "]"; };
    for (std::uint64_t i = 0; i < nodes.size(); ++i) {
        for (const std::uint64_t child : nodes[i].children) {
            if (child >= nodes.size()) {
                return invalidInput(name(i) + " names a child, " + name(child) + ", that does not exist");
            }
            if (nodes[child].parent) {
                return invalidInput(name(child) + " has two parents; nodes must form trees");
            }
            nodes[child].parent = i;
        }
    }
    // Each node has at most one parent, so a node that no root leads to is part of a ring.
    std::vector<std::uint64_t> open;
    for (std::uint64_t i = 0; i < nodes.size(); ++i) {
        if (!nodes[i].parent) {
            open.push_back(i);
        }
    }
    std::size_t reached = 0;
    for (; !open.empty(); ++reached) {
        const GltfNode& node = nodes[open.back()];
        open.pop_back();
        open.insert(open.end(), node.children.begin(), node.children.end());
    }
    return reached == nodes.size() ? Result<void>()
                                   : invalidInput("its nodes are their own parents; nodes must form trees");
}

}  // namespace

std::optional<Transform> affine(std::span<const float> m) {
    for (const std::size_t i : {3U, 7U, 11U, 15U}) {
        if (!(std::abs(m[i] - (i == 15 ? 1.0F : 0.0F)) <= kRowTolerance)) {
            return std::nullopt;
        }
    }
    return Transform{glm::dmat3(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]),
                     {m[12], m[13], m[14]}};
}

Transform placeOf(const std::vector<GltfNode>& nodes, std::uint64_t node) {
    Transform place = nodes[node].transform;
    for (auto above = nodes[node].parent; above; above = nodes[*above].parent) {
        place = nodes[*above].transform * place;
    }
    return place;
}

Result<std::vector<GltfNode>> readGltfNodes(const GltfValue& document) {
    const GltfList list = RELIEF_TRY(document.objects("nodes"));
    std::vector<GltfNode> nodes(list.size());
    for (std::size_t i = 0; i < list.size(); ++i) {
        const GltfValue place = RELIEF_TRY(list.at(i));
        nodes[i].name = RELIEF_TRY(place.text("name")).value_or("");
        nodes[i].children = RELIEF_TRY(place.wholes("children"));
        nodes[i].transform = RELIEF_TRY(transformOf(place));
        RELIEF_TRY(readMesh(document, place, nodes[i]));
    }
    RELIEF_TRY(setParents(nodes));
    return nodes;
}

Result<std::vector<std::uint64_t>> gltfRoots(const GltfValue& document, const std::vector<GltfNode>& nodes) {
    const GltfList scenes = RELIEF_TRY(document.objects("scenes"));
    std::vector<std::uint64_t> shown;
    const std::uint64_t scene = RELIEF_TRY(document.whole("scene")).value_or(0);
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const GltfValue place = RELIEF_TRY(scenes.at(i));
        const std::vector<std::uint64_t> roots = RELIEF_TRY(place.wholes("nodes"));
        for (const std::uint64_t root : roots) {
            if (root >= nodes.size() || nodes[root].parent) {
                return place.wrong("names nodes[" + std::to_string(root) +
                                   "], which does not exist or has a parent");
            }
        }
        std::vector<std::uint64_t> sorted = roots;
        std::sort(sorted.begin(), sorted.end());
        if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
            return place.wrong("names a node twice");
        }
        shown = i == scene ? roots : shown;
    }
    if (scene >= scenes.size()) {
        return invalidInput(scenes.size() == 0
                                ? "it has no scene, and so shows nothing; export it with a scene"
                                : "scene names scenes[" + std::to_string(scene) + "], which does not exist");
    }
    return shown;
}

}  // namespace relief
