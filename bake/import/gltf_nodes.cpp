// SPDX-License-Identifier: Apache-2.0
#include "bake/import/gltf_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <set>
#include <string_view>
#include <utility>

#include "formats/base/text.h"

namespace relief {
namespace {

// --- the document ---

// Required extensions that are supported or do not affect positions.
constexpr std::array<std::string_view, 14> kKnown = {"KHR_mesh_quantization",    "KHR_texture_transform",
                                                     "KHR_technique_webgl",      "KHR_techniques_webgl",
                                                     "KHR_texture_basisu",       "KHR_lights_punctual",
                                                     "EXT_texture_webp",         "MSFT_texture_dds",
                                                     "EXT_mesh_gpu_instancing",  "EXT_meshopt_compression",
                                                     "KHR_physics_rigid_bodies", "KHR_implicit_shapes",
                                                     "KHR_node_visibility",      "MSFT_lod"};

Result<void> checkVersion(const GltfValue& document) {
    const std::optional<GltfValue> asset = RELIEF_TRY(document.object("asset"));
    const auto version = asset ? RELIEF_TRY(asset->get<std::string>("version")) : std::nullopt;
    if (!version) {
        return invalidInput("it states no glTF version");
    }
    const std::string least = RELIEF_TRY(asset->get<std::string>("minVersion", "2.0"));
    for (const auto& [text, any_minor] : {std::pair(*version, true), std::pair(least, false)}) {
        const std::vector<std::string_view> parts = split(text, '.');
        const std::optional<std::uint64_t> major = parseUnsigned(parts[0]);
        const std::optional<std::uint64_t> minor = parts.size() == 2 ? parseUnsigned(parts[1]) : std::nullopt;
        if (!major || !minor) {
            return asset->wrong("has the invalid version '" + cleanUtf8(text, 20) + "'; save it as glTF 2.0");
        }
        if (*major != 2 || (*minor > 0 && !any_minor)) {
            return fail(ErrorCode::kUnsupported,
                        "glTF version '" + cleanUtf8(text, 20) + "' is not supported; save it as glTF 2.0");
        }
    }
    return {};
}

Result<std::optional<GltfValue>> extensionOf(const std::optional<GltfValue>& of, const char* name) {
    const auto extensions = of ? RELIEF_TRY(of->object("extensions")) : std::nullopt;
    return extensions ? extensions->object(name) : std::optional<GltfValue>();
}

/// Whether animations change the visibility of nodes (KHR_animation_pointer). Fails only if an animation is invalid.
/// checkGltf() ignores this error, because a static mesh does not depend on animations.
Result<bool> animatesVisibility(const GltfValue& document) {
    for (const GltfValue& animation : RELIEF_TRY(document.objects("animations"))) {
        for (const GltfValue& channel : RELIEF_TRY(animation.objects("channels"))) {
            const auto target = RELIEF_TRY(channel.object("target"));
            const auto pointer = RELIEF_TRY(extensionOf(target, "KHR_animation_pointer"));
            const std::string path = pointer ? RELIEF_TRY(pointer->get<std::string>("pointer", "")) : "";
            if (path.ends_with("/KHR_node_visibility/visible")) {
                return true;
            }
        }
    }
    return false;
}

// --- nodes ---

/// Tolerance of a quaternion's length, as in the Khronos validator: rounding to bytes.
constexpr double kUnitTolerance = 0.00674;
/// Tolerance of a matrix's last row, 0 0 0 1.
constexpr float kRowTolerance = 1e-5F;

/// \param node  for messages.
Result<Transform> placedBy(const GltfValue& node, const glm::vec3& t, const glm::vec4& q,
                           const glm::vec3& scale) {
    const double length =
        std::sqrt(double{q.x} * q.x + double{q.y} * q.y + double{q.z} * q.z + double{q.w} * q.w);
    if (!(std::abs(length - 1.0) <= kUnitTolerance)) {
        return node.wrong("has a rotation that is not a unit quaternion: its length is " +
                          shortest(static_cast<float>(length)));
    }
    Transform transform{glm::mat3_cast(glm::dquat(q.w / length, q.x / length, q.y / length, q.z / length)),
                        t};
    for (int i = 0; i < 3; ++i) {
        transform.linear[i] *= double{scale[i]};
    }
    return transform;
}

Result<GltfPlacement> placementOf(const GltfValue& node) {
    const std::vector<float> matrix = RELIEF_TRY(node.numbers("matrix", 16));
    const std::vector<float> t = RELIEF_TRY(node.numbers("translation", 3));
    const std::vector<float> q = RELIEF_TRY(node.numbers("rotation", 4));
    const std::vector<float> scale = RELIEF_TRY(node.numbers("scale", 3));
    GltfPlacement at;
    if (!matrix.empty()) {
        if (!t.empty() || !q.empty() || !scale.empty()) {
            return node.wrong("has a matrix and a translation, rotation or scale; use one of them");
        }
        const std::optional<Transform> transform = affineOf(matrix.data());
        if (!transform) {
            return node.wrong("has a matrix whose last row is not 0 0 0 1 (is it transposed?)");
        }
        at.matrix = true;
        at.transform = *transform;
        return at;
    }
    at.translation = t.empty() ? at.translation : glm::vec3(t[0], t[1], t[2]);
    at.rotation = q.empty() ? at.rotation : glm::vec4(q[0], q[1], q[2], q[3]);
    at.scale = scale.empty() ? at.scale : glm::vec3(scale[0], scale[1], scale[2]);
    at.transform = RELIEF_TRY(placedBy(node, at.translation, at.rotation, at.scale));
    return at;
}

Result<void> linkNodes(std::vector<GltfNode>& nodes) {
    for (std::uint32_t index = 0; index < nodes.size(); ++index) {
        const GltfValue place = nodes[index].place;
        for (const std::uint64_t child : RELIEF_TRY(place.get<std::vector<std::uint64_t>>("children", {}))) {
            const std::string name = "nodes[" + std::to_string(child) + "]";
            if (child >= nodes.size()) {
                return place.wrong("has a missing child, " + name);
            }
            // Otherwise, n nodes could show a mesh 2ⁿ times.
            if (std::exchange(nodes[child].parent, index)) {
                return invalidInput(name + " has two parents; nodes must form trees");
            }
            nodes[index].children.push_back(static_cast<std::uint32_t>(child));
        }
    }
    return {};
}

/// Rejects a node that is a lower level of detail of itself, also through children: no level would be shown.
Result<void> checkLevels(const std::vector<GltfNode>& nodes,
                         const std::vector<std::vector<std::uint32_t>>& levels) {
    enum class State : std::uint8_t { kNew, kOpen, kDone };
    std::vector<State> states(nodes.size(), State::kNew);
    std::vector<std::pair<std::uint32_t, std::size_t>> path;  // nodes, each with its next successor
    for (std::uint32_t first = 0; first < nodes.size(); ++first) {
        if (states[first] == State::kNew) {
            states[first] = State::kOpen;
            path.emplace_back(first, 0);
        }
        while (!path.empty()) {
            const std::uint32_t node = path.back().first;
            const std::size_t at = path.back().second++;
            const std::vector<std::uint32_t>& children = nodes[node].children;
            if (at == children.size() + levels[node].size()) {
                states[node] = State::kDone;
                path.pop_back();
                continue;
            }
            const std::uint32_t next =
                at < children.size() ? children[at] : levels[node][at - children.size()];
            if (states[next] == State::kOpen) {
                return nodes[next].place.wrong(
                    "is a lower level of detail of itself (MSFT_lod), so no level is shown; remove its "
                    "index from the ids, or use --hidden keep");
            }
            if (states[next] == State::kNew) {
                states[next] = State::kOpen;
                path.emplace_back(next, 0);
            }
        }
    }
    return {};
}

/// Hides the descendants of hidden nodes. \param all  nodes, parents first.
void hideBelow(const std::vector<std::uint32_t>& all, std::vector<GltfNode>& nodes) {
    for (const std::uint32_t index : all) {
        const Shown above = nodes[index].parent ? nodes[*nodes[index].parent].shown : Shown::kYes;
        nodes[index].shown = above == Shown::kYes ? nodes[index].shown : above;
    }
}

/// Marks the nodes that extensions hide, with their descendants. Lower levels of detail are usually not part of a
/// scene.
Result<void> hideNodes(const std::vector<std::uint32_t>& all, HiddenMode hidden,
                       std::vector<GltfNode>& nodes) {
    for (GltfNode& node : nodes) {
        const auto visibility = RELIEF_TRY(extensionOf(node.place, "KHR_node_visibility"));
        if (visibility && !RELIEF_TRY(visibility->get<bool>("visible", true))) {
            node.shown = Shown::kHidden;
        }
    }
    hideBelow(all, nodes);
    std::vector<std::vector<std::uint32_t>> lower_levels(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto levels = RELIEF_TRY(extensionOf(nodes[i].place, "MSFT_lod"));
        using Indices = std::vector<std::uint64_t>;
        bool has_higher = nodes[i].shown != Shown::kHidden;  // a more detailed level is shown
        for (const std::uint64_t level : levels ? RELIEF_TRY(levels->get<Indices>("ids", {})) : Indices()) {
            if (level >= nodes.size()) {
                return levels->wrong("references nodes[" + std::to_string(level) + "], which does not exist");
            }
            if (level != i) {
                lower_levels[i].push_back(static_cast<std::uint32_t>(level));
                Shown& shown = nodes[level].shown;
                if (shown != Shown::kHidden) {
                    shown = has_higher ? Shown::kLowerLevel : shown;
                    has_higher = true;
                }
            }
        }
    }
    RELIEF_TRY(hidden == HiddenMode::kKeep ? Result<void>() : checkLevels(nodes, lower_levels));
    hideBelow(all, nodes);
    return {};
}

/// Returns an empty list if the attribute is missing.
template <class T>
Result<std::vector<T>> instanceValues(const GltfValue& attributes, const char* name, GltfUse use,
                                      GltfBuffers& buffers, std::uint64_t count_max) {
    const std::optional<GltfValue> accessor = RELIEF_TRY(attributes.named(name, "accessors"));
    return accessor ? readAccessor<T>(*accessor, use, buffers, count_max)
                    : Result<std::vector<T>>(std::vector<T>());
}

}  // namespace

Result<void> checkGltf(const GltfValue& document, std::vector<std::string>& warnings) {
    RELIEF_TRY(checkVersion(document));
    if (animatesVisibility(document).value_or(false)) {
        warnings.emplace_back(kAnimatedVisibility);
    }
    using Names = std::vector<std::string>;
    for (const std::string& name : RELIEF_TRY(document.get<Names>("extensionsRequired", {}))) {
        const bool known = name.starts_with("KHR_materials_") || name.starts_with("KHR_xmp") ||
                           std::ranges::find(kKnown, name) != kKnown.end();
        if (!known) {
            return fail(ErrorCode::kUnsupported,
                        "it requires the extension '" + cleanUtf8(name, 100) +
                            "', which is not supported; export the file without the extension");
        }
    }
    return {};
}

Result<std::vector<GltfNode>> readGltfNodes(const GltfValue& document, HiddenMode hidden) {
    std::vector<GltfNode> nodes;
    for (const GltfValue& place : RELIEF_TRY(document.objects("nodes"))) {
        GltfNode& node = nodes.emplace_back(GltfNode{place});
        node.name = RELIEF_TRY(place.get<std::string>("name", ""));
        node.at = RELIEF_TRY(placementOf(place));
        node.mesh = RELIEF_TRY(place.named("mesh", "meshes"));
        node.skin = RELIEF_TRY(place.named("skin", "skins"));
    }
    RELIEF_TRY(linkNodes(nodes));
    // A node has at most one parent, so nodes that no root reaches form a cycle or are below one.
    const std::vector<std::uint32_t> all = nodesBelow(rootsOf(nodes), nodes);
    if (all.size() != nodes.size()) {
        return invalidInput("its nodes contain a cycle; nodes must form trees");
    }
    RELIEF_TRY(hideNodes(all, hidden, nodes));
    return nodes;
}

Result<std::vector<std::uint32_t>> gltfRoots(const GltfValue& document, const std::vector<GltfNode>& nodes) {
    const std::vector<GltfValue> scenes = RELIEF_TRY(document.objects("scenes"));
    const std::uint64_t shown = RELIEF_TRY(document.get<std::uint64_t>("scene", 0));
    if (scenes.empty()) {
        return invalidInput("it has no scene, so it shows nothing; export it with a scene");
    }
    const GltfValue scene = RELIEF_TRY(document.at(shown, "scenes", "scene"));
    std::vector<std::uint32_t> roots;
    std::set<std::uint64_t> seen;
    for (const std::uint64_t root : RELIEF_TRY(scene.get<std::vector<std::uint64_t>>("nodes", {}))) {
        if (root >= nodes.size() || nodes[root].parent || !seen.insert(root).second) {
            return scene.wrong("references nodes[" + std::to_string(root) +
                               "], which does not exist, has a parent, or is listed twice");
        }
        roots.push_back(static_cast<std::uint32_t>(root));
    }
    return roots;
}

std::vector<std::uint32_t> rootsOf(const std::vector<GltfNode>& nodes) {
    std::vector<std::uint32_t> roots;
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
        if (!nodes[i].parent) {
            roots.push_back(i);
        }
    }
    return roots;
}

