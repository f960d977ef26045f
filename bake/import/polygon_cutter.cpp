// SPDX-License-Identifier: Apache-2.0
#include "bake/import/polygon_cutter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bake/mesh/triangle_plane.h"
#include "formats/base/portable_math.h"

namespace relief {
namespace {

/// Returns a normal whose length is twice the polygon's area (Newell's formula). Computes relative to the first corner,
/// for precision far from the origin.
glm::dvec3 normalOf(std::span<const glm::vec3> corners) {
    const glm::dvec3 origin(corners[0]);
    glm::dvec3 normal(0.0);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        normal += cross(glm::dvec3(corners[i]) - origin, glm::dvec3(corners[i + 1]) - origin);
    }
    return normal;
}

/// Whether the angle at corner `at` of a quadrilateral exceeds 180°: the sum of the two angles beside the diagonal.
/// Uses float precision like assimp, because rounding decides for corners on straight edges.
bool isDent(std::span<const glm::vec3> corners, std::size_t at) {
    constexpr float kHalfTurn = 3.14159265F;
    const auto towards = [&](std::size_t other) {
        const glm::vec3 v = corners[(at + other) % 4] - corners[at];
        const float size = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
        return size == 0.0F ? v : v * (1.0F / size);
    };
    const glm::vec3 diagonal = towards(2);
    const auto angle = [&diagonal](const glm::vec3& v) {
        return static_cast<float>(
            portable::acos(double{v.x * diagonal.x + v.y * diagonal.y + v.z * diagonal.z}));
    };
    return angle(towards(3)) + angle(towards(1)) > kHalfTurn;
}

/// Larger polygons skip the rounded tests, which take quadratic time.
constexpr std::size_t kRoundedMax = 2000;

}  // namespace

std::span<const glm::uvec3> PolygonCutter::cut(std::span<const glm::vec3> corners) {
    triangles_.clear();
    if (corners.size() == 3) {
        triangles_.emplace_back(0, 1, 2);
        return triangles_;
    }
    project(corners);
    if (corners.size() == 4) {
        cutQuad(corners);
        return triangles_;
    }
    std::size_t fewest = corners.size() + 1;
    for (const Test test : {Test::kRounded, Test::kInside, Test::kTouching}) {
        if (test == Test::kRounded && corners.size() > kRoundedMax) {
            continue;
        }
        cutEars(test);
        if (const std::size_t wrong = wrongTriangles(corners); wrong < fewest) {
            fewest = wrong;
            std::swap(triangles_, best_);
        }
        if (fewest == 0) {
            break;
        }
    }
    return best_;
}

void PolygonCutter::project(std::span<const glm::vec3> corners) {
    const glm::dvec3 normal = normalOf(corners);
    const glm::dvec3 size(std::abs(normal.x), std::abs(normal.y), std::abs(normal.z));
    const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : size.y > size.z ? 1 : 2;
    int right = (axis + 1) % 3;
    int up = (axis + 2) % 3;
    if (normal[axis] < 0.0) {
        std::swap(right, up);
    }
    points_.clear();
    for (const glm::vec3& corner : corners) {
        points_.emplace_back(corner[right], corner[up]);
    }
}

double PolygonCutter::area(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const glm::dvec2 ab = points_[b] - points_[a];
    const glm::dvec2 ac = points_[c] - points_[a];
    return ab.x * ac.y - ab.y * ac.x;
}

void PolygonCutter::cutQuad(std::span<const glm::vec3> corners) {
    std::uint32_t start = 0;
    while (start < 4 && !isDent(corners, start)) {
        ++start;
    }
    start %= 4;
    const auto flat = [&](std::uint32_t s) {
        triangles_ = {{s, (s + 1) % 4, (s + 2) % 4}, {s, (s + 2) % 4, (s + 3) % 4}};
        return std::ranges::count_if(triangles_, [&](const glm::uvec3& t) {
            return !hasArea(planeOf(corners[t.x], corners[t.y], corners[t.z]));
        });
    };
    if (const auto before = flat(start); before > 0 && flat((start + 1) % 4) >= before) {
        flat(start);
    }
}

void PolygonCutter::cutEars(Test test) {
    const auto count = static_cast<std::uint32_t>(points_.size());
    triangles_.clear();
    before_.resize(count);
    next_.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        before_[i] = (i + count - 1) % count;
        next_[i] = (i + 1) % count;
    }
    reflex_.assign(count, 0);
    reflexes_.clear();
    for (std::uint32_t i = 0; i < count && test != Test::kRounded; ++i) {
        markReflex(i);
        // NaN lies in no ear and cannot be sorted.
        if (reflex_[i] != 0 && std::isfinite(points_[i].x) && std::isfinite(points_[i].y)) {
            reflexes_.push_back(i);
        }
    }
    std::ranges::sort(reflexes_, {}, [&](std::uint32_t i) { return points_[i].x; });
    sorted_ = reflexes_.size();
    std::uint32_t corner = 0;
    std::uint32_t tried = 0;
    for (std::uint32_t left = count; left > 3;) {
        bool cuts = isEar(corner, test);
        if (!cuts && ++tried == left) {
            if (test == Test::kRounded) {
                triangles_.assign(count, glm::uvec3(0));
                return;  // failed: worse than any other attempt
            }
            corner = largestCorner(corner);
            cuts = true;
        }
        const std::uint32_t following = next_[corner];
        if (cuts) {
            cutOff(corner);
            tried = 0;
            --left;
        }
        corner = following;
    }
    const std::uint32_t first = std::min({corner, next_[corner], before_[corner]});
    triangles_.emplace_back(first, next_[first], before_[first]);
}

