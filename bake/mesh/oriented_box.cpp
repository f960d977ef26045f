// SPDX-License-Identifier: Apache-2.0
#include "bake/mesh/oriented_box.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <utility>

#include "bake/mesh/triangle_plane.h"
#include "formats/base/portable_math.h"

namespace relief {
namespace {

/// Flatter points count as a plane; in units of their longest side.
constexpr double kThicknessMin = 1e-5;
/// Far above the rounding of float vertices, far below what a texel resolves.
constexpr double kRounding = 1e-6;
/// Closer points count as one; in units of the longest side.
constexpr double kCoincident = 1e-9;
/// Radians between the normals tried along one edge of the hull.
constexpr double kNormalStep = 0.1;
/// Edges whose best normal is refined, and the step in radians at which refinement ends.
constexpr std::size_t kRefinedEdges = 16;
constexpr double kLastStep = 1e-8;
/// A box replaces an earlier one only if it is smaller by more than rounding.
constexpr double kGain = 1.0 - 1e-9;

/// Directions of the octahedron's lattice: spread over the sphere, and the same bits everywhere.
std::vector<glm::dvec3> fixedDirections() {
    constexpr int kLattice = 6;
    std::vector<glm::dvec3> directions;
    for (int j = -kLattice; j <= kLattice; ++j) {
        for (int i = -kLattice; i <= kLattice; ++i) {
            const int k = kLattice - std::abs(i) - std::abs(j);
            if (k >= 0) {
                directions.emplace_back(i, j, k);
            }
            if (k > 0) {
                directions.emplace_back(i, j, -k);
            }
        }
    }
    return directions;
}

/// Centred and scaled to a longest side of 1. Empty if the points coincide or are not finite.
std::vector<glm::dvec3> normalizedPoints(std::span<const glm::dvec3> points) {
    if (points.empty()) {
        return {};
    }
    glm::dvec3 low = points.front();
    glm::dvec3 high = points.front();
    for (const glm::dvec3& p : points) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::dvec3 size = high - low;
    const double side = std::max({size.x, size.y, size.z});
    if (!(side > 0.0) || !std::isfinite(side)) {
        return {};
    }
    std::vector<glm::dvec3> scaled;
    for (const glm::dvec3& p : points) {
        scaled.push_back((p - 0.5 * (low + high)) / side);
    }
    return scaled;
}

/// From one point to the farthest, to the farthest from their line, to the farthest from their plane.
bool spanVolume(const std::vector<glm::dvec3>& points) {
    const auto farthest = [&](const auto& distance) {
        return *std::ranges::max_element(points, {}, distance);
    };
    const glm::dvec3 origin = points.front();
    const glm::dvec3 line = farthest([&](const glm::dvec3& p) { return glm::length(p - origin); }) - origin;
    const auto fromLine = [&](const glm::dvec3& p) { return glm::length(glm::cross(p - origin, line)); };
    const glm::dvec3 normal = glm::cross(farthest(fromLine) - origin, line);
    const double size = glm::length(normal);
    if (!(size > kThicknessMin * glm::length(line))) {
        return false;
    }
    const auto fromPlane = [&](const glm::dvec3& p) { return std::abs(glm::dot(p - origin, normal)) / size; };
    return fromPlane(farthest(fromPlane)) > kThicknessMin;
}

double extent(const std::vector<glm::dvec3>& points, const glm::dvec3& axis) {
    const auto [low, high] =
        std::ranges::minmax_element(points, {}, [&](const glm::dvec3& p) { return glm::dot(p, axis); });
    return glm::dot(*high - *low, axis);
}

double cross2(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

/// Two unit vectors that are perpendicular to a unit vector and to each other, right-handed with it.
std::array<glm::dvec3, 2> planeBasis(const glm::dvec3& normal) {
    const glm::dvec3 size = glm::abs(normal);
    const int smallest = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
    glm::dvec3 other(0.0);
    other[smallest] = 1.0;
    const glm::dvec3 first = unit(glm::cross(other, normal));
    return {first, glm::cross(normal, first)};
}

/// Corners of the convex polygon round the points, counter-clockwise (Andrew's monotone chain).
std::vector<glm::dvec2> convexPolygon(std::vector<glm::dvec2> points) {
    std::ranges::sort(points, [](const glm::dvec2& a, const glm::dvec2& b) {
        return a.x < b.x || (a.x == b.x && a.y < b.y);
    });
    std::vector<glm::dvec2> polygon;
    const auto addChain = [&polygon](const auto& begin, const auto& end) {
        const std::size_t first = polygon.size();
        for (auto p = begin; p != end; ++p) {
            while (polygon.size() >= first + 2 &&
                   cross2(polygon.back() - polygon[polygon.size() - 2], *p - polygon.back()) <= 0.0) {
                polygon.pop_back();
            }
            polygon.push_back(*p);
        }
        polygon.pop_back();  // the first of the other chain
    };
    addChain(points.begin(), points.end());
    addChain(points.rbegin(), points.rend());
    return polygon;
}

struct Box {
    std::array<glm::dvec3, 3> axes{glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)};
    double volume = std::numeric_limits<double>::infinity();
};

/// The least box with two sides perpendicular to a unit vector: one side of its rectangle lies on a side of the convex polygon.
Box leastBoxAcross(const std::vector<glm::dvec3>& points, const glm::dvec3& normal) {
    const auto [right, up] = planeBasis(normal);
    std::vector<glm::dvec2> projected;
    projected.reserve(points.size());
    for (const glm::dvec3& p : points) {
        projected.emplace_back(glm::dot(p, right), glm::dot(p, up));
    }
    const std::vector<glm::dvec2> polygon = convexPolygon(std::move(projected));
    const double height = extent(points, normal);
    Box best;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2 side = polygon[(i + 1) % polygon.size()] - polygon[i];
        const double length = glm::length(side);
        if (!(length > 0.0)) {
            continue;
        }
        const glm::dvec2 along = side / length;
        double low = 0.0;
        double high = 0.0;
        double across = 0.0;
        for (const glm::dvec2& p : polygon) {
            const glm::dvec2 q = p - polygon[i];
            low = std::min(low, glm::dot(q, along));
            high = std::max(high, glm::dot(q, along));
            across = std::max(across, cross2(along, q));
        }
        const double volume = height * (high - low) * across;
        if (volume < kGain * best.volume) {
            best.volume = volume;
            best.axes = {normal, along.x * right + along.y * up, along.x * up - along.y * right};
        }
    }
    return best;
}

/// The planes that touch the convex hull along one edge, by their normals: cos(a) · first + sin(a) · last for a from 0 to
/// angle. Those at both ends are faces.
struct HullEdge {
    glm::dvec3 first;
    glm::dvec3 last;
    double angle = 0.0;  ///< below π