std::vector<std::uint32_t> nodesBelow(const std::vector<std::uint32_t>& roots,
                                      const std::vector<GltfNode>& nodes) {
    std::vector<std::uint32_t> below;
    std::vector<std::uint32_t> pending(roots.rbegin(), roots.rend());
    while (!pending.empty()) {
        below.push_back(pending.back());
        const std::vector<std::uint32_t>& children = nodes[pending.back()].children;
        pending.pop_back();
        pending.insert(pending.end(), children.rbegin(), children.rend());
    }
    return below;
}

Transform transformInScene(const std::vector<GltfNode>& nodes, std::uint32_t index) {
    Transform transform = nodes[index].at.transform;
    for (auto above = nodes[index].parent; above; above = nodes[*above].parent) {
        transform = nodes[*above].at.transform * transform;
    }
    return transform;
}

std::optional<Transform> affineOf(const float* m) {
    for (const int i : {3, 7, 11, 15}) {
        if (!(std::abs(m[i] - (i == 15 ? 1.0F : 0.0F)) <= kRowTolerance)) {
            return std::nullopt;
        }
    }
    return Transform{glm::dmat3(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]),
                     {m[12], m[13], m[14]}};
}

Result<std::optional<SurfaceResponse>> readSurfaceResponse(const GltfValue& document, const GltfNode& node,
                                                           std::vector<std::string>& warnings) {
    constexpr const char* kPhysics = "KHR_physics_rigid_bodies";
    const auto physics = RELIEF_TRY(extensionOf(node.place, kPhysics));
    const auto collider = physics ? RELIEF_TRY(physics->object("collider")) : std::nullopt;
    const auto index = collider ? RELIEF_TRY(collider->get<std::uint64_t>("physicsMaterial")) : std::nullopt;
    if (!index) {
        return std::nullopt;
    }
    const auto lists = RELIEF_TRY(extensionOf(document, kPhysics));
    const std::vector<GltfValue> all =
        lists ? RELIEF_TRY(lists->objects("physicsMaterials")) : std::vector<GltfValue>();
    if (*index >= all.size()) {
        return collider->wrong("has the physicsMaterial " + std::to_string(*index) + ", but there are " +
                               std::to_string(all.size()));
    }
    const GltfValue& material = all[*index];
    SurfaceResponse response;
    response.name = RELIEF_TRY(material.get<std::string>("name", ""));
    // Defaults of the extension's schema.
    response.restitution = RELIEF_TRY(material.get<float>("restitution", 0.0F));
    response.friction = RELIEF_TRY(material.get<float>("dynamicFriction", 0.6F));
    for (float* factor : {&response.restitution, &response.friction}) {
        if (!(*factor >= 0.0F)) {
            return material.wrong("has a restitution or a dynamicFriction below 0");
        }
        *factor = std::min(*factor, 1.0F);
    }
    for (const char* name : {"frictionCombine", "restitutionCombine"}) {
        const auto mode = RELIEF_TRY(material.get<std::string>(name, "average"));
        if (mode != "average" && mode != "multiply") {
            warnOnce(warnings,
                     "physics materials have a frictionCombine or restitutionCombine of minimum or maximum, "
                     "which has no effect: their values multiply those of a particle");
        }
    }
    return response;
}

