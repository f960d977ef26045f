// SPDX-License-Identifier: Apache-2.0
#include "runtime/scene/scene_sweep.h"
#include "runtime/births/emitter_motion.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/nearest_surface.h"
#include "runtime/particles/step_pass.h"
#include "runtime/scene/scene_emitter.h"

namespace relief {
namespace {

constexpr int kGrid = 8;                   // sample points along each side of the box
constexpr std::size_t kSamplesMin = 16;    // minimum number of samples for an estimate
constexpr float kThicknessMin = 0x1p-14F;  // tested thicknesses, as fractions of the longest side
constexpr float kThicknessMax = 2.0F;
constexpr float kThicknessFactor = 1.2F;        // factor between tested thicknesses
constexpr int kHalvings = 5;                    // bisections of the last interval
constexpr std::uint64_t kBirthsSampled = 1000;  // sampled births per emitter

std::string number(double value) {
    return formatted("%.3g", value);
}

/// Returns the thickness inwards from a point of the surface, underestimated by at most 1/160; nullopt next to an edge.
std::optional<float> thicknessAt(const Collider& collider, const SurfaceSample& place, float longest) {
    const auto inside = [&](float depth) {
        return evaluate(collider, place.point - depth * place.normal).inside();
    };
    float depth = kThicknessMin * longest;
    if (!inside(depth)) {
        return std::nullopt;
    }
    float beyond = kThicknessFactor * depth;
    while (beyond < kThicknessMax * longest && inside(beyond)) {
        depth = std::exchange(beyond, kThicknessFactor * beyond);
    }
    for (int i = 0; i < kHalvings; ++i) {
        const float middle = 0.5F * (depth + beyond);
        (inside(middle) ? depth : beyond) = middle;
    }
    return depth;
}

/// Returns the first births of an emitter, in world space.
std::vector<Birth> birthsOf(Emitter emitter, const EmitterMotion& motion, const Scene& scene) {
    const double dt{scene.time.dt};
    const double begin = -dt * prewarmSteps(scene);
    const double end = dt * scene.time.steps;
    std::vector<Birth> births;
    emitter.emit(end - begin, kBirthsSampled, births);
    for (Birth& birth : births) {
        // Births without an age belong to a burst; the first burst is at the start.
        const double moment = birth.age > 0.0F ? end - double{birth.age} : begin + emitter.settings().start;
        birth.age = 0.0F;
        carry(motion, moment, std::span(&birth, 1));
    }
    return births;
}

/// Estimates the speed of a birth at the centre of all bodies, with only gravity and drag.
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

/// Returns the typical thickness of a collider, object units; nullopt if there are too few samples.
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
    if (found.size() < kSamplesMin) {
        return std::nullopt;
    }
    const auto middle = found.begin() + static_cast<std::ptrdiff_t>(found.size() / 2);
    std::nth_element(found.begin(), middle, found.end());
    return *middle;
}

}  // namespace

struct SceneSweep::Thin {
    std::string file;
    float thick = 0.0F;  // world units
    float speed = 0.0F;
    float step = 0.0F;
};

/// Returns the warning, which suggests values for the thinnest collider. \param sweeps  whether to suggest collision.sweep.
std::string SceneSweep::thinWarning(std::span<const Thin> all, bool sweeps) {
    const Thin& worst = *std::min_element(all.begin(), all.end(),
                                          [](const Thin& a, const Thin& b) { return a.thick < b.thick; });
    const bool several = all.size() > 1;
    return "at a speed of " + number(double{worst.speed}) + " a step is " + number(double{worst.step}) +
           " long, but " + worst.file + " is typically " + number(double{worst.thick}) + " thick" +
           (several ? ", the thinnest of " + std::to_string(all.size()) + " such colliders" : "") +
           ": particles may pass through " + (several ? "them" : "it") + "; set " +
           (sweeps ? "collision.sweep = " + number(0.5 * double{worst.thick}) + ", or " : "") +
           "a smaller time.dt";
}

