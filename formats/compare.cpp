#include "formats/compare.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <numeric>
#include <vector>

#include "formats/nearest_surface.h"

namespace relief {
namespace {

constexpr double kMargin = 0.1;  // round the box, of its longest side
constexpr double kNear = 0.01;   // of the same
constexpr std::uint64_t kMapsAtAllPoints = 16;
constexpr double kShare = 0.99;  // of PointsDifference::percentile_99

/// The digits of i in a base, mirrored at the point: Halton's sequence along one axis, in [0, 1).
double mirrored(std::uint64_t i, std::uint64_t base) {
    double value = 0.0;
    double digit = 1.0;
    for (; i > 0; i /= base) {
        digit /= static_cast<double>(base);
        value += digit * static_cast<double>(i % base);
    }
    return value;
}

bool knowsDistance(const SurfaceSample& sample) {
    return sample.map >= 0 && std::abs(sample.distance) < kFarOutside;
}

}  // namespace

double PointsDifference::sidesPercent() const {
    return points == 0 ? 0.0 : 100.0 * static_cast<double>(only_a + only_b) / static_cast<double>(points);
}

PointsDifference comparePoints(const Collider& a, const Collider& b, std::uint64_t points) {
    const glm::dvec3 low = glm::min(glm::dvec3(a.bounds.min), glm::dvec3(b.bounds.min));
    const glm::dvec3 high = glm::max(glm::dvec3(a.bounds.max), glm::dvec3(b.bounds.max));
    const glm::dvec3 size = high - low;
    const double longest = std::max({size.x, size.y, size.z});
    const std::uint64_t maps = std::max<std::uint64_t>(a.maps.size() + b.maps.size(), kMapsAtAllPoints);
    PointsDifference result;
    std::vector<double> distances;
    for (std::uint64_t i = 1; i <= points * kMapsAtAllPoints / maps; ++i) {
        const glm::dvec3 share(mirrored(i, 2), mirrored(i, 3), mirrored(i, 5));
        const glm::dvec3 offset = glm::dvec3(mirrored(i, 7), mirrored(i, 11), mirrored(i, 13)) * 2.0 - 1.0;
        const glm::vec3 p(low - kMargin * longest + share * (size + 2.0 * kMargin * longest));
        for (const Collider* from : {&a, &b}) {
            const SurfaceSample surface = nearestSurface(*from, p);
            if (!knowsDistance(surface)) {
                continue;
            }
            const glm::vec3 near(glm::dvec3(surface.point) + kNear * longest * offset);
            const SurfaceSample of_a = nearestSurface(a, near);
            const SurfaceSample of_b = nearestSurface(b, near);
            ++result.points;
            result.only_a += of_a.inside() && !of_b.inside() ? 1 : 0;
            result.only_b += of_b.inside() && !of_a.inside() ? 1 : 0;
            if (knowsDistance(of_a) && knowsDistance(of_b)) {
                distances.push_back(std::abs(double{of_a.distance} - double{of_b.distance}));
            }
        }
    }
    result.distances = distances.size();
    if (!distances.empty()) {
        std::sort(distances.begin(), distances.end());  // first: the sum then has one order
        const auto count = static_cast<double>(distances.size());
        result.mean = std::accumulate(distances.begin(), distances.end(), 0.0) / count;
        result.percentile_99 = distances[static_cast<std::size_t>(std::ceil(kShare * count)) - 1];
    }
    return result;
}

}  // namespace relief