Result<std::optional<std::vector<Transform>>> gltfInstances(const GltfNode& node, GltfBuffers& buffers,
                                                            std::uint64_t& left) {
    const auto instancing = RELIEF_TRY(extensionOf(node.place, "EXT_mesh_gpu_instancing"));
    if (!instancing) {
        return std::nullopt;
    }
    const std::optional<GltfValue> attributes = RELIEF_TRY(instancing->object("attributes"));
    if (!attributes) {
        return instancing->wrong("has no attributes");
    }
    const auto moves =
        RELIEF_TRY(instanceValues<glm::vec3>(*attributes, "TRANSLATION", GltfUse::kVectors, buffers, left));
    const auto turns =
        RELIEF_TRY(instanceValues<glm::vec4>(*attributes, "ROTATION", GltfUse::kRotations, buffers, left));
    const auto scales =
        RELIEF_TRY(instanceValues<glm::vec3>(*attributes, "SCALE", GltfUse::kVectors, buffers, left));
    const std::size_t count = std::max({moves.size(), turns.size(), scales.size()});
    for (const std::size_t size : {moves.size(), turns.size(), scales.size()}) {
        if (size != count && size != 0) {
            return attributes->wrong("have different counts of TRANSLATION, ROTATION and SCALE");
        }
    }
    if (count == 0) {
        return attributes->wrong("have none of TRANSLATION, ROTATION and SCALE");
    }
    left -= count;
    std::vector<Transform> instances;
    for (std::size_t i = 0; i < count; ++i) {
        instances.push_back(RELIEF_TRY(placedBy(*attributes, moves.empty() ? glm::vec3(0.0F) : moves[i],
                                                turns.empty() ? glm::vec4(0, 0, 0, 1) : turns[i],
                                                scales.empty() ? glm::vec3(1.0F) : scales[i])));
    }
    return instances;
}

}  // namespace relief
