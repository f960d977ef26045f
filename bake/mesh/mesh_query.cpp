// SPDX-License-Identifier: Apache-2.0
#include "bake/mesh/mesh_query.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "bake/mesh/embree_mesh.h"
#include "bake/mesh/triangle_plane.h"

namespace relief {
namespace {

/// Visits all surfaces on a ray with visit(args, i); the ray continues through each.
template <class Visit>
class EveryHit : public RayQuery {
  public:
    explicit EveryHit(const Visit& visit) : RayQuery(filter), visit_(visit) {}

  private:
    static void filter(const RTCFilterFunctionNArguments* args) {
        for (unsigned i = 0; i < args->N; ++i) {
            if (args->valid[i] != 0) {
                static_cast<EveryHit*>(of(args))->visit_(args, i);
                args->valid[i] = 0;
            }
        }
    }
    const Visit& visit_;
};

/// Returns 1 if ray i leaves through the surface, −1 if it enters.
int sideOf(const RTCFilterFunctionNArguments* args, unsigned i) {
    const double along =
        static_cast<double>(RTCHitN_Ng_x(args->hit, args->N, i)) * RTCRayN_dir_x(args->ray, args->N, i) +
        static_cast<double>(RTCHitN_Ng_y(args->hit, args->N, i)) * RTCRayN_dir_y(args->ray, args->N, i) +
        static_cast<double>(RTCHitN_Ng_z(args->hit, args->N, i)) * RTCRayN_dir_z(args->ray, args->N, i);
    return along < 0.0 ? -1 : 1;
}

/// Returns the depth of a triangle's plane along a ray that hits it, clamped to the triangle's corners, for planes seen
/// edge-on. Embree's own distance contains a quotient that differs between processors.
double depthAt(const TriangleMesh& mesh, std::uint32_t triangle, const glm::dvec3& origin,
               const glm::dvec3& direction) {
    const TrianglePlane plane = planeOf(mesh, triangle);
    const double depth = dot(plane.normal, plane.point - origin) / dot(plane.normal, direction);
    const LineSpan corners = cornerSpan(mesh, triangle, origin, direction);
    // Written so that NaN becomes the nearest corner's depth.
    return std::max(0.0, depth >= corners.begin ? std::min(depth, corners.end) : corners.begin);
}

/// Calls visit(args, i) for all surfaces on a ray from p.
template <class Visit>
void trace(const EmbreeMesh& tree, const glm::vec3& p, const glm::dvec3& direction, const Visit& visit) {
    RTCRayHit query = rayHit(tree.toLocal(p), direction, std::numeric_limits<float>::infinity());
    EveryHit(visit).intersect(tree.scene.get(), query);
}

/// Clips a line to a box, in units of its direction; begin > end if they do not meet.
LineSpan inBox(const Bounds& box, const glm::dvec3& p, const glm::dvec3& direction) {
    LineSpan span{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    for (int axis = 0; axis < 3; ++axis) {
        const double low = double{box.min[axis]} - p[axis];
        const double high = double{box.max[axis]} - p[axis];
        if (direction[axis] == 0.0) {
            if (low > 0.0 || high < 0.0) {
                return {1.0, 0.0};
            }
            continue;
        }
        const double a = low / direction[axis];
        const double b = high / direction[axis];
        span.begin = std::max(span.begin, std::min(a, b));
        span.end = std::min(span.end, std::max(a, b));
    }
    return span;
}

/// Returns the point on a triangle closest to p, in Embree's units.
glm::dvec3 closestOn(const TriangleMesh& mesh, std::uint32_t triangle, const EmbreeMesh& tree,
                     const glm::dvec3& p) {
    const auto [a, b, c] = cornersOf(mesh, triangle);
    return closestOnTriangle(p, tree.toLocal(a), tree.toLocal(b), tree.toLocal(c));
}

/// A search for the closest point, in Embree's units.
struct Search {
    const TriangleMesh& mesh;
    const EmbreeMesh& tree;
    glm::dvec3 p;
    float slack;  // slackAt(p)
    double best_squared = std::numeric_limits<double>::infinity();
    std::uint32_t triangle = RTC_INVALID_GEOMETRY_ID;
    glm::dvec3 point{0.0};

    [[nodiscard]] float radius() const { return static_cast<float>(std::sqrt(best_squared)) + slack; }

    /// Returns true if the triangle is closer than the best so far.
    bool add(std::uint32_t index) {
        const glm::dvec3 closest = closestOn(mesh, index, tree, p);
        const glm::dvec3 offset = closest - p;
        const double squared = dot(offset, offset);
        // Ties go to the lowest index, independent of the order of visits.
        if (squared < best_squared || (squared == best_squared && index < triangle)) {
            best_squared = squared;
            triangle = index;
            point = closest;
            return true;
        }
        return false;
    }

    static bool visit(RTCPointQueryFunctionArguments* args) {
        auto* self = static_cast<Search*>(args->userPtr);
        const bool closer = self->add(args->primID);
        args->query->radius = closer ? self->radius() : args->query->radius;
        return closer;
    }
};

/// A search for any triangle with a different label within a distance, in Embree's units.
struct OtherSearch {
    const TriangleMesh& mesh;
    const EmbreeMesh& tree;
    glm::dvec3 p;
    double squared;
    std::span<const std::uint8_t> labels;
    std::uint8_t label;
    bool found = false;

    static bool visit(RTCPointQueryFunctionArguments* args) {
        auto* self = static_cast<OtherSearch*>(args->userPtr);
        if (self->found || self->labels[args->primID] == self->label) {
            return false;
        }
        const glm::dvec3 offset = closestOn(self->mesh, args->primID, self->tree, self->p) - self->p;
        self->found = dot(offset, offset) <= self->squared;
        args->query->radius = self->found ? 0.0F : args->query->radius;
        return self->found;
    }
};

/// Margin of a search radius, because Embree's boxes and queries are floats.
float slackAt(const glm::dvec3& p) {
    return static_cast<float>(2e-6 * (1.0 + std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)})));
}