void PolygonCutter::markReflex(std::uint32_t corner) {
    reflex_[corner] = area(before_[corner], corner, next_[corner]) > 0.0 ? 0 : 1;
}

bool PolygonCutter::isEar(std::uint32_t corner, Test test) const {
    if (test == Test::kRounded) {
        return isRoundedEar(corner);
    }
    if (reflex_[corner] != 0) {
        return false;
    }
    const auto blocks = [&](std::uint32_t other) {
        return reflex_[other] != 0 && holds(corner, points_[other], test);
    };
    const double x[3] = {points_[before_[corner]].x, points_[corner].x, points_[next_[corner]].x};
    const auto [low, high] = std::minmax({x[0], x[1], x[2]});
    const auto sorted_end = reflexes_.begin() + static_cast<std::ptrdiff_t>(sorted_);
    auto other = std::lower_bound(reflexes_.begin(), sorted_end, low,
                                  [&](std::uint32_t i, double value) { return points_[i].x < value; });
    for (; other != sorted_end && points_[*other].x <= high; ++other) {
        if (blocks(*other)) {
            return false;
        }
    }
    return std::none_of(sorted_end, reflexes_.end(), blocks);
}

bool PolygonCutter::isRoundedEar(std::uint32_t corner) const {
    const glm::dvec2& a = points_[before_[corner]];
    const glm::dvec2& b = points_[corner];
    const glm::dvec2& c = points_[next_[corner]];
    if (a.x * (c.y - b.y) + b.x * (a.y - c.y) + c.x * (b.y - a.y) > 0.0) {
        return false;
    }
    const glm::vec2 origin(a);
    const glm::vec2 right = glm::vec2(b) - origin;
    const glm::vec2 left = glm::vec2(c) - origin;
    const auto product = [](const glm::vec2& u, const glm::vec2& v) { return double{u.x * v.x + u.y * v.y}; };
    const double rr = product(right, right);
    const double rl = product(right, left);
    const double ll = product(left, left);
    const double scale = 1.0 / (rr * ll - rl * rl);
    return std::ranges::none_of(points_, [&](const glm::dvec2& point) {
        if (point == a || point == b || point == c) {
            return false;
        }
        const glm::vec2 to = glm::vec2(point) - origin;
        const double u = (ll * product(right, to) - rl * product(left, to)) * scale;
        const double v = (rr * product(left, to) - rl * product(right, to)) * scale;
        return u > 0.0 && v > 0.0 && u + v < 1.0;
    });
}

bool PolygonCutter::holds(std::uint32_t ear, const glm::dvec2& point, Test test) const {
    const glm::dvec2 corners[3] = {points_[before_[ear]], points_[ear], points_[next_[ear]]};
    bool inside = true;
    for (int i = 0; i < 3 && inside; ++i) {
        const glm::dvec2 edge = corners[(i + 1) % 3] - corners[i];
        const glm::dvec2 to = point - corners[i];
        // A polygon with joined holes visits some points twice.
        inside = point != corners[i];
        const double side = edge.x * to.y - edge.y * to.x;
        inside = inside && (test == Test::kInside ? side > 0.0 : side >= 0.0);
    }
    return inside;
}

void PolygonCutter::cutOff(std::uint32_t ear) {
    const std::uint32_t before = before_[ear];
    const std::uint32_t next = next_[ear];
    triangles_.emplace_back(before, ear, next);
    next_[before] = next;
    before_[next] = before;
    reflex_[ear] = 0;
    for (const std::uint32_t neighbour : {before, next}) {
        const bool was = reflex_[neighbour] != 0;
        markReflex(neighbour);
        // In a self-intersecting polygon, a convex corner may become reflex.
        if (!was && reflex_[neighbour] != 0) {
            reflexes_.push_back(neighbour);
        }
    }
}

std::uint32_t PolygonCutter::largestCorner(std::uint32_t start) const {
    std::uint32_t largest = start;
    double best = area(before_[start], start, next_[start]);
    for (std::uint32_t i = next_[start]; i != start; i = next_[i]) {
        if (const double size = area(before_[i], i, next_[i]); size > best) {
            best = size;
            largest = i;
        }
    }
    return largest;
}

std::size_t PolygonCutter::wrongTriangles(std::span<const glm::vec3> corners) const {
    return static_cast<std::size_t>(std::ranges::count_if(triangles_, [&](const glm::uvec3& t) {
        return area(t.x, t.y, t.z) < 0.0 || !hasArea(planeOf(corners[t.x], corners[t.y], corners[t.z]));
    }));
}

void TriangleStarts::turn(std::span<glm::uvec3> polygon) {
    const bool quad = polygon.size() == 2;
    for (glm::uvec3& t : polygon) {
        if (t.x == last_) {
            t = {t.z, t.x, t.y};
            // Both triangles of a quadrilateral begin at the same end of the diagonal.
            if (quad) {
                polygon[1] = {t.x, polygon[1].z, polygon[1].x};
            }
        }
        last_ = t.x;
        if (quad) {
            return;
        }
    }
}

}  // namespace relief
