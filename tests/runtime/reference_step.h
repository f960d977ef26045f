// The step of shaders/step.glsl on the CPU: float32, the same operations in the same order, the field from
// formats/. Written from the rule (paper, section 3.3.2), and the truth that the GPU
// is held to.
#pragma once

#include <cmath>
#include <glm/vec3.hpp>
#include <optional>

#include "formats/collider.h"
#include "runtime/particle_system.h"

namespace relief {

struct ReferenceSettings {
    const Collider* collider = nullptr;
    std::optional<float> ground;
    Forces forces;
    Collision collision;
    float dt = 0.0F;
};

struct ReferenceState {
    glm::vec3 position{0.0F};
    glm::vec3 velocity{0.0F};
    Contact contact = Contact::kNone;
    /// Some decision hung by a hair: P_prev or P* lies closer than the tolerance to a border between texels
    /// or cube faces, to the edge of a volume, or to a vote of 0, so that another rounding may decide
    /// otherwise.
    bool ambiguous = false;
};

inline float dot(const glm::vec3& a, const glm::vec3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// How near to a decision counts as a hair: texels for borders, parts of a volume for its ends and for votes.
inline constexpr float kTexelHair = 1e-3F;
inline constexpr float kVolumeHair = 1e-6F;

inline bool isAmbiguous(const Collider& collider, const glm::vec3& p) {
    const auto nearInteger = [](float x) { return std::abs(x - std::round(x)) < kTexelHair; };
    for (const DepthMap& map : collider.maps) {
        const glm::vec3 q = map.object_to_map.apply(p);
        if (map.projection() == Projection::kCube) {
            const float a[3] = {std::abs(q.x), std::abs(q.y), std::abs(q.z)};
            const CubeCoordinates at = cubeCoordinates(q);
            const auto size = static_cast<float>(map.width);
            for (int i = 0; i < 3; ++i) {
                if (std::abs(a[i] - a[(i + 1) % 3]) < kVolumeHair * 10.0F ||
                    std::abs(a[i] - 1.0F) < kVolumeHair) {
                    return true;
                }
            }
            if (nearInteger(at.s * size) || nearInteger(at.t * size)) {
                return true;
            }
        } else if (nearInteger(q.x * static_cast<float>(map.width)) ||
                   nearInteger(q.y * static_cast<float>(map.height)) || std::abs(q.z) < kVolumeHair ||
                   std::abs(q.z - 1.0F) < kVolumeHair) {
            return true;
        }
        const std::optional<Vote> v = vote(map, p);
        if (v && std::abs(v->distance) < 4.0F * kVolumeHair * collider.bounds.longestSide()) {
            return true;
        }
    }
    return false;
}

/// Signed distance of the union of collider and floor where inside, and the way out.
inline FieldSample solidAt(const ReferenceSettings& settings, const glm::vec3& p) {
    FieldSample best;
    best.distance = 1e30F;
    if (settings.collider != nullptr) {
        const FieldSample field = evaluate(*settings.collider, p);
        if (field.inside()) {
            best = field;
        }
    }
    if (settings.ground && p.y - *settings.ground < best.distance) {
        best.distance = p.y - *settings.ground;
        best.normal = glm::vec3(0.0F, 1.0F, 0.0F);
    }
    return best;
}

inline ReferenceState referenceStep(const ReferenceSettings& settings, const glm::vec3& p,
                                    const glm::vec3& v_before) {
    const float dt = settings.dt;
    const glm::vec3 gain = dt * (settings.forces.gravity + settings.forces.drag * settings.forces.wind);
    const float keep = 1.0F / (1.0F + dt * settings.forces.drag);
    glm::vec3 v = (v_before + gain) * keep;
    const glm::vec3 p_star = p + dt * v;

    ReferenceState out;
    out.position = p_star;
    const FieldSample ahead = solidAt(settings, p_star);
    if (settings.collider != nullptr) {
        out.ambiguous = isAmbiguous(*settings.collider, p_star) || isAmbiguous(*settings.collider, p);
    }
    if (settings.ground) {
        const float hair = kVolumeHair * (1.0F + std::abs(*settings.ground));
        out.ambiguous =
            out.ambiguous || std::abs(p_star.y - *settings.ground) < hair ||
            std::abs(p.y - *settings.ground) < hair ||
            // which of the two bodies is deeper
            std::abs(p_star.y - *settings.ground - evaluate(*settings.collider, p_star).distance) < hair;
    }
    if (ahead.distance < 0.0F) {
        const glm::vec3 n = ahead.normal;
        const float vn = dot(v, n);
        if (solidAt(settings, p).distance < 0.0F) {
            out.contact = Contact::kCaught;
            if (vn < 0.0F) {
                v = v - (2.0F * vn) * n;
            }
            out.ambiguous = out.ambiguous || std::abs(vn) < 1e-5F;
        } else {
            out.contact = Contact::kCollided;
            const glm::vec3 along = v - vn * n;
            const float threshold = settings.collision.friction_threshold;
            const float slide =
                dot(v, v) >= threshold * threshold ? 1.0F - settings.collision.friction : 1.0F;
            v = slide * along + (settings.collision.restitution * std::abs(vn)) * n;
            out.ambiguous = out.ambiguous || std::abs(dot(v, v) - threshold * threshold) < 1e-6F;
        }
        out.position = p + dt * v;
    }
    out.velocity = v;
    return out;
}

}  // namespace relief