/// Visits the triangles that may be within a radius of the search's point, in Embree's units.
template <class S>
void visitNear(S& search, float radius) {
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    RTCPointQuery query{};
    const glm::vec3 at = search.p;
    query.x = at.x;
    query.y = at.y;
    query.z = at.z;
    query.radius = radius;
    rtcPointQuery(search.tree.scene.get(), &query, &context, S::visit, &search);
}

/// The parity directions, each possibly reversed to leave the box sooner, shortest first. Rays then cross fewer layers,
/// such as leaves or grass.
class ParityRays {
  public:
    ParityRays(const Bounds& box, const glm::vec3& p) {
        for (std::size_t i = 0; i < ways_.size(); ++i) {
            const glm::dvec3& along = kParityDirections[i];
            double ahead = std::numeric_limits<double>::infinity();
            double behind = ahead;
            for (int axis = 0; axis < 3; ++axis) {
                const double up = (double{box.max[axis]} - p[axis]) / std::abs(along[axis]);
                const double down = (double{p[axis]} - box.min[axis]) / std::abs(along[axis]);
                ahead = std::min(ahead, along[axis] > 0.0 ? up : down);
                behind = std::min(behind, along[axis] > 0.0 ? down : up);
            }
            ways_[i] = {std::min(ahead, behind), behind < ahead ? -along : along};
        }
        std::ranges::stable_sort(ways_, {}, &Way::length);
    }
    [[nodiscard]] const glm::dvec3& operator[](std::size_t i) const { return ways_[i].direction; }

  private:
    struct Way {
        double length = 0.0;
        glm::dvec3 direction;
    };
    std::array<Way, kParityDirections.size()> ways_;
};

}  // namespace

glm::dvec3 closestOnTriangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                             const glm::dvec3& c) {
    const glm::dvec3 ab = b - a;
    const glm::dvec3 ac = c - a;
    const glm::dvec3 ap = p - a;
    const double d1 = dot(ab, ap);
    const double d2 = dot(ac, ap);
    if (d1 <= 0.0 && d2 <= 0.0) {
        return a;
    }
    const glm::dvec3 bp = p - b;
    const double d3 = dot(ab, bp);
    const double d4 = dot(ac, bp);
    if (d3 >= 0.0 && d4 <= d3) {
        return b;
    }
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
        return a + (d1 / (d1 - d3)) * ab;
    }
    const glm::dvec3 cp = p - c;
    const double d5 = dot(ab, cp);
    const double d6 = dot(ac, cp);
    if (d6 >= 0.0 && d5 <= d6) {
        return c;
    }
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
        return a + (d2 / (d2 - d6)) * ac;
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
        return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);
    }
    const double sum = va + vb + vc;
    return a + (vb / sum) * ab + (vc / sum) * ac;
}

void BodyCounter::cross(std::uint32_t body, int side) {
    if (body == 0) {
        winding += side;
    } else if (const auto found = std::ranges::find(odd, body); found != odd.end()) {
        odd.erase(found);
    } else {
        odd.push_back(body);
    }
}

LineSpan cornerSpan(const TriangleMesh& mesh, std::uint32_t triangle, const glm::dvec3& origin,
                    const glm::dvec3& direction) {
    LineSpan span{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const glm::vec3& corner : cornersOf(mesh, triangle)) {
        const double at = dot(glm::dvec3(corner) - origin, direction) / dot(direction, direction);
        span = {std::min(span.begin, at), std::max(span.end, at)};
    }
    return span;
}

