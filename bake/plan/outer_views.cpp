#include "bake/plan/outer_views.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <optional>

#include "bake/mesh/triangle_plane.h"
#include "bake/plan/view.h"
#include "formats/base/portable_math.h"

namespace relief {
namespace {

/// In how many ways an image is turned, and the share of the bytes that is left where it is worth it.
constexpr int kTurns = 8;
constexpr double kTurnGain = 0.96;
/// Views whose silhouette is smaller than this share of the largest look at a flat mesh edge-on.
constexpr double kSmallestView = 0.1;

/// A direction to look along, and how its image is turned; nullopt: by the rule of view.h.
struct Candidate {
    glm::dvec3 direction;
    std::optional<glm::dvec3> up;
};

/// Area of the rectangle round the points as a view with this frame shows them.
double rectangleArea(const std::vector<glm::dvec3>& points, const glm::dvec3& direction,
                     const glm::dvec3& up) {
    const glm::dvec3 right = cross(direction, up) / length(cross(direction, up));
    const glm::dvec3 upwards = cross(right, direction);
    glm::dvec2 low(std::numeric_limits<double>::max());
    glm::dvec2 high(std::numeric_limits<double>::lowest());
    for (const glm::dvec3& p : points) {
        const glm::dvec2 at(dot(p, right), dot(p, upwards));
        low = glm::min(low, at);
        high = glm::max(high, at);
    }
    return (high.x - low.x) * (high.y - low.y);
}

/// The outer directions and the axes of the oriented box, each turned by the axis of that box that makes its
/// rectangle clearly smaller than the rule of view.h does.
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
        const bool known = std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& candidate) {
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

/// Area between the ends of rows, as the points show them.
double rowsArea(const std::vector<glm::dvec3>& points, const glm::dvec3& right, const glm::dvec3& up) {
    constexpr std::size_t kStrips = 64;
    std::vector<glm::dvec2> places;
    places.reserve(points.size());
    glm::dvec2 y_range(std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest());
    for (const glm::dvec3& point : points) {
        places.emplace_back(dot(point, right), dot(point, up));
        y_range = {std::min(y_range.x, places.back().y), std::max(y_range.y, places.back().y)};
    }
    const double strip =
        std::max(y_range.y - y_range.x, std::numeric_limits<double>::min()) / static_cast<double>(kStrips);
    std::array<glm::dvec2, kStrips> ends;
    ends.fill({std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()});
    for (const glm::dvec2& at : places) {
        glm::dvec2& end = ends[std::min(kStrips - 1, static_cast<std::size_t>((at.y - y_range.x) / strip))];
        end = {std::min(end.x, at.x), std::max(end.y, at.x)};
    }
    double width = 0.0;
    for (const glm::dvec2& end : ends) {
        width += std::max(0.0, end.y - end.x);
    }
    return width * strip;
}

/// Turns an image so that its rows, from one end of the silhouette to the other, take up least.
Result<void> turn(OuterView& view, const TriangleMesh& mesh, const VertexBlocks& blocks,
                  const std::vector<glm::dvec3>& points) {
    const View first = RELIEF_TRY(makeView(view.spec, mesh, &blocks));
    const glm::dvec3 right = first.axis[0] / length(first.axis[0]);
    const glm::dvec3 up = first.axis[1] / length(first.axis[1]);
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

/// The view of a candidate, and how large it is.
Result<void> measure(const Candidate& candidate, const TriangleMesh& mesh, const VertexBlocks& blocks,
                     const std::vector<glm::dvec3>& points, OuterView& view) {
    view.spec.format = MapFormat::kFrontBackFixed;
    view.spec.decode = Decode::kPlane;
    view.spec.direction = glm::vec3(candidate.direction) + 0.0F;  // no −0, for the reason
    if (candidate.up) {
        view.spec.up = glm::vec3(*candidate.up);
    }
    view.spec.width = view.spec.height = 64;  // any: the extents do not depend on it
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
    for (glm::dvec3& direction : directions) {
        direction /= length(direction);
    }
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
