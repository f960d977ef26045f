// SPDX-License-Identifier: Apache-2.0
#include "tests/formats/animation/animated_meshes.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <random>

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

AnimatedMesh movingBox(const glm::vec3& half) {
    AnimatedMesh mesh;
    for (int corner = 0; corner < 8; ++corner) {
        mesh.positions.emplace_back((corner & 1) != 0 ? half.x : -half.x,
                                    (corner & 2) != 0 ? half.y : -half.y,
                                    (corner & 4) != 0 ? half.z : -half.z);
        mesh.influence_begin.push_back(static_cast<std::uint32_t>(corner));
        mesh.influences.push_back({0, 1.0F});
    }
    mesh.influence_begin.push_back(8);
    mesh.delta_begin.assign(9, 0);
    for (const glm::uvec4& face : {glm::uvec4(0, 4, 6, 2), glm::uvec4(1, 3, 7, 5), glm::uvec4(0, 1, 5, 4),
                                   glm::uvec4(2, 6, 7, 3), glm::uvec4(0, 2, 3, 1), glm::uvec4(4, 5, 7, 6)}) {
        mesh.triangles.emplace_back(face.x, face.y, face.z);
        mesh.triangles.emplace_back(face.x, face.z, face.w);
    }
    mesh.nodes.push_back({.name = "box"});
    mesh.joints.push_back({0, {}});
    const float half_turn = std::sqrt(0.5F);
    mesh.clips.push_back(
        {"go", 1.0F, {{0, NodeMember::kTranslation, KeyCurve::kLinear, {0.0F, 1.0F}, {0, 0, 0, 1, 0, 0}}}});
    mesh.clips.push_back({"turn",
                          1.0F,
                          {{0,
                            NodeMember::kRotation,
                            KeyCurve::kLinear,
                            {0.0F, 1.0F},
                            {0, 0, 0, 1, 0, half_turn, 0, half_turn}}}});
    return mesh;
}

double windingNumber(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                     const glm::dvec3& p) {
    double sum = 0.0;
    for (const glm::uvec3& t : triangles) {
        const glm::dvec3 a = glm::dvec3(positions[t.x]) - p;
        const glm::dvec3 b = glm::dvec3(positions[t.y]) - p;
        const glm::dvec3 c = glm::dvec3(positions[t.z]) - p;
        const double la = glm::length(a);
        const double lb = glm::length(b);
        const double lc = glm::length(c);
        sum += std::atan2(glm::dot(a, glm::cross(b, c)),
                          la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }
    return sum / (2.0 * std::numbers::pi);
}

std::vector<glm::vec3> pointsNear(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                                  std::size_t count, float size, std::uint32_t seed) {
    std::vector<double> areas;
    for (const glm::uvec3& t : triangles) {
        areas.push_back(double{
            glm::length(glm::cross(positions[t.y] - positions[t.x], positions[t.z] - positions[t.x]))});
    }
    std::mt19937 random(seed);
    std::discrete_distribution<std::size_t> any(areas.begin(), areas.end());
    std::uniform_real_distribution<float> unit(0.0F, 1.0F);
    std::normal_distribution<float> off(0.0F, 0.005F * size);
    std::vector<glm::vec3> points;
    while (points.size() < count) {
        const glm::uvec3& t = triangles[any(random)];
        const float u = unit(random);
        const float v = unit(random);
        glm::vec3 away;
        for (int k = 0; k < 3; ++k) {
            away[k] = off(random);
        }
        if (u + v <= 1.0F) {
            points.push_back(positions[t.x] + u * (positions[t.y] - positions[t.x]) +
                             v * (positions[t.z] - positions[t.x]) + away);
        }
    }
    return points;
}

}  // namespace relief
