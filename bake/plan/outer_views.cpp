// SPDX-License-Identifier: Apache-2.0
#include "bake/plan/outer_views.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <optional>

#include "bake/plan/view.h"
#include "formats/base/portable_math.h"

namespace relief {
namespace {

/// Rotations of an image that are tried, and the share of the bytes below which one is worth it.
constexpr int kTurns = 8;
constexpr double kTurnGain = 0.96;
/// A view whose silhouette is a smaller share of the largest sees a flat mesh edge-on.
constexpr double kSmallestView = 0.1;

/// A viewing direction and the image's upward direction; nullopt: by the rule of view.h.
struct Candidate {
    glm::dvec3 direction;
    std::optional<glm::dvec3> up;
};

/// Area of the rectangle round the points in a view with this frame.
double rectangleArea(const std::vector<glm::dvec3>& points, const glm::dvec3& direction,
                     const glm::dvec3& up) {
    const glm::dvec3 right = unit(cross(direction, up));
    const glm::dvec3 upwards = cross(right, direction);
    Range x;
    Range y;
    for (const glm::dvec3& p : points) {
        x.add(dot(p, right));
        y.add(dot(p, upwards));
    }
    return x.size() * y.size();
}

/// The outer directions and the axes of the oriented box, each turned by an axis of that box if its rectangle gets clearly
/// smaller than by the rule of view.h.
std::vector<Candidate> outerCandidates(const Bounds& bounds, const std::optional<OrientedBox>& box) {
    std::vector<Candidate> candidates;
    for (const glm::dvec3& direction : outerDirections(bounds)) {
        candidates.push_back({direction, std::nullopt});
    }
    if (!box) {
        return candidates;
    }
    const std::vector<glm::dvec3>& corners = box->corners;
    for (const glm::dvec3& axis : box->axes) {
        const bool known = std::ranges::any_of(candidates, [&](const Candidate& candidate) {
            return std::abs(dot(candidate.direction, axis)) > 1.0 - 1e-9;
        });
        if (!known) {
            candidates.push_back({axis, std::nullopt});
        }
    }
    for (Candidate& candidate : candidates) {
        double least = 0.99 * rectangleArea(corners, candidate.direction, defaultUp(candidate.direction));
        for (const glm::dvec3& axis : box->axes) {
            if (std::abs(dot(candidate.direction, axis)) > 0.9) {
                continue;
            }
            const double area = rectangleArea(corners, candidate.direction, axis);
            if (area < least) {
                least = 0.999999 * area;  // of equals, as of opposite faces of a cube, the first
                candidate.up = axis;
            }
        }
    }
    return candidates;
}

/// Area of the row spans, estimated by the points.
double rowsArea(const std::vector<glm::dvec3>& points, const glm::dvec3& right, const glm::dvec3& up) {
    constexpr std::size_t kStrips = 64;
    std::vector<glm::dvec2> places;
    places.reserve(points.size());
    Range y;
    for (const glm::dvec3& point : points) {
        places.emplace_back(dot(point, right), dot(point, up));
        y.add(places.back().y);
    }
    const double strip =
        std::max(y.size(), std::numeric_limits<double>::min()) / static_cast<double>(kStrips);
    std::array<Range, kStrips> ends;
    for (const glm::dvec2& at : places) {
        ends[std::min(kStrips - 1, static_cast<std::size_t>((at.y - y.min) / strip))].add(at.x);
    }
    double width = 0.0;
    for (const Range& end : ends) {
        width += std::max(0.0, end.size());
    }
    return width * strip;
}

/// Turns an image for the least area of its row spans.
Result<void> turn(OuterView& view, const TriangleMesh& mesh, const VertexBlocks& blocks,
                  const std::vector<glm::dvec3>& points) {
    const View first = RELIEF_TRY(makeView(view.spec, mesh, &blocks));
    const glm::dvec3 right = unit(first.axis[0]);
    const glm::dvec3 up = unit(first.axis[1]);
    view.area = rowsArea(points, right, up);
    double least = kTurnGain * view.area;
    for (int k = 1; k < kTurns; ++k) {
        const double angle = glm::pi<double>() * k / kTurns;
        const double sine = portable::sin(angle);
        const double cosine = portable::cos(angle);
        const glm::dvec3 turned_up = cosine * up + sine * right;
        const double area = rowsArea(points, cosine * right - sine * up, turned_up);
        if (area < least) {
            least = area;
            view.area = area;
            view.spec.up = glm::vec3(turned_up);
        }
    }
    return {};
}

/// The view of a candidate and its size.
Result<void> measure(const Candidate& candidate, const TriangleMesh& mesh, const VertexBlocks& blocks,
                     const std::vector<glm::dvec3>& points, OuterView& view) {
    view.spec.format = MapFormat::kFrontBackFixed;
    view.spec.decode = Decode::kPlane;
    view.spec.direction = glm::vec3(candidate.direction) + 0.0F;  // no −0, for the reason
    if (candidate.up) {
        view.spec.up = glm::vec3(*candidate.up);
    }
    view.spec.width = view.spec.height = 64;  // any: the extents are independent of it
    RELIEF_TRY(turn(view, mesh, blocks, points));
    const View frame = RELIEF_TRY(makeView(view.spec, mesh, &blocks));
    // The inner 62 of 64 texels cover the mesh.
    view.width = length(frame.axis[0]) * 62.0 / 64.0;
    view.height = length(frame.axis[1]) * 62.0 / 64.0;
    return {};
}

}  // namespace

std::vector<glm::dvec3> outerDirections(const Bounds& bounds) {
    // Of the octahedron's lattice.
    std::vector<glm::dvec3> directions = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const glm::dvec3 size = bounds.size();
    for (const double y : {-1.0, 1.0}) {
        for (const double z : {-1.0, 1.0}) {
            directions.emplace_back(size.x, y * size.y, z * size.z);
        }
    }
    constexpr int kLattice = 4;
    for (int j = -kLattice; j <= kLattice; ++j) {
        for (int i = -kLattice; i <= kLattice; ++i) {
            const int k = kLattice - std::abs(i) - std::abs(j);
            const bool opposite_comes = k == 0 && (j < 0 || (j == 0 && i < 0));
            const bool axis = (i == 0) + (j == 0) + (k == 0) == 2;
            if (k >= 0 && !opposite_comes && !axis) {
                directions.emplace_back(i, j, k);
            }
        }
    }
    const double least = 1e-6 * length(size);
    std::erase_if(directions, [&](const glm::dvec3& d) { return !(length(d) > std::min(least, 0.5)); });
    std::ranges::transform(directions, directions.begin(), unit);
    return directions;
}

Result<std::vector<OuterView>> outerViews(const TriangleMesh& mesh, const VertexBlocks& blocks,
                                          const std::vector<glm::dvec3>& points,
                                          const std::optional<OrientedBox>& box) {
    const std::vector<Candidate> candidates = outerCandidates(mesh.bounds, box);
    std::vector<OuterView> views(candidates.size());
    std::vector<Result<void>> done(candidates.size());
    tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t i) {
        done[i] = measure(candidates[i], mesh, blocks, points, views[i]);
    });
    for (Result<void>& result : done) {
        RELIEF_TRY(std::move(result));
    }
    double largest = 0.0;
    for (const OuterView& view : views) {
        largest = std::max(largest, view.area);
    }
    std::erase_if(views, [&](const OuterView& view) { return view.area < kSmallestView * largest; });
    return views;
}

}  // namespace relief
