#include "bake/picture/heat_map.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "bake/picture/pixels.h"

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

/// The camera of a picture.
class Frame {
  public:
    Frame(const TriangleMesh& mesh, const HeatMapOptions& options)
        : size_(options.size),
          forward_(glm::normalize(options.direction)),
          right_(glm::normalize(glm::cross(forward_, glm::dvec3(0.0, 1.0, 0.0)))),
          up_(glm::cross(right_, forward_)),
          center_(0.5 * (glm::dvec3(mesh.bounds.min) + glm::dvec3(mesh.bounds.max))) {
        double reach = 0.0;  // of the mesh, to the sides
        for (const glm::vec3& p : mesh.positions) {
            const glm::dvec3 offset = glm::dvec3(p) - center_;
            reach = std::max({reach, std::abs(glm::dot(offset, right_)), std::abs(glm::dot(offset, up_))});
            radius_ = std::max(radius_, glm::length(offset));
        }
        pixel_ = 2.06 * reach / size_;
    }

    [[nodiscard]] const glm::dvec3& forward() const { return forward_; }
    /// In front of the mesh. \param x, y  pixels from the left and the top.
    [[nodiscard]] glm::dvec3 origin(double x, double y) const {
        return center_ - 1.01 * radius_ * forward_ + (x - 0.5 * size_) * pixel_ * right_ -
               (y - 0.5 * size_) * pixel_ * up_;
    }
    [[nodiscard]] HeatMapPlace place(const glm::dvec3& p) const {
        const glm::dvec3 offset = (p - center_) / pixel_;
        return {0.5 * size_ + glm::dot(offset, right_), 0.5 * size_ - glm::dot(offset, up_), false};
    }

  private:
    double size_;
    glm::dvec3 forward_;
    glm::dvec3 right_;
    glm::dvec3 up_;
    glm::dvec3 center_;
    double radius_ = 0.0;  // of the mesh, all round
    double pixel_ = 1.0;
};

}  // namespace

HeatMapPlace placeOnHeatMap(const MeshQuery& query, const HeatMapOptions& options, const glm::vec3& p) {
    const Frame frame(query.mesh(), options);
    HeatMapPlace place = frame.place(p);
    const glm::dvec3 origin = frame.origin(place.x, place.y);
    // By the nearest surface, as the point itself may lie inside.
    const double depth = glm::dot(query.closest(p).point - origin, frame.forward());
    const std::optional<FirstHit> hit = query.firstHit(origin, frame.forward());
    const double slack = 0.01 * static_cast<double>(query.mesh().bounds.longestSide());
    place.hidden = hit && hit->along < depth - slack;
    return place;
}

RgbImage drawHeatMap(const MeshQuery& query, const Field& field, const HeatMapOptions& options) {
    const TriangleMesh& mesh = query.mesh();
    const Frame frame(mesh, options);
    const glm::dvec3& forward = frame.forward();
    return drawPixels(options.size, options.size, [&](std::uint32_t x, std::uint32_t y) {
        Color sum{0.0, 0.0, 0.0};
        for (int ray = 0; ray < kRaysAcross * kRaysAcross; ++ray) {
            const double sub_x = (ray % kRaysAcross + 0.5) / kRaysAcross;
            const double sub_y = (ray / kRaysAcross + 0.5) / kRaysAcross;
            const glm::dvec3 origin = frame.origin(x + sub_x, y + sub_y);
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
        return sum;
    });
}

}  // namespace relief
