#include "bake/picture/heat_map.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "bake/mesh/triangle_plane.h"

namespace relief {
namespace {

constexpr int kRaysAcross = 2;  // of a pixel
constexpr Color kBackground{1.0, 1.0, 1.0};

Color colorOf(const std::optional<FieldValue>& value, double range) {
    if (!value) {
        return kHeatUnknownColor;
    }
    if (value->distance >= kFarOutside) {
        return kHeatFarColor;
    }
    return distanceColor(static_cast<double>(value->distance) / range);
}

}  // namespace

RgbImage drawHeatMap(const MeshQuery& query, const Field& field, const HeatMapOptions& options) {
    const TriangleMesh& mesh = query.mesh();
    const glm::dvec3 forward = glm::normalize(options.direction);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0.0, 1.0, 0.0)));
    const glm::dvec3 up = glm::cross(right, forward);
    const glm::dvec3 center = 0.5 * (glm::dvec3(mesh.bounds.min) + glm::dvec3(mesh.bounds.max));
    double reach = 0.0;   // of the mesh, to the sides
    double radius = 0.0;  // and all round
    for (const glm::vec3& p : mesh.positions) {
        const glm::dvec3 offset = glm::dvec3(p) - center;
        reach = std::max({reach, std::abs(glm::dot(offset, right)), std::abs(glm::dot(offset, up))});
        radius = std::max(radius, glm::length(offset));
    }
    const double pixel = 2.06 * reach / options.size;

    RgbImage image{options.size, options.size, {}};
    image.pixels.resize(std::size_t{image.width} * image.height);
    tbb::parallel_for(std::uint32_t{0}, image.height, [&](std::uint32_t y) {
        for (std::uint32_t x = 0; x < image.width; ++x) {
            Color sum{0.0, 0.0, 0.0};
            for (int ray = 0; ray < kRaysAcross * kRaysAcross; ++ray) {
                const double sub_x = (ray % kRaysAcross + 0.5) / kRaysAcross;
                const double sub_y = (ray / kRaysAcross + 0.5) / kRaysAcross;
                const glm::dvec3 origin = center - 1.01 * radius * forward +
                                          (x + sub_x - 0.5 * image.width) * pixel * right -
                                          (y + sub_y - 0.5 * image.height) * pixel * up;
                Color color = kBackground;
                if (const std::optional<FirstHit> hit = query.firstHit(origin, forward)) {
                    const glm::vec3 p = origin + hit->along * forward;
                    const glm::dvec3 normal = glm::normalize(planeOf(mesh, hit->triangle).normal);
                    const double shade = 0.5 + 0.5 * std::abs(glm::dot(normal, forward));
                    color = colorOf(field(p), options.range);
                    color = {color.r * shade, color.g * shade, color.b * shade};
                }
                constexpr double kShare = 1.0 / (kRaysAcross * kRaysAcross);
                sum = {sum.r + kShare * color.r, sum.g + kShare * color.g, sum.b + kShare * color.b};
            }
            image.pixels[std::size_t{y} * image.width + x] = toPixel(sum);
        }
    });
    return image;
}

}  // namespace relief
