#include "tests/bake/pipeline/map_agreement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <optional>

namespace relief::test {
namespace {

/// A unit, and what float maps of planes add: a step of their codes is 1/65534.
constexpr double kUnit = 1.001;

/// The depth of a texel's end as a number of units.
double unitsOf(MapFormat format, std::span<const std::byte> texel, int end) {
    const auto word = [&](std::size_t i) {
        std::uint16_t value = 0;
        std::memcpy(&value, &texel[2 * i], sizeof(value));
        return static_cast<double>(value);
    };
    switch (format) {
        case MapFormat::kFloat32: {
            float depth = 0.0F;
            std::memcpy(&depth, &texel[12], sizeof(depth));
            return 65535.0 * static_cast<double>(depth);
        }
        case MapFormat::kFixed8:
        case MapFormat::kCube8:
            return 256.0 * std::to_integer<int>(texel[2]) + std::to_integer<int>(texel[3]);
        case MapFormat::kFrontBackHalf:
        case MapFormat::kFrontBackFixed:
            return word(static_cast<std::size_t>(2 + end));
        case MapFormat::kPatches:
            break;
    }
    return 0.0;
}

double degreesBetween(const glm::vec3& a, const glm::vec3& b) {
    const glm::dvec3 x(a);
    const glm::dvec3 y(b);
    return std::atan2(glm::length(glm::cross(x, y)), glm::dot(x, y)) * 180.0 / 3.14159265358979323846;
}

/// Axes sc, tc and ma of a cube's face, from the view's own rays: those of texels far apart.
struct FaceFrame {
    glm::dvec3 across, up, out;
};

FaceFrame faceFrame(std::uint32_t face) {
    const auto through = [&](float s, float t) { return glm::dvec3(cubeDirection({face, s, t})); };
    const glm::dvec3 out = through(0.5F, 0.5F);
    return {through(1.0F, 0.5F) - out, through(0.5F, 1.0F) - out, out};
}

/// Where a view puts a point, in texels; nullopt behind a cube's face.
std::optional<glm::dvec2> project(const View& view, const FaceFrame& frame, const glm::dvec3& p) {
    glm::dvec3 map;
    for (int k = 0; k < 3; ++k) {
        map[k] = glm::dot(p - view.origin, view.axis[k]) / glm::dot(view.axis[k], view.axis[k]);
    }
    if (view.projection() == Projection::kOrthographic) {
        return glm::dvec2(map.x * view.width, map.y * view.height);
    }
    const double ma = glm::dot(map, frame.out);
    if (!(ma > 1e-9)) {
        return std::nullopt;
    }
    return glm::dvec2(0.5 * (glm::dot(map, frame.across) / ma + 1.0) * view.width,
                      0.5 * (glm::dot(map, frame.up) / ma + 1.0) * view.height);
}

double distanceToSegment(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
    const glm::dvec2 along = b - a;
    const double length2 = glm::dot(along, along);
    const double t = length2 > 0.0 ? std::clamp(glm::dot(p - a, along) / length2, 0.0, 1.0) : 0.0;
    return glm::length(p - (a + t * along));
}

}  // namespace

Agreement compareMaps(const DepthMap& a, const DepthMap& b, double degrees) {
    Agreement agreement;
    for (std::uint32_t face = 0; face < a.faceCount(); ++face) {
        for (std::uint32_t y = 0; y < a.height; ++y) {
            for (std::uint32_t x = 0; x < a.width; ++x) {
                const auto bytes_a = a.texelAt(face, x, y);
                const auto bytes_b = b.texelAt(face, x, y);
                if (std::equal(bytes_a.begin(), bytes_a.end(), bytes_b.begin())) {
                    const Texel same = decodeTexel(a.format, bytes_a);
                    agreement.both += (same.front ? 1U : 0U) + (same.back ? 1U : 0U);
                    continue;
                }
                const Texel texel_a = decodeTexel(a.format, bytes_a);
                const Texel texel_b = decodeTexel(b.format, bytes_b);
                for (int end = 0; end < (isFrontBack(a.format) ? 2 : 1); ++end) {
                    const auto& of_a = end == 0 ? texel_a.front : texel_a.back;
                    const auto& of_b = end == 0 ? texel_b.front : texel_b.back;
                    if (of_a.has_value() != of_b.has_value()) {
                        agreement.coverage.push_back({face, x, y, end, 0.0});
                    }
                    if (!of_a || !of_b) {
                        continue;
                    }
                    ++agreement.both;
                    const double units =
                        std::abs(unitsOf(a.format, bytes_a, end) - unitsOf(b.format, bytes_b, end));
                    if (units > kUnit) {
                        agreement.depths.push_back({face, x, y, end, units});
                    }
                    const double turned = degreesBetween(of_a->normal, of_b->normal);
                    agreement.normals_off += turned > degrees ? 1 : 0;
                    agreement.normal_degrees = std::max(agreement.normal_degrees, turned);
                }
            }
        }
    }
    return agreement;
}

double edgeDistance(const TriangleMesh& mesh, const View& view, std::uint32_t face, std::uint32_t x,
                    std::uint32_t y) {
    const FaceFrame frame = faceFrame(face);
    const glm::dvec2 centre(x + 0.5, y + 0.5);
    double nearest = std::numeric_limits<double>::max();
    for (const glm::uvec3& t : mesh.triangles) {
        std::array<std::optional<glm::dvec2>, 3> corner;
        for (int i = 0; i < 3; ++i) {
            corner[static_cast<std::size_t>(i)] = project(view, frame, mesh.positions[t[i]]);
        }
        for (std::size_t i = 0; i < 3; ++i) {
            if (corner[i] && corner[(i + 1) % 3]) {
                nearest = std::min(nearest, distanceToSegment(centre, *corner[i], *corner[(i + 1) % 3]));
            }
        }
    }
    return nearest;
}

}  // namespace relief::test
