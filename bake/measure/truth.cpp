#include "bake/measure/truth.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "bake/mesh/triangle_plane.h"
#include "formats/base/portable_math.h"

namespace relief {
namespace {

/// The random numbers of one sample: SplitMix64 (Steele, Lea, Flood 2014), begun at a place of its own, so
/// that samples can be drawn in any order.
class SplitMixRandom {
  public:
    SplitMixRandom(std::uint64_t seed, std::uint64_t kind, std::uint64_t index)
        : state_(mix(mix(mix(seed) + kind) + index)) {}

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
    static std::uint64_t mix(std::uint64_t z) {
        z += 0x9e3779b97f4a7c15U;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
        return z ^ (z >> 31);
    }
    std::uint64_t next() {
        state_ += 0x9e3779b97f4a7c15U;
        return mix(state_);
    }

    std::uint64_t state_;
};

/// Draws points of a mesh, every part of its area as likely as any other.
class AreaSampler {
  public:
    explicit AreaSampler(const TriangleMesh& mesh) : mesh_(mesh) {
        area_up_to_.reserve(mesh.triangles.size());
        double sum = 0.0;
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            const TrianglePlane plane = planeOf(mesh, i);
            sum += std::sqrt(dot(plane.normal, plane.normal));
            area_up_to_.push_back(sum);
        }
    }

    struct Point {
        glm::dvec3 position;
        std::uint32_t triangle;
    };
    [[nodiscard]] Point draw(SplitMixRandom& random) const {
        const double at = random.uniform() * area_up_to_.back();
        const auto found = std::upper_bound(area_up_to_.begin(), area_up_to_.end() - 1, at);
        const auto triangle = static_cast<std::uint32_t>(found - area_up_to_.begin());
        double u = random.uniform();
        double v = random.uniform();
        if (u + v > 1.0) {
            u = 1.0 - u;
            v = 1.0 - v;
        }
        const glm::uvec3& t = mesh_.triangles[triangle];
        const glm::dvec3 a = mesh_.positions[t.x];
        return {a + u * (glm::dvec3(mesh_.positions[t.y]) - a) + v * (glm::dvec3(mesh_.positions[t.z]) - a),
                triangle};
    }

  private:
    const TriangleMesh& mesh_;
    std::vector<double> area_up_to_;  // twice the area, up to and including each triangle
};

constexpr std::uint64_t kSurfaceKind = 1;
constexpr std::uint64_t kNearKind = 2;
constexpr std::uint64_t kUniformKind = 3;

}  // namespace

TruthSamples sampleTruth(const MeshQuery& query, const AccuracyOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    const TriangleMesh& mesh = query.mesh();
    TruthSamples samples;
    samples.options = options;
    samples.longest_side = static_cast<double>(mesh.bounds.longestSide());
    samples.near.resize(options.samples);
    samples.uniform.resize(options.samples);
    samples.surface.resize(options.samples);

    const AreaSampler area(mesh);
    const double winding = orientation(mesh);
    const double sigma = options.sigma_share * samples.longest_side;
    const double step = kSurfaceStep * samples.longest_side;
    const glm::dvec3 low = mesh.bounds.min;
    const glm::dvec3 size = glm::dvec3(mesh.bounds.max) - low;
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, options.samples, 256),
                      [&](const tbb::blocked_range<std::uint32_t>& range) {
                          for (std::uint32_t i = range.begin(); i != range.end(); ++i) {
                              SplitMixRandom surface_random(options.seed, kSurfaceKind, i);
                              const AreaSampler::Point on = area.draw(surface_random);
                              glm::dvec3 normal = planeOf(mesh, on.triangle).normal;
                              normal *= winding / std::sqrt(dot(normal, normal));
                              const bool front_inside = query.inside(on.position + step * normal);
                              const bool back_inside = query.inside(on.position - step * normal);
                              if (front_inside && !back_inside) {
                                  normal = -normal;
                              }
                              samples.surface[i] = {on.position, normal, front_inside && back_inside};

                              SplitMixRandom near_random(options.seed, kNearKind, i);
                              const glm::dvec3 from = area.draw(near_random).position;
                              const glm::vec3 near = from + sigma * near_random.gaussian();
                              samples.near[i] = {near, static_cast<float>(query.signedDistance(near))};

                              SplitMixRandom uniform_random(options.seed, kUniformKind, i);
                              const double x = uniform_random.uniform();
                              const double y = uniform_random.uniform();
                              const double z = uniform_random.uniform();
                              const glm::vec3 uniform = low + size * glm::dvec3(x, y, z);
                              samples.uniform[i] = {uniform, query.inside(uniform) ? -1.0F : 1.0F};
                          }
                      });
    samples.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return samples;
}

}  // namespace relief