Result<MeshQuery> MeshQuery::build(PreparedMesh mesh) {
    const EmbreeMesh* const tree = RELIEF_TRY(mesh.tree());
    return MeshQuery(std::move(mesh), *tree);
}

bool MeshQuery::inside(const glm::vec3& p) const {
    return inBody(p) || inVoid(p);
}

bool MeshQuery::inBody(const glm::vec3& p) const {
    const Bounds& box = mesh().bounds;
    for (int i = 0; i < 3; ++i) {
        // Written so that NaN is outside.
        if (!(p[i] >= box.min[i] && p[i] <= box.max[i])) {
            return false;
        }
    }
    // If all bodies of a union are closed, only rays through an edge disagree, so three rays suffice. A mesh that uses
    // parity may be open, so seven rays vote.
    const std::size_t rays = !bodies_.empty() && shells_ ? 3 : kParityDirections.size();
    std::size_t votes[2] = {0, 0};
    const ParityRays rays_out(box, p);
    for (std::size_t i = 0; votes[0] <= rays / 2 && votes[1] <= rays / 2; ++i) {
        ++votes[rayIsInside(p, rays_out[i]) ? 1 : 0];
    }
    return votes[1] > rays / 2;
}

bool MeshQuery::inVoid(const glm::dvec3& p) const {
    using Place = Voids::Place;
    if (!hasVoids()) {
        return false;
    }
    const Voids& voids = mesh_.voids();
    const glm::ivec3 cell(glm::floor((p - voids.origin) / voids.step));
    int void_nodes = 0;
    int outside_nodes = 0;
    voids.eachNode(cell, cell + 1, [&](const glm::ivec3&, Place place) {
        void_nodes += place == Place::kVoid ? 1 : 0;
        outside_nodes += place == Place::kOutside ? 1 : 0;
    });
    if (void_nodes == 8 || outside_nodes == 8 || (void_nodes == 0 && !voids.meet(cell - 1, cell + 2))) {
        return void_nodes == 8;
    }
    // A visible node is on the same side. If none is visible, as in a crease, the nearest node decides.
    std::optional<Place> seen;
    Place nearest = Place::kSolid;
    double least = std::numeric_limits<double>::infinity();
    for (int reach = 0; reach < 2 && !seen; ++reach) {
        voids.eachNode(cell - reach, cell + 1 + reach, [&](const glm::ivec3& node, Place place) {
            if (place == Place::kSolid || seen) {
                return;
            }
            const glm::dvec3 there = voids.position(node);
            if (isSegmentFree(p, there)) {
                seen = place;
            } else if (const double squared = dot(there - p, there - p); squared < least) {
                least = squared;
                nearest = place;
            }
        });
    }
    return seen.value_or(nearest) == Place::kVoid;
}

bool MeshQuery::awayFromVoids(const glm::dvec3& low, const glm::dvec3& high) const {
    const Voids& voids = mesh_.voids();
    return !hasVoids() || !voids.meet(glm::ivec3(glm::floor((low - voids.origin) / voids.step)) - 1,
                                      glm::ivec3(glm::floor((high - voids.origin) / voids.step)) + 2);
}

bool MeshQuery::rayIsInside(const glm::vec3& p, const glm::dvec3& direction) const {
    if (bodies_.empty() || shells_) {
        unsigned count = 0;
        int winding = 0;
        trace(*tree_, p, direction, [&](const RTCFilterFunctionNArguments* args, unsigned i) {
            ++count;
            winding += sideOf(args, i);
        });
        return shells_ ? winding != 0 : count % 2 == 1;
    }
    return countAlong(p, direction).inside();
}

BodyCounter MeshQuery::countAlong(const glm::vec3& p, const glm::dvec3& direction) const {
    BodyCounter counter;
    trace(*tree_, p, direction, [&](const RTCFilterFunctionNArguments* args, unsigned i) {
        counter.cross(bodyOf(RTCHitN_primID(args->hit, args->N, i)), sideOf(args, i));
    });
    return counter;
}

BodyCounter MeshQuery::bodiesAt(const glm::vec3& p) const {
    BodyCounter counter;
    if (!shells_ && bodies_.empty()) {
        if (inBody(p)) {
            counter.odd.push_back(1);
        }
        return counter;
    }
    const bool is_inside = inBody(p);
    const ParityRays rays_out(mesh().bounds, p);
    // A ray through an edge may count it twice.
    for (std::size_t i = 0; i < kParityDirections.size(); ++i) {
        counter = countAlong(p, rays_out[i]);
        counter.winding = -counter.winding;  // from outside to p
        if (counter.inside() == is_inside) {
            break;
        }
    }
    return counter;
}