SceneSweep::SceneSweep(const Scene& scene, std::span<const std::shared_ptr<const Collider>> colliders,
                       std::span<const Emitter> emitters, const Bounds& bounds)
    : bounds_(bounds), groups_(std::min<std::size_t>(colliders.size(), WorldTextures::kGroups)) {
    std::map<const Collider*, std::optional<float>> thicknesses;
    std::set<std::tuple<std::string, float, std::size_t>> known;  // a world may use a file many times
    for (std::size_t i = 0; i < colliders.size(); ++i) {
        const SceneCollider& body = scene.colliders[i];
        const auto [at, added] = thicknesses.try_emplace(colliders[i].get());
        if (added && !body.deforms()) {
            at->second = typicalThickness(*colliders[i]);
        }
        const std::size_t group = std::min(body.tile_of.value_or(i), groups_.size() - 1);
        const float thick = at->second.value_or(0.0F) * body.pose.scale;
        if (at->second && known.insert({body.path.string(), thick, group}).second) {
            bodies_.push_back({body.path, thick, group});
        }
    }
    add(scene, emitters);
}

void SceneSweep::add(const Scene& scene, std::span<const Emitter> emitters) {
    const auto motions = emitterMotions(scene.emitters, scene.colliders);
    births_.clear();
    for (std::size_t i = 0; i < emitters.size(); ++i) {
        const std::vector<Birth> births = birthsOf(emitters[i], motions[i], scene);
        births_.insert(births_.end(), births.begin(), births.end());
    }
    change(scene);
}

void SceneSweep::add(const Scene& scene, std::span<const Birth> births) {
    if (births.empty()) {
        return;
    }
    std::vector<ParticleType> types(scene.types.begin(), scene.types.end());
    types.emplace_back();                                    // of births without a type
    std::vector<std::optional<float>> speeds(types.size());  // of the fastest birth
    for (const Birth& birth : births) {
        const std::size_t type = std::min<std::size_t>(birth.type, scene.types.size());
        speeds[type] =
            std::max(speeds[type].value_or(0.0F), speedAtBodies(birth, types[type], scene, bounds_));
    }
    for (std::size_t t = 0; t < types.size(); ++t) {
        for (std::size_t i = 0; i < groups_.size() && speeds[t]; ++i) {
            if ((types[t].collides_with >> i & 1U) != 0) {
                float& fastest = groups_[i][types[t].radius];
                fitted_ = fitted_ && *speeds[t] <= fastest;
                fastest = std::max(fastest, *speeds[t]);
            }
        }
    }
}

std::vector<SceneSweep::Thin> SceneSweep::thinColliders() const {
    std::map<std::filesystem::path, Thin> thin;
    for (const Body& body : bodies_) {
        for (const auto& [radius, speed] : groups_[body.group]) {
            const float step = speed * longest_;
            const float thick = body.thick + 2.0F * radius;
            if (step <= thick) {
                continue;
            }
            const auto [at, added] = thin.try_emplace(body.path);
            Thin& of = at->second;
            of = {quotedPath(body.path.filename()), added ? thick : std::min(of.thick, thick),
                  std::max(of.speed, speed), std::max(of.step, step)};
        }
    }
    std::vector<Thin> all;
    for (const auto& [path, each] : thin) {
        all.push_back(each);
    }
    return all;
}

float SceneSweep::lengthFor(float dt, const Scene& scene, std::vector<std::string>& warnings) {
    const std::optional<float>& stated = scene.collision.sweep;
    const auto length = [&] {
        const float reach = speed_ * dt / static_cast<float>(StepPass::kSweepPieces - 1);
        return stated.value_or(std::min(std::max(half_, reach), std::numeric_limits<float>::max()));
    };
    if (fitted_ && dt <= longest_) {
        return length();
    }
    fitted_ = true;
    longest_ = std::max(longest_, dt);
    std::vector<Thin> thin = thinColliders();
    half_ = thin.empty() ? 0.0F : std::numeric_limits<float>::max();
    speed_ = 0.0F;
    for (const Thin& each : thin) {
        half_ = std::min(half_, 0.5F * each.thick);
        speed_ = std::max(speed_, each.speed);
    }
    if (const float sweep = length(); sweep > 0.0F) {
        std::erase_if(thin, [&](const Thin& each) { return std::min(each.step, sweep) <= each.thick; });
        for (Thin& each : thin) {
            each.step = std::min(each.step, sweep);
        }
    }
    if (!thin.empty() && !warned_) {
        warned_ = true;
        warnings.push_back(thinWarning(thin, stated.has_value()));
    }
    return length();
}

}  // namespace relief
