// SPDX-License-Identifier: Apache-2.0
// The step of shaders/particles/step.glsl on the CPU: float32, the same operations in the same order, with the field
// from formats/. An independent implementation of the rule (paper, section 3.3.2), and the truth for the GPU.
#pragma once

#include <cmath>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "formats/collider.h"
#include "formats/world/pose.h"
#include "runtime/particles/particle_system.h"

namespace relief {

/// A collider with its poses at the start and end of a step.
struct ReferenceBody {
    const Collider* collider = nullptr;
    Pose before;
    Pose now;
    float restitution = 1.0F;
    float friction = 0.0F;
};

struct ReferenceSettings {
    std::vector<ReferenceBody> bodies;
    std::optional<float> ground;
    Forces forces;
    ParticleType type;
    float dt = 0.0F;
};

struct ReferenceState {
    glm::vec3 position{0.0F};
    glm::vec3 velocity{0.0F};
    Contact contact = Contact::kNone;
    /// True if P_prev or P* lies within the tolerance of a border between texels or cube faces, the edge of a volume,
    /// or a vote of 0, so that another rounding may change the decision.
    bool ambiguous = false;
};

inline float dot(const glm::vec3& a, const glm::vec3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Tolerance of decisions: texels for borders, fractions of a volume for its ends and for votes.
inline constexpr float kTexelTolerance = 1e-3F;
inline constexpr float kVolumeTolerance = 1e-6F;

inline bool isAmbiguous(const Collider& collider, const glm::vec3& p) {
    const auto nearInteger = [](float x) { return std::abs(x - std::round(x)) < kTexelTolerance; };
    for (const DepthMap& map : collider.maps) {
        const glm::vec3 q = map.object_to_map.apply(p);
        if (map.projection() == Projection::kCube) {
            const float a[3] = {std::abs(q.x), std::abs(q.y), std::abs(q.z)};
            const CubeCoordinates at = cubeCoordinates(q);
            const auto size = static_cast<float>(map.width);
            for (int i = 0; i < 3; ++i) {
                if (std::abs(a[i] - a[(i + 1) % 3]) < kVolumeTolerance * 10.0F ||
                    std::abs(a[i] - 1.0F) < kVolumeTolerance) {
                    return true;
                }
            }
            if (nearInteger(at.s * size) || nearInteger(at.t * size)) {
                return true;
            }
        } else if (nearInteger(q.x * static_cast<float>(map.width)) ||
                   nearInteger(q.y * static_cast<float>(map.height)) || std::abs(q.z) < kVolumeTolerance ||
                   std::abs(q.z - 1.0F) < kVolumeTolerance) {
            return true;
        }
        const std::optional<Vote> v = vote(map, p);
        if (v && std::abs(v->distance) < 4.0F * kVolumeTolerance * collider.bounds.longestSide()) {
            return true;
        }
    }
    return false;
}

/// The solid at a point, and the way out: body −1 is the floor, −2 none.
struct ReferenceSolid {
    float distance = 1e30F;
    glm::vec3 normal{0.0F};
    int body = -2;
};

/// The solid of a body in a pose.
inline ReferenceSolid solidOf(const ReferenceBody& body, int number, const Pose& pose, const glm::vec3& p) {
    const FieldSample field = evaluate(*body.collider, toObject(pose, p));
    return field.inside() ? ReferenceSolid{pose.scale * field.distance, pose.rotation * field.normal, number}
                          : ReferenceSolid{};
}

/// The union of all bodies and the floor; the deepest decides.
/// \param rivals  number of solids equally deep, within the tolerance.
inline ReferenceSolid solidAt(const ReferenceSettings& settings, const glm::vec3& p, int* rivals = nullptr) {
    std::vector<ReferenceSolid> all(1);
    for (std::size_t i = 0; i < settings.bodies.size(); ++i) {
        all.push_back(solidOf(settings.bodies[i], static_cast<int>(i), settings.bodies[i].now, p));
    }
    if (settings.ground) {
        all.push_back({p.y - *settings.ground, glm::vec3(0.0F, 1.0F, 0.0F), -1});
    }
    ReferenceSolid best = all.front();
    for (const ReferenceSolid& one : all) {
        best = one.distance < best.distance ? one : best;
    }
    const float hair = kVolumeTolerance * (2.0F + std::abs(settings.ground.value_or(0.0F)));
    for (const ReferenceSolid& one : all) {
        if (rivals != nullptr && std::abs(one.distance - best.distance) < hair) {
            ++*rivals;
        }
    }
    return best;
}

/// True if the step began inside the solid that it collided with.
inline bool wasInside(const ReferenceSettings& settings, const ReferenceSolid& solid, const glm::vec3& p) {
    if (solid.body < 0) {
        return p.y < *settings.ground;
    }
    const ReferenceBody& body = settings.bodies[static_cast<std::size_t>(solid.body)];
    return solidOf(body, 0, body.before, p).distance < 0.0F;
}

inline ReferenceState referenceStep(const ReferenceSettings& settings, const glm::vec3& p,
                                    const glm::vec3& v_before) {
    const float dt = settings.dt;
    const ParticleType& type = settings.type;
    const float drag = dragRate(settings.forces, type);
    const glm::vec3 gravity = type.gravity * settings.forces.gravity;
    glm::vec3 v = (v_before + dt * (gravity + drag * settings.forces.wind)) * (1.0F / (1.0F + dt * drag));
    const glm::vec3 p_star = p + dt * v;

    ReferenceState out;
    out.position = p_star;
    // Ambiguous: which body is deepest, and the side of the floor.
    int rivals = 0;
    const ReferenceSolid ahead = solidAt(settings, p_star, &rivals);
    out.ambiguous = ahead.distance < 0.0F && rivals > 1;
    for (const ReferenceBody& body : settings.bodies) {
        out.ambiguous = out.ambiguous || isAmbiguous(*body.collider, toObject(body.now, p_star)) ||
                        isAmbiguous(*body.collider, toObject(body.before, p));
    }
    if (settings.ground) {
        const float hair = kVolumeTolerance * (2.0F + std::abs(*settings.ground));
        out.ambiguous = out.ambiguous || std::abs(p_star.y - *settings.ground) < hair ||
                        std::abs(p.y - *settings.ground) < hair;
    }
    if (ahead.distance < 0.0F) {
        const glm::vec3 n = ahead.normal;
        const ReferenceBody body =
            ahead.body >= 0 ? settings.bodies[static_cast<std::size_t>(ahead.body)] : ReferenceBody{};
        const glm::vec3 carried = (p_star - toWorld(body.before, toObject(body.now, p_star))) / dt;
        const glm::vec3 relative = v - carried;
        const float vn = dot(relative, n);
        if (wasInside(settings, ahead, p)) {
            out.contact = Contact::kCaught;
            if (vn < 0.0F) {
                v = v - (2.0F * vn) * n;
            }
            out.ambiguous = out.ambiguous || std::abs(vn) < 1e-5F;
        } else {
            out.contact = Contact::kCollided;
            const glm::vec3 along = relative - vn * n;
            const float threshold = type.friction_threshold;
            const float still = 1e-3F * dt * glm::length(gravity);
            const float speed = dot(relative, relative);
            const float slide =
                speed >= threshold * threshold ? (1.0F - type.friction) * (1.0F - body.friction) : 1.0F;
            const float arrives = std::min(std::max(-dot(v_before - carried, n), 0.0F), std::abs(vn));
            const glm::vec3 left = slide * along + (type.restitution * body.restitution * arrives) * n;
            v = carried + (dot(left, left) > still * still ? left : glm::vec3(0.0F));
            out.ambiguous = out.ambiguous || std::abs(glm::length(left) - still) < 1e-3F * still;
            out.ambiguous = out.ambiguous || std::abs(speed - threshold * threshold) < 1e-5F;
        }
        out.position = p + dt * v;
    }
    out.velocity = v;
    return out;
}

}  // namespace relief
