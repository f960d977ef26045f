// SPDX-License-Identifier: Apache-2.0
#include "bake/measure/truth.h"

#include <cmath>
#include <optional>

#include "bake/mesh/loops.h"
#include "bake/mesh/mersenne.h"
#include "formats/base/portable_math.h"
#include "formats/base/stopwatch.h"

namespace relief {
namespace {

/// SplitMix64 with a seed per sample, so that samples can be drawn in any order.
class SplitMixRandom {
  public:
    SplitMixRandom(std::uint64_t seed, std::uint64_t kind, std::uint64_t index)
        : state_(splitMix64(splitMix64(splitMix64(seed) + kind) + index)) {}

    /// In [0, 1), 53 bits.
    double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }

    /// Three independent normal deviates: Box and Muller (1958).
    glm::dvec3 gaussian() {
        double values[4];
        for (int i = 0; i < 4; i += 2) {
            const double radius = std::sqrt(-2.0 * portable::log(1.0 - uniform()));
            const double angle = 2.0 * 3.14159265358979323846 * uniform();
            values[i] = radius * portable::cos(angle);
            values[i + 1] = radius * portable::sin(angle);
        }
        return {values[0], values[1], values[2]};
    }

  private:
    std::uint64_t next() {
        state_ += 0x9e3779b97f4a7c15U;
        return splitMix64(state_);
    }

    std::uint64_t state_;
};

constexpr std::uint64_t kSurfaceKind = 1;
constexpr std::uint64_t kNearKind = 2;
constexpr std::uint64_t kUniformKind = 3;
constexpr std::uint64_t kInsideKind = 4;
/// Maximum depth of inside points below a face, relative to the thickness; deeper, the opposite face is about as near.
constexpr double kInsideShare = 0.45;

/// Draws sample i of each kind.
class Sampler {
  public:
    Sampler(const MeshQuery& query, const AccuracyOptions& options)
        : query_(query),
          mesh_(query.mesh()),
          areas_(query.prepared().areas()),
          winding_(query.prepared().orientation()),
          options_(options),
          longest_side_(static_cast<double>(mesh_.bounds.longestSide())),
          low_(mesh_.bounds.min),
          size_(glm::dvec3(mesh_.bounds.max) - low_) {}

    [[nodiscard]] SurfacePoint onSurface(std::size_t i) const {
        SplitMixRandom random(options_.seed, kSurfaceKind, i);
        const auto [position, triangle] = draw(random);
        const double step = kSurfaceStep * longest_side_;
        glm::dvec3 normal = planeOf(mesh_, triangle).normal;
        normal *= winding_ / length(normal);
        const bool front_inside = query_.inside(position + step * normal);
        const bool back_inside = query_.inside(position - step * normal);
        if (front_inside && !back_inside) {
            normal = -normal;
        }
        return {position, normal, front_inside && back_inside};
    }

    [[nodiscard]] glm::vec3 positionNear(std::size_t i) const {
        SplitMixRandom random(options_.seed, kNearKind, i);
        const glm::dvec3 from = draw(random).position;
        return from + options_.sigma_fraction * longest_side_ * random.gaussian();
    }
    [[nodiscard]] TruthPoint nearSurface(std::size_t i) const {
        const glm::vec3 near = positionNear(i);
        return {near, static_cast<float>(query_.signedDistance(near))};
    }
    [[nodiscard]] TruthPoint signNear(std::size_t i) const {
        const glm::vec3 near = positionNear(i);
        return {near, query_.inside(near) ? -1.0F : 1.0F};
    }

    [[nodiscard]] TruthPoint inBox(std::size_t i) const {
        SplitMixRandom random(options_.seed, kUniformKind, i);
        const double x = random.uniform();
        const double y = random.uniform();
        const double z = random.uniform();
        const glm::vec3 p = low_ + size_ * glm::dvec3(x, y, z);
        return {p, query_.inside(p) ? -1.0F : 1.0F};
    }

    /// Returns nullopt below a buried face, below a face without an inside, and at a boundary.
    [[nodiscard]] std::optional<InsidePoint> inside(std::size_t i) const {
        SplitMixRandom random(options_.seed, kInsideKind, i);
        const auto [on, triangle] = draw(random);
        const double step = kSurfaceStep * longest_side_;
        glm::dvec3 in = planeOf(mesh_, triangle).normal;
        in *= -winding_ / length(in);
        if (!query_.inside(on + step * in)) {
            in = -in;
        }
        const std::optional<FirstHit> hit = query_.firstHit(on + step * in, in);
        const glm::vec3 p = on + (hit ? kInsideShare * random.uniform() * (step + hit->along) : 0.0) * in;
        if (!hit || query_.inside(on - step * in) || !query_.inside(p)) {
            return std::nullopt;
        }
        const ClosestPoint closest = query_.closest(p);
        const glm::dvec3 way = closest.point - glm::dvec3(p);
        const double depth = length(way);
        if (!(depth > step)) {
            return std::nullopt;
        }
        const glm::dvec3 out = way / depth;
        if (query_.inside(closest.point + step * out)) {
            return std::nullopt;
        }
        return InsidePoint{p, depth, out};
    }

  private:
    struct Draw {
        glm::dvec3 position;
        std::uint32_t triangle;
    };
    [[nodiscard]] Draw draw(SplitMixRandom& random) const {
        const std::uint32_t triangle = areas_.triangleAt(random.uniform());
        const double u = random.uniform();
        const double v = random.uniform();
        return {pointOn(mesh_, triangle, u, v), triangle};
    }

    const MeshQuery& query_;
    const TriangleMesh& mesh_;
    const AreaTable& areas_;
    double winding_;
    const AccuracyOptions& options_;
    double longest_side_;
    glm::dvec3 low_;
    glm::dvec3 size_;
};

}  // namespace

std::vector<TruthPoint> sampleNear(const MeshQuery& query, const AccuracyOptions& options) {
    std::vector<TruthPoint> points(options.samples);
    const Sampler sampler(query, options);
    forEachIndex(0, options.samples, 64, [&](std::size_t i) { points[i] = sampler.signNear(i); });
    return points;
}

TruthSamples sampleTruth(const MeshQuery& query, const AccuracyOptions& options) {
    const Stopwatch watch;
    TruthSamples samples;
    samples.options = options;
    samples.longest_side = static_cast<double>(query.mesh().bounds.longestSide());
    samples.near.resize(options.samples);
    samples.uniform.resize(options.samples);
    samples.surface.resize(options.samples);
    const Sampler sampler(query, options);
    forEachIndex(0, options.samples, 256, [&](std::size_t i) {
        samples.surface[i] = sampler.onSurface(i);
        samples.near[i] = sampler.nearSurface(i);
        samples.uniform[i] = sampler.inBox(i);
    });
    std::vector<std::optional<InsidePoint>> inside(options.samples);
    forEachIndex(0, options.samples, 256, [&](std::size_t i) { inside[i] = sampler.inside(i); });
    for (const std::optional<InsidePoint>& point : inside) {
        if (point) {
            samples.inside.push_back(*point);
        }
    }
    samples.seconds = watch.seconds();
    return samples;
}

std::vector<SurfacePoint> sampleSurface(const MeshQuery& query, const AccuracyOptions& options) {
    std::vector<SurfacePoint> points(options.samples);
    const Sampler sampler(query, options);
    forEachIndex(0, options.samples, 256, [&](std::size_t i) { points[i] = sampler.onSurface(i); });
    return points;
}

}  // namespace relief
