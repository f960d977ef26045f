// SPDX-License-Identifier: Apache-2.0
#include "formats/animation/animated_mesh.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <set>
#include <utility>

#include "formats/base/finite.h"
#include "formats/base/text.h"

namespace relief {
namespace {

constexpr float kWeightSumTolerance = 1e-5F;
constexpr float kUnitTolerance = 1e-3F;

tl::unexpected<Error> wrong(const char* list, std::size_t index, const std::string& fault) {
    return invalidInput("animation." + std::string(list) + "[" + std::to_string(index) + "] " + fault);
}

Result<void> atMost(const char* list, std::size_t count, std::size_t most) {
    if (count <= most) {
        return {};
    }
    return fail(ErrorCode::kLimit, "animation." + std::string(list) + " has " + std::to_string(count) +
                                       " entries; at most " + std::to_string(most) + " are allowed");
}

bool areFinite(const std::vector<float>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](float number) { return std::isfinite(number); });
}

bool isName(std::string_view name) {
    return name.size() <= kAnimatedNameMax && cleanUtf8(name) == name;
}

/// Returns whether `begin` is a list of offsets with one more entry than there are vertices, ascending from 0 to
/// `count`.
bool areOffsets(const std::vector<std::uint32_t>& begin, std::size_t vertices, std::size_t count) {
    return begin.size() == vertices + 1 && begin.front() == 0 && begin.back() == count &&
           std::is_sorted(begin.begin(), begin.end());
}

Result<void> checkTriangles(const AnimatedMesh& mesh) {
    RELIEF_TRY(atMost("positions", mesh.positions.size(), kAnimatedVerticesMax));
    if (mesh.positions.empty() || mesh.triangles.empty()) {
        return invalidInput("animation has no triangles");
    }
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        if (!isFinite(mesh.positions[i])) {
            return wrong("positions", i, "is not finite");
        }
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const glm::uvec3& t = mesh.triangles[i];
        if (std::max({t.x, t.y, t.z}) >= mesh.positions.size()) {
            return wrong("triangles", i, "has a corner that does not exist");
        }
    }
    return {};
}

Result<void> checkMaterials(const AnimatedMesh& mesh) {
    RELIEF_TRY(atMost("materials", mesh.materials.size(), kMeshMaterialsMax));
    std::set<std::string> names;
    for (std::size_t i = 0; i < mesh.materials.size(); ++i) {
        if (!isName(mesh.materials[i]) || !names.insert(mesh.materials[i]).second) {
            return wrong("materials", i, "has a name that is too long, not clean UTF-8, or not unique");
        }
    }
    if (mesh.triangle_materials.size() != (mesh.materials.empty() ? 0 : mesh.triangles.size())) {
        return invalidInput("animation.triangle_materials does not have one entry per triangle");
    }
    for (std::size_t i = 0; i < mesh.triangle_materials.size(); ++i) {
        if (mesh.triangle_materials[i] >= mesh.materials.size()) {
            return wrong("triangle_materials", i, "is not the index of a material");
        }
    }
    return {};
}

Result<void> checkInfluences(const AnimatedMesh& mesh) {
    if (!areOffsets(mesh.influence_begin, mesh.positions.size(), mesh.influences.size())) {
        return invalidInput("animation.influence_begin does not ascend from 0 to the number of influences");
    }
    for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
        const std::uint32_t begin = mesh.influence_begin[vertex];
        const std::uint32_t end = mesh.influence_begin[vertex + 1];
        if (begin == end || end - begin > kVertexInfluencesMax) {
            return wrong("positions", vertex,
                         "has no joints, or more than " + std::to_string(kVertexInfluencesMax));
        }
        double sum = 0.0;
        for (std::uint32_t i = begin; i < end; ++i) {
            const VertexInfluence& influence = mesh.influences[i];
            if (influence.joint >= mesh.joints.size() || !(influence.weight > 0.0F)) {
                return wrong("influences", i,
                             "refers to a missing joint, or has a weight that is not above 0");
            }
            sum += double{influence.weight};
        }
        if (!(std::abs(sum - 1.0) <= double{kWeightSumTolerance})) {
            return wrong("positions", vertex, "has weights that do not sum to 1");
        }
    }
    return {};
}

Result<void> checkWeights(const AnimatedMesh& mesh) {
    RELIEF_TRY(atMost("weights", mesh.weights.size(), kMorphTargetsMax));
    return areFinite(mesh.weights) ? Result<void>() : invalidInput("animation.weights are not finite");
}

Result<void> checkDeltas(const AnimatedMesh& mesh) {
    if (!areOffsets(mesh.delta_begin, mesh.positions.size(), mesh.deltas.size())) {
        return invalidInput("animation.delta_begin does not ascend from 0 to the number of deltas");
    }
    for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
        for (std::uint32_t i = mesh.delta_begin[vertex]; i < mesh.delta_begin[vertex + 1]; ++i) {
            const MorphDelta& delta = mesh.deltas[i];
            if (delta.target >= mesh.weights.size() || !isFinite(delta.delta)) {
                return wrong("deltas", i, "refers to a missing target, or is not finite");
            }
            if (i > mesh.delta_begin[vertex] && delta.target <= mesh.deltas[i - 1].target) {
                return wrong("deltas", i, "is not in ascending order of targets");
            }
        }
    }
    return {};
}