    [[nodiscard]] glm::dvec3 normal(double a) const {
        return portable::cos(a) * first + portable::sin(a) * last;
    }
};

/// The edge between two points, if the others, projected along it, span less than half a turn.
std::optional<HullEdge> hullEdge(const std::vector<glm::dvec3>& points, std::size_t from, std::size_t to) {
    const glm::dvec3 line = points[to] - points[from];
    const double length = glm::length(line);
    if (!(length > kCoincident)) {
        return std::nullopt;
    }
    const auto [x, y] = planeBasis(line / length);
    std::optional<glm::dvec2> right;
    glm::dvec2 left{};
    for (const glm::dvec3& p : points) {
        const glm::dvec2 q(glm::dot(p - points[from], x), glm::dot(p - points[from], y));
        if (!(std::max(std::abs(q.x), std::abs(q.y)) > kCoincident)) {
            continue;  // on the line
        }
        if (!right) {
            right = left = q;
            continue;
        }
        const double from_right = cross2(*right, q);
        const double to_left = cross2(q, left);
        if (from_right < 0.0 && to_left < 0.0) {
            return std::nullopt;
        }
        if (from_right < 0.0) {
            right = q;
        } else if (to_left < 0.0 || (from_right == 0.0 && glm::dot(*right, q) < 0.0)) {
            left = q;
        }
    }
    if (!right) {
        return std::nullopt;
    }
    // The faces' outward normals, turned clockwise from the right and counter-clockwise from the left.
    const glm::dvec2 r = *right / glm::length(*right);
    const glm::dvec2 end = glm::dvec2(-left.y, left.x);
    HullEdge edge;
    edge.first = r.y * x - r.x * y;
    edge.last = -r.x * x - r.y * y;
    edge.angle = std::max(0.0, portable::atan2(-glm::dot(end, r), cross2(end, r)));
    return edge;
}

/// A normal in the range of an edge, and the least box with a side of this normal.
struct Candidate {
    HullEdge edge;
    double at = 0.0;
    double step = 0.0;
    Box box;

