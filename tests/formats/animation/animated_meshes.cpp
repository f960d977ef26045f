#include "tests/formats/animation/animated_meshes.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

namespace relief {

AnimatedMesh bendingTube(int around, int rings) {
    constexpr float kRadius = 0.1F;
    constexpr float kHeight = 2.0F;
    AnimatedMesh mesh;
    const auto add = [&](float radius, float angle, float y) {
        const glm::vec3 out(std::cos(angle), 0.0F, std::sin(angle));
        mesh.positions.push_back(radius * out + glm::vec3(0, y, 0));
        mesh.influence_begin.push_back(static_cast<std::uint32_t>(mesh.influences.size()));
        const float upper = std::clamp((y / kHeight - 0.5F) * 3.0F + 0.5F, 0.0F, 1.0F);
        if (upper < 1.0F) {
            mesh.influences.push_back({0, 1.0F - upper});
        }
        if (upper > 0.0F) {
            mesh.influences.push_back({1, upper});
        }
        mesh.delta_begin.push_back(static_cast<std::uint32_t>(mesh.deltas.size()));
        if (radius > 0.0F) {
            mesh.deltas.push_back({0, radius * out});
        }
    };
    const auto at = [&](int ring, int k) { return static_cast<std::uint32_t>(ring * around + k % around); };
    for (int ring = 0; ring <= rings; ++ring) {
        for (int k = 0; k < around; ++k) {
            add(kRadius,
                2.0F * std::numbers::pi_v<float> * static_cast<float>(k) / static_cast<float>(around),
                kHeight * static_cast<float>(ring) / static_cast<float>(rings));
        }
    }
    add(0.0F, 0.0F, 0.0F);
    add(0.0F, 0.0F, kHeight);
    const auto foot = static_cast<std::uint32_t>(mesh.positions.size() - 2);
    for (int k = 0; k < around; ++k) {
        for (int ring = 0; ring < rings; ++ring) {
            mesh.triangles.emplace_back(at(ring, k), at(ring + 1, k), at(ring + 1, k + 1));
            mesh.triangles.emplace_back(at(ring, k), at(ring + 1, k + 1), at(ring, k + 1));
        }
        mesh.triangles.emplace_back(foot, at(0, k), at(0, k + 1));
        mesh.triangles.emplace_back(foot + 1, at(rings, k + 1), at(rings, k));
    }
    mesh.influence_begin.push_back(static_cast<std::uint32_t>(mesh.influences.size()));
    mesh.delta_begin.push_back(static_cast<std::uint32_t>(mesh.deltas.size()));

    mesh.nodes.push_back({.name = "foot", .first_weight = 0, .weights = 1});
    mesh.nodes.push_back({.name = "middle", .parent = 0, .translation = {0.0F, 0.5F * kHeight, 0.0F}});
    mesh.joints.push_back({0, {}});
    mesh.joints.push_back({1, {{{1, 0, 0, 0}, {0, 1, 0, -0.5F * kHeight}, {0, 0, 1, 0}}}});
    mesh.weights = {0.0F};
    const float half = std::sqrt(0.5F);
    mesh.clips.push_back({"bend",
                          2.0F,
                          {{1,
                            NodeMember::kRotation,
                            KeyCurve::kLinear,
                            {0.0F, 1.0F, 2.0F},
                            {0, 0, 0, 1, 0, 0, half, half, 0, 0, 0, 1}}}});
    mesh.clips.push_back(
        {"grow", 1.0F, {{0, NodeMember::kWeights, KeyCurve::kLinear, {0.0F, 1.0F}, {0, 1}}}});
    return mesh;
}

}  // namespace relief
