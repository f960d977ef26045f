// Colliders made from closed-form shapes: every texel is the exact meeting of its ray with the shape, so that
// tests of the runtime need no mesh and no baker, and know the truth at every point.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "formats/collider.h"

namespace relief::analytic {

using Vec = glm::dvec3;

/// A solid: the part of a line p + t d that lies in it, as [enter, leave] intervals in ascending order, and
/// the unit outward normal at a point of its surface.
struct Shape {
    Bounds bounds;
    std::function<std::vector<std::pair<double, double>>(const Vec& p, const Vec& d)> crossings;
    std::function<Vec(const Vec& p)> normal;
    std::function<double(const Vec& p)> distance;  ///< exact signed distance, negative inside
};

inline Shape sphere(const Vec& center, double radius) {
    Shape shape;
    shape.bounds.add(glm::vec3(center - Vec(radius)));
    shape.bounds.add(glm::vec3(center + Vec(radius)));
    shape.crossings = [=](const Vec& p, const Vec& d) -> std::vector<std::pair<double, double>> {
        const double a = glm::dot(d, d);
        const double half = glm::dot(p - center, d) / a;
        const double rest = half * half - (glm::dot(p - center, p - center) - radius * radius) / a;
        if (rest <= 0.0) {
            return {};
        }
        return {{-half - std::sqrt(rest), -half + std::sqrt(rest)}};
    };
    shape.normal = [=](const Vec& p) { return glm::normalize(p - center); };
    shape.distance = [=](const Vec& p) { return glm::length(p - center) - radius; };
    return shape;
}

inline Shape box(const Vec& low, const Vec& high) {
    Shape shape;
    shape.bounds.add(glm::vec3(low));
    shape.bounds.add(glm::vec3(high));
    shape.crossings = [=](const Vec& p, const Vec& d) -> std::vector<std::pair<double, double>> {
        double enter = -1e300;
        double leave = 1e300;
        for (int i = 0; i < 3; ++i) {
            if (d[i] == 0.0) {
                if (p[i] <= low[i] || p[i] >= high[i]) {
                    return {};
                }
                continue;
            }
            const double a = (low[i] - p[i]) / d[i];
            const double b = (high[i] - p[i]) / d[i];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        if (enter >= leave) {
            return {};
        }
        return {{enter, leave}};
    };
    shape.normal = [=](const Vec& p) {
        // The face that p is nearest to.
        Vec normal(0.0);
        double nearest = 1e300;
        for (int i = 0; i < 3; ++i) {
            if (std::abs(p[i] - low[i]) < nearest) {
                nearest = std::abs(p[i] - low[i]);
                normal = Vec(0.0);
                normal[i] = -1.0;
            }
            if (std::abs(p[i] - high[i]) < nearest) {
                nearest = std::abs(p[i] - high[i]);
                normal = Vec(0.0);
                normal[i] = 1.0;
            }
        }
        return normal;
    };
    shape.distance = [=](const Vec& p) {
        const Vec q = glm::max(low - p, p - high);
        return glm::length(glm::max(q, Vec(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
    };
    return shape;
}

/// Shapes that do not overlap, as one.
inline Shape unite(std::vector<Shape> shapes) {
    Shape shape;
    for (const Shape& one : shapes) {
        shape.bounds.add(one.bounds.min);
        shape.bounds.add(one.bounds.max);
    }
    const auto nearest = [shapes](const Vec& p) -> const Shape& {
        return *std::min_element(shapes.begin(), shapes.end(), [&](const Shape& a, const Shape& b) {
            return std::abs(a.distance(p)) < std::abs(b.distance(p));
        });
    };
    shape.crossings = [shapes](const Vec& p, const Vec& d) {
        std::vector<std::pair<double, double>> all;
        for (const Shape& one : shapes) {
            const auto some = one.crossings(p, d);
            all.insert(all.end(), some.begin(), some.end());
        }
        std::sort(all.begin(), all.end());
        return all;
    };
    shape.normal = [nearest](const Vec& p) { return nearest(p).normal(p); };
    shape.distance = [shapes](const Vec& p) {
        double distance = 1e300;
        for (const Shape& one : shapes) {
            distance = std::min(distance, one.distance(p));
        }
        return distance;
    };
    return shape;
}

/// Where an orthographic map looks: along +axis or −axis.
struct View {
    int axis = 2;
    bool positive = true;
};

/// An orthographic map of `format` tightly round the shape's bounds, one empty texel round it.
inline DepthMap orthographicMap(const Shape& shape, MapFormat format, Compare compare, const View& view,
                                std::uint32_t size) {
    DepthMap map;
    map.format = format;
    map.compare = compare;
    map.width = size;
    map.height = size;
    const int axes[3] = {(view.axis + 1) % 3, (view.axis + 2) % 3, view.axis};
    const Vec low(shape.bounds.min);
    const Vec high(shape.bounds.max);
    Vec origin(0.0);  // of the map's volume, where its coordinates are 0
    Vec span[3] = {Vec(0.0), Vec(0.0), Vec(0.0)};
    for (int i = 0; i < 3; ++i) {
        const int a = axes[i];
        const bool depth = i == 2;
        const double inner = high[a] - low[a];
        // Across: one texel of border on each side. Along: a hundredth, so that no depth is 0 or 1.
        const double margin = depth ? 0.01 * inner : inner / (size - 2.0);
        const double whole = inner + 2.0 * margin;
        const double sign = depth && !view.positive ? -1.0 : 1.0;
        origin[a] = sign > 0.0 ? low[a] - margin : high[a] + margin;
        span[i][a] = sign * whole;
        map.object_per_map[i] = static_cast<float>(whole);
        glm::vec4 row(0.0F);
        row[a] = static_cast<float>(sign / whole);
        row.w = static_cast<float>(-origin[a] * sign / whole);
        map.object_to_map.row[i] = row;
    }
    map.texels.resize(map.texelBytes());
    for (std::uint32_t y = 0; y < size; ++y) {
        for (std::uint32_t x = 0; x < size; ++x) {
            const Vec start = origin + (x + 0.5) / size * span[0] + (y + 0.5) / size * span[1];
            const auto parts = shape.crossings(start, span[2]);
            const bool border = x == 0 || y == 0 || x + 1 == size || y + 1 == size;
            Texel texel;
            const auto surface = [&](double t) {
                return Surface{static_cast<float>(t), glm::vec3(shape.normal(start + t * span[2]))};
            };
            if (!parts.empty() && !border) {
                if (compare == Compare::kGreater) {
                    texel.front = surface(parts.back().second);
                } else {
                    texel.front = surface(parts.front().first);
                }
                if (compare == Compare::kBoth) {
                    texel.back = surface(parts.back().second);
                }
            }
            encodeTexel(format, texel, map.texelAt(0, x, y));
        }
    }
    return map;
}

/// A depth cube round `center`, whose half sides are `half`. kLess: the centre lies in free space.
inline DepthMap cubeMap(const Shape& shape, Compare compare, const Vec& center, const Vec& half,
                        std::uint32_t size) {
    DepthMap map;
    map.format = MapFormat::kCube8;
    map.compare = compare;
    map.width = size;
    map.height = size;
    map.object_per_map = glm::vec3(half);
    map.encloses = compare == Compare::kGreater;
    map.empty_is_outside = true;
    for (int i = 0; i < 3; ++i) {
        glm::vec4 row(0.0F);
        row[i] = static_cast<float>(1.0 / half[i]);
        row.w = static_cast<float>(-center[i] / half[i]);
        map.object_to_map.row[i] = row;
    }
    map.texels.resize(map.texelBytes());
    for (std::uint32_t face = 0; face < 6; ++face) {
        for (std::uint32_t y = 0; y < size; ++y) {
            for (std::uint32_t x = 0; x < size; ++x) {
                const glm::vec3 at =
                    cubeDirection({face, (static_cast<float>(x) + 0.5F) / static_cast<float>(size),
                                   (static_cast<float>(y) + 0.5F) / static_cast<float>(size)});
                const Vec unit = glm::normalize(Vec(at));
                const Vec d = half * unit;  // object space, for one unit of the normalised volume
                std::optional<double> depth;
                for (const auto& [enter, leave] : shape.crossings(center, d)) {
                    const double t = compare == Compare::kGreater ? leave : enter;
                    if (t > 0.0 && (!depth || compare == Compare::kGreater)) {
                        depth = t;
                    }
                }
                Texel texel;
                // What lies outside the volume is not seen by the map.
                if (depth &&
                    *depth * std::max({std::abs(unit.x), std::abs(unit.y), std::abs(unit.z)}) <= 1.0) {
                    texel.front =
                        Surface{static_cast<float>(*depth), glm::vec3(shape.normal(center + *depth * d))};
                }
                encodeTexel(map.format, texel, map.texelAt(face, x, y));
            }
        }
    }
    return map;
}

/// Three front-back maps along the axes.
inline Collider frontBackCollider(const Shape& shape, std::uint32_t size) {
    Collider collider;
    collider.bounds = shape.bounds;
    for (int axis = 0; axis < 3; ++axis) {
        collider.maps.push_back(
            orthographicMap(shape, MapFormat::kFrontBackHalf, Compare::kBoth, {axis, true}, size));
    }
    return collider;
}

}  // namespace relief::analytic
