// SPDX-License-Identifier: Apache-2.0
#include "runtime/scene/scene_sweep.h"
#include "runtime/births/emitter_motion.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <set>
#include <span>

#include "formats/base/file_io.h"
#include "formats/nearest_surface.h"
#include "runtime/particles/step_pass.h"
#include "runtime/scene/scene_emitter.h"

namespace relief {
namespace {

constexpr int kGrid = 8;  // points along each side of the box, from which surfaces are looked for
constexpr std::size_t kPlacesMin = 16;  // fewer places are no sample of a body
constexpr float kThinnest = 0x1p-14F;   // of the longest side, as are the next
constexpr float kThickest = 2.0F;
constexpr float kWider = 1.2F;           // from one depth that is tried to the next
constexpr std::uint64_t kBirths = 1000;  // of each emitter

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.3g", value);
    return text;
}

/// How far it is inwards from a place of the surface to the other side; nullopt beside an edge.
std::optional<float> thicknessAt(const Collider& collider, const SurfaceSample& place, float longest) {
    float depth = kThinnest * longest;
    for (; depth < kThickest * longest; depth *= kWider) {
        if (!evaluate(collider, place.point - depth * place.normal).inside()) {
            break;
        }
    }
    return depth > kThinnest * longest ? std::optional(depth) : std::nullopt;
}

/// The first births of an emitter, in the world.
std::vector<Birth> birthsOf(Emitter emitter, const EmitterMotion& motion, const Scene& scene) {
    const double dt{scene.time.dt};
    const double begin = -dt * prewarmSteps(scene);
    const double end = dt * scene.time.steps;
    std::vector<Birth> births;
    emitter.emit(end - begin, kBirths, births);
    for (Birth& birth : births) {
        // Births without an age are those of a burst, the first of which comes at the start.
        const double moment = birth.age > 0.0F ? end - double{birth.age} : begin + emitter.settings().start;
        birth.age = 0.0F;
        carry(motion, moment, std::span(&birth, 1));
    }
    return births;
}

/// The speed that a birth has fallen to by the middle of all bodies, if nothing but gravity and drag acts on it.
float speedAtBodies(const Birth& birth, const ParticleType& type, const Scene& scene, const Bounds& bounds) {
    const glm::vec3 gravity = type.gravity * *scene.forces.gravity;
    const float pull = glm::length(gravity);
    const float start = glm::length(birth.velocity);
    if (!(pull > 0.0F)) {
        return start;
    }
    const float fall = glm::dot(gravity / pull, bounds.center() - birth.position);
    const float free = std::sqrt(start * start + 2.0F * pull * std::max(fall, 0.0F));
    const float drag = scene.air.viscosity ? 0.0F : scene.forces.drag;
    return drag > 0.0F ? std::min(free, std::max(start, pull / drag)) : free;
}

struct Fastest {
    float speed = 0.0F;
    float radius = 0.0F;
};

/// Of what meets the bodies of a group, a bit of ParticleType::collides.
Fastest fastestAt(std::size_t group, const Scene& scene, const Bounds& bounds,
                  std::span<const Birth> births) {
    Fastest fastest;
    for (const Birth& birth : births) {
        const ParticleType type =
            birth.type < scene.types.size() ? ParticleType(scene.types[birth.type]) : ParticleType{};
        const bool meets = (type.collides >> group & 1U) != 0;
        const float speed = meets ? speedAtBodies(birth, type, scene, bounds) : 0.0F;
        if (speed > fastest.speed) {
            fastest = {speed, type.radius};
        }
    }
    return fastest;
}

/// A body that is thinner than a step is long.
struct Thin {
    std::string file;
    float thick = 0.0F;  // world units, as are the next
    float speed = 0.0F;
    float step = 0.0F;
};

/// The thinnest of several decides the cure. \param sweeps  collision.sweep can be one.
std::string thinWarning(std::span<const Thin> all, bool sweeps) {
    const Thin& worst = *std::min_element(all.begin(), all.end(),
                                          [](const Thin& a, const Thin& b) { return a.thick < b.thick; });
    const bool several = all.size() > 1;
    return "at a speed of " + number(double{worst.speed}) + " a step is " + number(double{worst.step}) +
           " long, and " + worst.file + " mostly " + number(double{worst.thick}) + " thick" +
           (several ? ", the thinnest of " + std::to_string(all.size()) + " such colliders" : "") +
           ": particles may pass through " + (several ? "them" : "it") + "; set " +
           (sweeps ? "collision.sweep = " + number(0.5 * double{worst.thick}) + ", or " : "") +
           "a smaller time.dt";
}

/// Half of the thinnest, or what the pieces of a sweep reach in the longest step.
float sweepFor(std::span<const Thin> all) {
    float half = std::numeric_limits<float>::max();
    float longest = 0.0F;
    for (const Thin& thin : all) {
        half = std::min(half, 0.5F * thin.thick);
        longest = std::max(longest, thin.step);
    }
    return std::max(half, longest / static_cast<float>(StepPass::kSweepPieces - 1));
}

/// Mostly from one side of a body to the other, in units of its object space; nullopt: too little of it is seen.
std::optional<float> typicalThickness(const Collider& collider) {
    const float longest = collider.bounds.longestSide();
    if (!(longest > 0.0F)) {
        return std::nullopt;
    }
    std::vector<float> found;
    for (int i = 0; i < kGrid * kGrid * kGrid; ++i) {
        const glm::vec3 cell(static_cast<float>(i % kGrid), static_cast<float>(i / kGrid % kGrid),
                             static_cast<float>(i / kGrid / kGrid));
        const glm::vec3 p =
            collider.bounds.min + (cell + 0.5F) / static_cast<float>(kGrid) * collider.bounds.size();
        const SurfaceSample place = nearestSurface(collider, p);
        if (place.map >= 0 && std::abs(place.distance) < kFarOutside) {
            if (const auto thickness = thicknessAt(collider, place, longest)) {
                found.push_back(*thickness);
            }
        }
    }
    if (found.size() < kPlacesMin) {
        return std::nullopt;
    }
    const auto middle = found.begin() + static_cast<std::ptrdiff_t>(found.size() / 2);
    std::nth_element(found.begin(), middle, found.end());
    return *middle;
}

/// The colliders that are thinner than a step is long, each file once.
std::vector<Thin> thinColliders(const Scene& scene,
                                std::span<const std::shared_ptr<const Collider>> colliders,
                                std::span<const Emitter> emitters, const Bounds& bounds) {
    std::vector<Birth> births;
    const auto motions = emitterMotions(scene.emitters, scene.colliders);
    for (std::size_t i = 0; i < emitters.size(); ++i) {
        const std::vector<Birth> more = birthsOf(emitters[i], motions[i], scene);
        births.insert(births.end(), more.begin(), more.end());
    }
    std::vector<Thin> thin;
    std::vector<Fastest> of_groups;
    for (std::size_t i = 0; i < std::min<std::size_t>(colliders.size(), WorldTextures::kGroups); ++i) {
        of_groups.push_back(fastestAt(i, scene, bounds, births));
    }
    std::map<const Collider*, std::optional<float>> thicknesses;
    std::set<std::string> found;  // names of files: a world has a file many times
    for (std::size_t i = 0; i < colliders.size(); ++i) {
        const SceneCollider& body = scene.colliders[i];
        const Fastest fastest = of_groups[std::min(body.tile_of.value_or(i), of_groups.size() - 1)];
        const float step = fastest.speed * scene.time.dt;
        const Collider& collider = *colliders[i];
        const auto known = thicknesses.find(&collider);
        const auto thickness = known != thicknesses.end() ? known->second
                               : body.deforms()           ? std::nullopt
                                                          : typicalThickness(collider);
        thicknesses.emplace(&collider, thickness);
        const float thick = thickness.value_or(0.0F) * body.pose.scale + 2.0F * fastest.radius;
        if (thickness && step > thick && found.insert(body.path.string()).second) {
            thin.push_back({quotedPath(body.path.filename()), thick, fastest.speed, step});
        }
    }
    return thin;
}

}  // namespace

std::vector<std::string> fitSweep(Scene& scene, std::span<const std::shared_ptr<const Collider>> colliders,
                                  std::span<const Emitter> emitters, const Bounds& bounds) {
    std::vector<Thin> thin = thinColliders(scene, colliders, emitters, bounds);
    std::optional<float>& sweep = scene.collision.sweep;
    const bool chosen = !sweep && !thin.empty();
    if (chosen) {
        sweep = sweepFor(thin);
    }
    if (sweep.value_or(0.0F) > 0.0F) {
        std::erase_if(thin, [&](Thin& each) {
            each.step = std::min(each.step, *sweep);
            return each.step <= each.thick;
        });
    }
    return thin.empty() ? std::vector<std::string>() : std::vector{thinWarning(thin, !chosen)};
}

}  // namespace relief