    void tryNormal(const std::vector<glm::dvec3>& points, double a) {
        const Box other = leastBoxAcross(points, edge.normal(a));
        if (other.volume < kGain * box.volume) {
            box = other;
            at = a;
        }
    }
};

/// Of a least box, a side touches an edge of the hull (O'Rourke, "Finding minimal enclosing boxes", 1985): tries normals in the
/// range of each edge, and refines those of the best edges.
Box leastBox(const std::vector<glm::dvec3>& points) {
    std::vector<Candidate> candidates;
    for (std::size_t to = 1; to < points.size(); ++to) {
        for (std::size_t from = 0; from < to; ++from) {
            const std::optional<HullEdge> edge = hullEdge(points, from, to);
            if (!edge) {
                continue;
            }
            const int steps = std::max(1, static_cast<int>(std::ceil(edge->angle / kNormalStep)));
            Candidate candidate{*edge, 0.0, edge->angle / steps, {}};
            for (int i = 0; i <= steps; ++i) {
                candidate.tryNormal(points, edge->angle * i / steps);
            }
            candidates.push_back(candidate);
        }
    }
    std::ranges::stable_sort(candidates, {}, [](const Candidate& c) { return c.box.volume; });
    Box best;
    best.volume = extent(points, best.axes[0]) * extent(points, best.axes[1]) * extent(points, best.axes[2]);
    for (std::size_t i = 0; i < std::min(kRefinedEdges, candidates.size()); ++i) {
        Candidate& c = candidates[i];
        for (double step = 0.5 * c.step; step > kLastStep; step *= 0.5) {
            const double middle = c.at;
            c.tryNormal(points, std::max(0.0, middle - step));
            c.tryNormal(points, std::min(c.edge.angle, middle + step));
        }
        if (c.box.volume < kGain * best.volume) {
            best = c.box;
        }
    }
    return best;
}

}  // namespace

std::vector<glm::dvec3> extremeVertices(const VertexBlocks& vertices) {
    std::vector<std::size_t> farthest;
    for (const glm::dvec3& direction : fixedDirections()) {
        farthest.push_back(vertices.farthest(direction));
    }
    std::ranges::sort(farthest);
    farthest.erase(std::unique(farthest.begin(), farthest.end()), farthest.end());
    std::vector<glm::dvec3> points;
    for (const std::size_t i : farthest) {
        points.emplace_back(vertices.positions()[i]);
    }
    return points;
}

std::optional<std::array<glm::dvec3, 3>> orientedBoxAxes(std::span<const glm::dvec3> points) {
    const std::vector<glm::dvec3> scaled = normalizedPoints(points);
    if (scaled.size() < 4 || !spanVolume(scaled)) {
        return std::nullopt;
    }
    std::array<glm::dvec3, 3> axes = leastBox(scaled).axes;
    for (glm::dvec3& axis : axes) {
        for (int k = 0; k < 3; ++k) {
            axis[k] = std::abs(axis[k]) < kRounding ? 0.0 : axis[k];
        }
        // Of two opposite axes, the one whose largest component is positive.
        const glm::dvec3 size = glm::abs(axis);
        const int largest = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        axis *= axis[largest] < 0.0 ? -1.0 : 1.0;
        axis /= glm::length(axis);
    }
    std::ranges::stable_sort(axes, std::greater<>(), [&](const glm::dvec3& a) { return extent(scaled, a); });
    if (glm::dot(glm::cross(axes[0], axes[1]), axes[2]) < 0.0) {
        axes[2] = -axes[2];
    }
    // Written so that NaN fails too.
    for (std::size_t i = 0; i < 3; ++i) {
        if (!(std::abs(glm::dot(axes[i], axes[(i + 1) % 3])) < 1e-5)) {
            return std::nullopt;
        }
        axes[i] += 0.0;  // no −0
    }
    return axes;
}

std::optional<OrientedBox> orientedBox(const VertexBlocks& vertices) {
    std::vector<glm::dvec3> corners = extremeVertices(vertices);
    const std::optional<std::array<glm::dvec3, 3>> axes = orientedBoxAxes(corners);
    return axes ? std::optional(OrientedBox{std::move(corners), *axes}) : std::nullopt;
}

}  // namespace relief