Result<void> checkNodes(const AnimatedMesh& mesh) {
    RELIEF_TRY(atMost("nodes", mesh.nodes.size(), kMeshNodesMax));
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
        const MeshNode& node = mesh.nodes[i];
        if (node.parent < -1 || node.parent >= static_cast<std::int64_t>(i)) {
            return wrong("nodes", i, "has a parent that does not come before it");
        }
        if (!isName(node.name)) {
            return wrong("nodes", i, "has a name that is too long or not clean UTF-8");
        }
        const double length = std::sqrt(double{glm::dot(node.rotation, node.rotation)});
        if (!isFinite(node.translation) || !isFinite(node.scale) ||
            !(std::abs(length - 1.0) <= double{kUnitTolerance}) ||
            (node.matrix && !node.matrix->isFinite())) {
            return wrong("nodes", i,
                         "has a transform that is not finite, or whose rotation is not a unit quaternion");
        }
        if (node.first_weight > mesh.weights.size() ||
            node.weights > mesh.weights.size() - node.first_weight) {
            return wrong("nodes", i, "has morph targets that do not exist");
        }
    }
    return {};
}

Result<void> checkJoints(const AnimatedMesh& mesh) {
    RELIEF_TRY(atMost("joints", mesh.joints.size(), kMeshJointsMax));
    for (std::size_t i = 0; i < mesh.joints.size(); ++i) {
        if (mesh.joints[i].node >= mesh.nodes.size() || !mesh.joints[i].bind.isFinite()) {
            return wrong("joints", i, "refers to a missing node, or has a transform that is not finite");
        }
    }
    return {};
}

/// Returns the problem of a channel, or "".
std::string channelFault(const AnimatedMesh& mesh, const MeshClip& clip, const ClipChannel& channel) {
    if (channel.node >= mesh.nodes.size() || channel.member > NodeMember::kWeights ||
        channel.curve > KeyCurve::kCubic) {
        return "refers to an unknown node, member or curve";
    }
    const MeshNode& node = mesh.nodes[channel.node];
    if (channel.member == NodeMember::kWeights ? node.weights == 0 : node.matrix.has_value()) {
        return "animates a member that the node does not have";
    }
    const std::size_t numbers = keyNumbers(mesh, channel) * (channel.curve == KeyCurve::kCubic ? 3 : 1);
    if (channel.times.empty() || channel.values.size() / numbers != channel.times.size() ||
        channel.values.size() % numbers != 0) {
        return "has no keys, or values that do not match its times";
    }
    if (!areFinite(channel.times) || !areFinite(channel.values) || !(channel.times.front() >= 0.0F) ||
        !(channel.times.back() <= clip.seconds)) {
        return "has keys that are not finite, or not within the clip";
    }
    if (std::adjacent_find(channel.times.begin(), channel.times.end(), std::greater_equal<>()) !=
        channel.times.end()) {
        return "has times that do not ascend";
    }
    return "";
}

Result<void> checkClips(const AnimatedMesh& mesh) {
    RELIEF_TRY(atMost("clips", mesh.clips.size(), kMeshClipsMax));
    std::set<std::string> names;
    for (std::size_t i = 0; i < mesh.clips.size(); ++i) {
        const MeshClip& clip = mesh.clips[i];
        if (clip.name.empty() || !isName(clip.name) || !names.insert(clip.name).second) {
            return wrong("clips", i, "has a name that is empty, too long, not clean UTF-8, or not unique");
        }
        if (!(clip.seconds > 0.0F && clip.seconds <= kClipSecondsMax)) {
            return wrong("clips", i, "has a duration of 0 or of more than a day");
        }
        std::set<std::pair<std::uint32_t, NodeMember>> moved;
        for (const ClipChannel& channel : clip.channels) {
            std::string fault = channelFault(mesh, clip, channel);
            if (fault.empty() && !moved.emplace(channel.node, channel.member).second) {
                fault = "animates the same member as another channel";
            }
            if (!fault.empty()) {
                return wrong("clips", i, "has a channel that " + fault);
            }
        }
    }
    return {};
}

}  // namespace

std::size_t keyNumbers(const AnimatedMesh& mesh, const ClipChannel& channel) {
    switch (channel.member) {
        case NodeMember::kRotation:
            return 4;
        case NodeMember::kWeights:
            return mesh.nodes[channel.node].weights;
        default:
            return 3;
    }
}

Result<void> validate(const AnimatedMesh& mesh) {
    RELIEF_TRY(checkTriangles(mesh));
    RELIEF_TRY(checkMaterials(mesh));
    RELIEF_TRY(checkJoints(mesh));
    RELIEF_TRY(checkInfluences(mesh));
    RELIEF_TRY(checkDeltas(mesh));
    return validateClips(mesh);
}

Result<void> validateClips(const AnimatedMesh& mesh) {
    RELIEF_TRY(checkWeights(mesh));
    RELIEF_TRY(checkNodes(mesh));
    return checkClips(mesh);
}

}  // namespace relief