unsigned MeshQuery::crossings(const glm::vec3& p, const glm::dvec3& direction) const {
    unsigned count = 0;
    trace(*tree_, p, direction, [&](const RTCFilterFunctionNArguments*, unsigned) { ++count; });
    return count;
}

void MeshQuery::hitsAlong(const glm::dvec3& p, const glm::dvec3& direction,
                          std::vector<LineHit>& hits) const {
    hits.clear();
    const LineSpan box = inBox(mesh().bounds, p, direction);
    if (!(box.begin <= box.end)) {
        return;
    }
    const double margin =  // beyond the box at both ends
        1e-3 * (box.end - box.begin) + 1e-3 * mesh().bounds.longestSide() / length(direction);
    const double begin = box.begin - margin;
    const glm::dvec3 start = p + begin * direction;
    const auto add = [&](const RTCFilterFunctionNArguments* args, unsigned i) {
        const std::uint32_t triangle = RTCHitN_primID(args->hit, args->N, i);
        hits.push_back({begin + depthAt(mesh(), triangle, start, direction), triangle});
    };
    RTCRayHit query =
        rayHit(tree_->toLocal(start), direction * tree_->scale, static_cast<float>(box.end + margin - begin));
    EveryHit(add).intersect(tree_->scene.get(), query);
    std::ranges::sort(hits);
}

bool MeshQuery::spansInside(const glm::dvec3& p, const glm::dvec3& direction,
                            std::vector<LineSpan>& spans) const {
    spans.clear();
    std::vector<LineHit> hits;
    hitsAlong(p, direction, hits);
    BodyCounter counter;
    const bool winds = shells_ || !bodies_.empty();
    bool inside = false;
    bool odd = false;
    for (const LineHit& hit : hits) {
        counter.cross(shells_ || bodies_.empty() ? 0 : bodies_[hit.triangle],
                      dot(planeOf(mesh(), hit.triangle).normal, direction) < 0.0 ? -1 : 1);
        odd = !odd;
        const bool now = winds ? counter.inside() : odd;
        if (now && !inside) {
            spans.push_back({hit.at, hit.at});
        } else if (!now && inside) {
            spans.back().end = hit.at;
        }
        inside = now;
    }
    if (inside) {
        return false;
    }
    if (hasVoids() && !spans.empty()) {
        std::size_t last = 0;
        for (std::size_t i = 1; i < spans.size(); ++i) {
            if (inVoid(p + 0.5 * (spans[last].end + spans[i].begin) * direction)) {
                spans[last].end = spans[i].end;
            } else {
                spans[++last] = spans[i];
            }
        }
        spans.resize(last + 1);
    }
    return true;
}

ClosestPoint MeshQuery::closest(const glm::vec3& p, std::optional<std::uint32_t> hint) const {
    const glm::dvec3 local = tree_->toLocal(p);
    Search search{mesh(), *tree_, local, slackAt(local)};
    if (hint) {
        search.add(*hint);
    }
    visitNear(search, search.radius());
    return {std::sqrt(search.best_squared) / tree_->scale, search.triangle,
            search.point / tree_->scale + tree_->center};
}

bool MeshQuery::hasOtherLabelWithin(const glm::vec3& p, double radius, std::span<const std::uint8_t> labels,
                                    std::uint8_t label) const {
    const glm::dvec3 local = tree_->toLocal(p);
    const double reach = radius * tree_->scale;
    OtherSearch search{mesh(), *tree_, local, reach * reach, labels, label};
    visitNear(search, static_cast<float>(reach) + slackAt(local));
    return search.found;
}

double MeshQuery::signedDistance(const glm::vec3& p) const {
    const double distance = closest(p).distance;
    return inside(p) ? -distance : distance;
}

bool MeshQuery::isSegmentFree(const glm::dvec3& from, const glm::dvec3& to) const {
    return isFree(from, to - from, 1.0F);
}

bool MeshQuery::isRayFree(const glm::dvec3& origin, const glm::dvec3& direction) const {
    return isFree(origin, direction, std::numeric_limits<float>::infinity());
}

bool MeshQuery::isFree(const glm::dvec3& origin, const glm::dvec3& direction, float end) const {
    RTCRay ray = rayHit(tree_->toLocal(origin), direction * tree_->scale, end).ray;
    RayQuery().occluded(tree_->scene.get(), ray);
    return ray.tfar >= 0.0F;
}

std::optional<FirstHit> MeshQuery::firstHit(const glm::dvec3& origin, const glm::dvec3& direction) const {
    RTCRayHit query =
        rayHit(tree_->toLocal(origin), direction * tree_->scale, std::numeric_limits<float>::infinity());
    RayQuery().intersect(tree_->scene.get(), query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        return std::nullopt;
    }
    return FirstHit{depthAt(mesh(), query.hit.primID, origin, direction), query.hit.primID};
}

}  // namespace relief
