#include "bake/import/gltf_skin.h"

#include <array>
#include <string>

#include "bake/import/gltf_accessor.h"

namespace relief {
namespace {

constexpr std::uint64_t kJointsMax = 65536;
/// Names must be literals: a vertex has at most sixteen joints.
constexpr std::array<std::array<const char*, 2>, 4> kSets = {{{"JOINTS_0", "WEIGHTS_0"},
                                                              {"JOINTS_1", "WEIGHTS_1"},
                                                              {"JOINTS_2", "WEIGHTS_2"},
                                                              {"JOINTS_3", "WEIGHTS_3"}}};

/// Whether the weights of every vertex are 0 or more, and more than 0 in sum.
bool weigh(const GltfInfluences& influences) {
    for (std::size_t at = 0; at < influences.all.size(); at += influences.per_vertex) {
        double sum = 0.0;
        for (std::size_t k = 0; k < influences.per_vertex; ++k) {
            const float weight = influences.all[at + k].weight;
            if (!(weight >= 0.0F && weight <= 1e6F)) {
                return false;
            }
            sum += double{weight};
        }
        if (sum < 1e-6) {
            return false;
        }
    }
    return true;
}

}  // namespace

Result<std::optional<GltfInfluences>> readInfluences(const GltfValue& document, const GltfValue& attributes,
                                                     GltfBuffers& buffers, std::uint64_t vertices) {
    const GltfList accessors = RELIEF_TRY(document.objects("accessors"));
    std::vector<std::vector<float>> joints;
    std::vector<std::vector<float>> weights;
    for (const auto& [joints_name, weights_name] : kSets) {
        const std::optional<std::uint64_t> of_joints = RELIEF_TRY(attributes.whole(joints_name));
        const std::optional<std::uint64_t> of_weights = RELIEF_TRY(attributes.whole(weights_name));
        if (!of_joints && !of_weights) {
            break;
        }
        if (!of_joints || !of_weights) {
            return attributes.wrong(std::string("have only one of ") + joints_name + " and " + weights_name);
        }
        const GltfValue joints_of = RELIEF_TRY(accessors.named(*of_joints, attributes, joints_name));
        const GltfValue weights_of = RELIEF_TRY(accessors.named(*of_weights, attributes, weights_name));
        joints.push_back(RELIEF_TRY(readJoints(joints_of, buffers, vertices)));
        weights.push_back(RELIEF_TRY(readWeights(weights_of, buffers, vertices)));
        if (joints.back().size() != 4 * vertices || weights.back().size() != 4 * vertices) {
            return attributes.wrong(std::string("have other counts of ") + joints_name + ", " + weights_name +
                                    " and positions");
        }
    }
    if (joints.empty()) {
        return std::nullopt;
    }
    GltfInfluences influences;
    influences.per_vertex = 4 * joints.size();
    influences.all.reserve(influences.per_vertex * vertices);
    for (std::uint64_t vertex = 0; vertex < vertices; ++vertex) {
        for (std::size_t set = 0; set < joints.size(); ++set) {
            for (std::uint64_t k = 4 * vertex; k < 4 * vertex + 4; ++k) {
                influences.all.push_back({static_cast<std::uint32_t>(joints[set][k]), weights[set][k]});
            }
        }
    }
    if (!weigh(influences)) {
        return attributes.wrong(
            "have weights that are less than 0, no numbers, or 0 for all joints of a vertex");
    }
    return influences;
}

Result<std::vector<Transform>> readSkin(const GltfValue& document, std::uint64_t index,
                                        const std::vector<GltfNode>& nodes, GltfBuffers& buffers) {
    const GltfList skins = RELIEF_TRY(document.objects("skins"));
    const GltfValue skin = RELIEF_TRY(skins.at(index));
    const std::vector<std::uint64_t> joints = RELIEF_TRY(skin.wholes("joints"));
    if (joints.empty() || joints.size() > kJointsMax) {
        return skin.wrong("has no joints, or more than " + std::to_string(kJointsMax));
    }
    // Without them, each joint leaves vertices where it stands.
    std::vector<float> matrices;
    const std::optional<std::uint64_t> inverse = RELIEF_TRY(skin.whole("inverseBindMatrices"));
    if (inverse) {
        const GltfList accessors = RELIEF_TRY(document.objects("accessors"));
        const GltfValue accessor = RELIEF_TRY(accessors.named(*inverse, skin, "inverseBindMatrices"));
        matrices = RELIEF_TRY(readMatrices(accessor, buffers, kJointsMax));
        if (matrices.size() < 16 * joints.size()) {
            return skin.wrong("has fewer inverseBindMatrices than joints");
        }
    }
    std::vector<Transform> transforms;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        if (joints[i] >= nodes.size()) {
            return skin.wrong("names by joints nodes[" + std::to_string(joints[i]) +
                              "], which does not exist");
        }
        const Transform place = placeOf(nodes, joints[i]);
        const std::optional<Transform> bound =
            inverse ? affine(std::span(matrices).subspan(16 * i, 16)) : Transform();
        if (!bound) {
            return skin.wrong("has inverseBindMatrices whose last row is not 0 0 0 1");
        }
        transforms.push_back(place * *bound);
    }
    return transforms;
}

GltfPose posed(const std::vector<glm::vec3>& positions, const GltfInfluences& influences,
               const std::vector<Transform>& joints) {
    GltfPose pose;
    std::vector<bool> mirrors;
    for (const Transform& joint : joints) {
        mirrors.push_back(joint.mirrors());
    }
    double mirrored = 0.0;
    for (std::size_t vertex = 0; vertex < positions.size(); ++vertex) {
        glm::dvec3 sum(0.0);
        double weights = 0.0;
        for (std::size_t k = 0; k < influences.per_vertex; ++k) {
            const GltfInfluence& by = influences.all[vertex * influences.per_vertex + k];
            if (by.weight > 0.0F) {
                sum += double{by.weight} * joints[by.joint].apply(positions[vertex]);
                weights += double{by.weight};
                mirrored += mirrors[by.joint] ? double{by.weight} : -double{by.weight};
            }
        }
        pose.positions.emplace_back(sum / weights);
    }
    pose.mirrored = mirrored > 0.0;
    return pose;
}

}  // namespace relief
