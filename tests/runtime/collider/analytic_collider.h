// SPDX-License-Identifier: Apache-2.0
// Colliders made from closed-form shapes. Runtime tests then need neither a mesh nor a baker, and the truth is exact at
// every point. tests/formats/analytic_shapes.h makes the texels.
#pragma once

#include <algorithm>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "formats/collider.h"
#include "tests/formats/analytic_shapes.h"

namespace relief::analytic {

using Vec = glm::dvec3;

struct Shape {
    Bounds bounds;
    std::shared_ptr<const test::Shape> solid;
    std::function<double(const Vec& p)> distance;  ///< exact signed distance, negative inside
};

inline Shape sphere(const Vec& center, double radius) {
    return {{glm::vec3(center - Vec(radius)), glm::vec3(center + Vec(radius))},
            test::makeSphere(center, radius),
            [=](const Vec& p) { return glm::length(p - center) - radius; }};
}

inline Shape box(const Vec& low, const Vec& high) {
    return {{glm::vec3(low), glm::vec3(high)},
            test::makeBox(0.5 * (low + high), 0.5 * (high - low)),
            [=](const Vec& p) {
                const Vec q = glm::max(low - p, p - high);
                return glm::length(glm::max(q, Vec(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
            }};
}

/// The union of shapes that do not overlap.
inline Shape unite(const std::vector<Shape>& shapes) {
    struct Union : test::Shape {
        explicit Union(const std::vector<analytic::Shape>& all) : shapes(all) {}
        [[nodiscard]] std::vector<test::Hit> hits(const Vec& origin, const Vec& direction) const override {
            std::vector<test::Hit> all;
            for (const analytic::Shape& one : shapes) {
                const auto some = one.solid->hits(origin, direction);
                all.insert(all.end(), some.begin(), some.end());
            }
            std::ranges::sort(all, {}, &test::Hit::t);
            return all;
        }
        [[nodiscard]] bool inside(const Vec& p) const override {
            return std::ranges::any_of(shapes, [&](const auto& one) { return one.solid->inside(p); });
        }
        std::vector<analytic::Shape> shapes;
    };
    Shape shape{{}, std::make_shared<Union>(shapes), [shapes](const Vec& p) {
                    double distance = 1e300;
                    for (const Shape& one : shapes) {
                        distance = std::min(distance, one.distance(p));
                    }
                    return distance;
                }};
    for (const Shape& one : shapes) {
        shape.bounds.add(one.bounds.min);
        shape.bounds.add(one.bounds.max);
    }
    return shape;
}

/// The direction of an orthographic map: along +axis or −axis.
struct View {
    int axis = 2;
    bool positive = true;
};

/// An orthographic map of `format` that fits the shape's bounds, with a border of one empty texel.
inline DepthMap orthographicMap(const Shape& shape, MapFormat format, Compare compare, const View& view,
                                std::uint32_t size) {
    const int axes[3] = {(view.axis + 1) % 3, (view.axis + 2) % 3, view.axis};
    const Vec low(shape.bounds.min);
    const Vec high(shape.bounds.max);
    test::OrthographicFrame frame{Vec(0.0), glm::dmat3(0.0), Vec(0.0)};
    for (int i = 0; i < 3; ++i) {
        const int a = axes[i];
        const double inner = high[a] - low[a];
        // Across: a border of one texel on each side. Along: a hundredth, so that no depth is 0 or 1.
        const double margin = i == 2 ? 0.01 * inner : inner / (size - 2.0);
        const bool forward = i < 2 || view.positive;
        frame.origin[a] = forward ? low[a] - margin : high[a] + margin;
        frame.axes[i][a] = forward ? 1.0 : -1.0;
        frame.sides[i] = inner + 2.0 * margin;
    }
    return test::makeMap(*shape.solid, frame, format, compare, size, size);
}

/// A depth cube around `center` with half sides `half`. kLess: the centre lies in free space.
inline DepthMap cubeMap(const Shape& shape, Compare compare, const Vec& center, const Vec& half,
                        std::uint32_t size) {
    DepthMap map = test::makeMap(*shape.solid, {center, glm::dmat3(1.0), half}, compare, size);
    map.encloses = compare == Compare::kGreater;
    map.empty_is_outside = true;
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
