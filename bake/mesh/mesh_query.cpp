#include "bake/mesh/mesh_query.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "bake/mesh/embree_mesh.h"
#include "bake/mesh/inside.h"
#include "bake/mesh/triangle_plane.h"

namespace relief {
namespace {

/// Which way the i-th ray crosses the surface it met: 1 out of it, −1 into it.
int wayOf(const RTCFilterFunctionNArguments* args, unsigned i) {
    const double along =
        static_cast<double>(RTCHitN_Ng_x(args->hit, args->N, i)) * RTCRayN_dir_x(args->ray, args->N, i) +
        static_cast<double>(RTCHitN_Ng_y(args->hit, args->N, i)) * RTCRayN_dir_y(args->ray, args->N, i) +
        static_cast<double>(RTCHitN_Ng_z(args->hit, args->N, i)) * RTCRayN_dir_z(args->ray, args->N, i);
    return along < 0.0 ? -1 : 1;
}

/// Counts the surfaces on a ray, and lets it pass through them.
struct CrossingCounter : RayQuery {
    unsigned count = 0;
    int winding = 0;  ///< crossings one way less those the other way

    CrossingCounter() : RayQuery(filter) {}

    static void filter(const RTCFilterFunctionNArguments* args) {
        auto* self = static_cast<CrossingCounter*>(of(args));
        for (unsigned i = 0; i < args->N; ++i) {
            if (args->valid[i] != 0) {
                ++self->count;
                self->winding += wayOf(args, i);
                args->valid[i] = 0;
            }
        }
    }
};

/// How a ray crosses the bodies of a union, one by one.
struct BodyCounter : RayQuery {
    std::span<const std::uint32_t> bodies;
    int winding = 0;
    std::vector<std::uint32_t> odd;  ///< bodies crossed an odd number of times so far, but for body 0

    explicit BodyCounter(std::span<const std::uint32_t> body_of) : RayQuery(filter), bodies(body_of) {}

    [[nodiscard]] bool inside() const { return winding != 0 || !odd.empty(); }

    void cross(std::uint32_t body, int way) {
        if (body == 0) {
            winding += way;
        } else if (const auto found = std::find(odd.begin(), odd.end(), body); found != odd.end()) {
            odd.erase(found);
        } else {
            odd.push_back(body);
        }
    }

    static void filter(const RTCFilterFunctionNArguments* args) {
        auto* self = static_cast<BodyCounter*>(of(args));
        for (unsigned i = 0; i < args->N; ++i) {
            if (args->valid[i] != 0) {
                self->cross(self->bodies[RTCHitN_primID(args->hit, args->N, i)], wayOf(args, i));
                args->valid[i] = 0;
            }
        }
    }
};

/// Collects the triangles that a ray meets, and lets it pass through them.
struct HitCollector : RayQuery {
    std::vector<std::uint32_t> triangles;

    HitCollector() : RayQuery(filter) {}

    static void filter(const RTCFilterFunctionNArguments* args) {
        auto* self = static_cast<HitCollector*>(of(args));
        for (unsigned i = 0; i < args->N; ++i) {
            if (args->valid[i] != 0) {
                self->triangles.push_back(RTCHitN_primID(args->hit, args->N, i));
                args->valid[i] = 0;
            }
        }
    }
};

template <class Ray>
void setRay(Ray& ray, const glm::vec3& origin, const glm::vec3& direction, float end) {
    ray.org_x = origin.x;
    ray.org_y = origin.y;
    ray.org_z = origin.z;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    ray.tnear = 0.0F;
    ray.tfar = end;
    ray.time = 0.0F;
    ray.mask = 0xffffffff;
    ray.flags = 0;
}

RTCRayHit rayHit(const glm::vec3& origin, const glm::vec3& direction, float end) {
    RTCRayHit query{};
    setRay(query.ray, origin, direction, end);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return query;
}

/// The point of a triangle closest to p. Ericson, "Real-Time Collision Detection" (2005), section 5.1.5.
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

/// How far along a ray the plane of a triangle lies that it meets; held between the triangle's corners, for
/// planes that are seen edge-on. Embree's own distance has a quotient in it that differs from processor to
/// processor.
double depthAt(const TriangleMesh& mesh, std::uint32_t triangle, const glm::dvec3& origin,
               const glm::dvec3& direction) {
    const TrianglePlane plane = planeOf(mesh, triangle);
    const double depth = dot(plane.normal, plane.point - origin) / dot(plane.normal, direction);
    const glm::uvec3& t = mesh.triangles[triangle];
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const std::uint32_t corner : {t.x, t.y, t.z}) {
        const double at =
            dot(glm::dvec3(mesh.positions[corner]) - origin, direction) / dot(direction, direction);
        low = std::min(low, at);
        high = std::max(high, at);
    }
    // Written so that NaN is the nearest corner's.
    return std::max(0.0, depth >= low ? std::min(depth, high) : low);
}

/// Shows the counter all that a ray meets.
template <class Counter>
void trace(const EmbreeMesh& tree, const glm::vec3& p, const glm::dvec3& direction, Counter& counter) {
    RTCRayHit query = rayHit(tree.toLocal(p), direction, std::numeric_limits<float>::infinity());
    counter.intersect(tree.scene.get(), query);
}

/// The part of a line that lies in a box, in units of its direction; begin > end: none.
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

/// One search for the closest point; in Embree's units.
struct Search {
    const TriangleMesh& mesh;
    const EmbreeMesh& tree;
    glm::dvec3 p;
    float slack;  // added to the search radius: Embree's boxes and the query are floats
    double best_squared = std::numeric_limits<double>::infinity();
    std::uint32_t triangle = RTC_INVALID_GEOMETRY_ID;
    glm::dvec3 point{0.0};

    [[nodiscard]] float radius() const { return static_cast<float>(std::sqrt(best_squared)) + slack; }

    /// \return true if the triangle is closer than the best so far.
    bool add(std::uint32_t index) {
        const glm::uvec3& t = mesh.triangles[index];
        const glm::dvec3 closest =
            closestOnTriangle(p, tree.toLocal(mesh.positions[t.x]), tree.toLocal(mesh.positions[t.y]),
                              tree.toLocal(mesh.positions[t.z]));
        const glm::dvec3 offset = closest - p;
        const double squared = dot(offset, offset);
        // Of equals the lowest index: the order of the visits must not matter.
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
        if (!self->add(args->primID)) {
            return false;
        }
        args->query->radius = self->radius();
        return true;
    }
};

/// The parity directions, each the way that leaves the box sooner, the shortest way first: where leaves and grass lie in
/// many layers, a ray meets fewer of them.
class WaysOut {
  public:
    WaysOut(const Bounds& box, const glm::vec3& p) {
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
        // Of equals the first.
        std::stable_sort(ways_.begin(), ways_.end(),
                         [](const Way& a, const Way& b) { return a.length < b.length; });
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

Result<MeshQuery> MeshQuery::build(PreparedMesh mesh) {
    const EmbreeMesh* const tree = RELIEF_TRY(mesh.tree());
    return MeshQuery(std::move(mesh), *tree);
}

bool MeshQuery::inside(const glm::vec3& p) const {
    const glm::vec3& low = mesh().bounds.min;
    const glm::vec3& high = mesh().bounds.max;
    for (int i = 0; i < 3; ++i) {
        // Written so that NaN is outside.
        if (!(p[i] >= low[i] && p[i] <= high[i])) {
            return false;
        }
    }
    // Closed surfaces of a union give every ray the same answer, but for one that passes through an edge. Parity may be
    // asked of open ones, and of meshes whose winding nobody has seen to.
    const std::size_t rays = !bodies_.empty() && shells_ ? 3 : kParityDirections.size();
    std::size_t votes[2] = {0, 0};
    const WaysOut ways(mesh().bounds, p);
    for (std::size_t i = 0; votes[0] <= rays / 2 && votes[1] <= rays / 2; ++i) {
        ++votes[rayIsInside(p, ways[i]) ? 1 : 0];
    }
    return votes[1] > rays / 2;
}

bool MeshQuery::rayIsInside(const glm::vec3& p, const glm::dvec3& direction) const {
    if (bodies_.empty() || shells_) {
        CrossingCounter counter;
        trace(*tree_, p, direction, counter);
        return shells_ ? counter.winding != 0 : counter.count % 2 == 1;
    }
    BodyCounter counter(bodies_);
    trace(*tree_, p, direction, counter);
    return counter.inside();
}

unsigned MeshQuery::crossings(const glm::vec3& p, const glm::dvec3& direction) const {
    CrossingCounter counter;
    trace(*tree_, p, direction, counter);
    return counter.count;
}

void MeshQuery::hitsAlong(const glm::dvec3& p, const glm::dvec3& direction,
                          std::vector<LineHit>& hits) const {
    hits.clear();
    const LineSpan box = inBox(mesh().bounds, p, direction);
    if (!(box.begin <= box.end)) {
        return;
    }
    // From outside of the box to outside of the box.
    const double margin =
        1e-3 * (box.end - box.begin) + 1e-3 * mesh().bounds.longestSide() / length(direction);
    const double begin = box.begin - margin;
    const glm::dvec3 start = p + begin * direction;
    HitCollector collector;
    RTCRayHit query =
        rayHit(tree_->toLocal(start), direction * tree_->scale, static_cast<float>(box.end + margin - begin));
    collector.intersect(tree_->scene.get(), query);
    for (const std::uint32_t triangle : collector.triangles) {
        hits.push_back({begin + depthAt(mesh(), triangle, start, direction), triangle});
    }
    std::sort(hits.begin(), hits.end(), [](const LineHit& a, const LineHit& b) {
        return a.at < b.at || (a.at == b.at && a.triangle < b.triangle);
    });
}

bool MeshQuery::spansInside(const glm::dvec3& p, const glm::dvec3& direction,
                            std::vector<LineSpan>& spans) const {
    spans.clear();
    std::vector<LineHit> hits;
    hitsAlong(p, direction, hits);
    BodyCounter counter(bodies_);
    bool inside = false;
    bool odd = false;
    for (const LineHit& hit : hits) {
        const int way = dot(planeOf(mesh(), hit.triangle).normal, direction) < 0.0 ? -1 : 1;
        counter.cross(shells_ || bodies_.empty() ? 0 : bodies_[hit.triangle], way);
        odd = !odd;
        const bool now = shells_ || !bodies_.empty() ? counter.inside() : odd;
        if (now && !inside) {
            spans.push_back({hit.at, hit.at});
        } else if (!now && inside) {
            spans.back().end = hit.at;
        }
        inside = now;
    }
    return !inside;
}

ClosestPoint MeshQuery::closest(const glm::vec3& p, std::optional<std::uint32_t> hint) const {
    const glm::dvec3 local = tree_->toLocal(p);
    const double size = std::max({std::abs(local.x), std::abs(local.y), std::abs(local.z)});
    Search search{mesh(), *tree_, local, static_cast<float>(2e-6 * (1.0 + size))};
    if (hint) {
        search.add(*hint);
    }
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    RTCPointQuery query{};
    const glm::vec3 at = local;
    query.x = at.x;
    query.y = at.y;
    query.z = at.z;
    query.radius = search.radius();
    rtcPointQuery(tree_->scene.get(), &query, &context, Search::visit, &search);
    return {std::sqrt(search.best_squared) / tree_->scale, search.triangle,
            search.point / tree_->scale + tree_->center};
}

double MeshQuery::signedDistance(const glm::vec3& p) const {
    const double distance = closest(p).distance;
    return inside(p) ? -distance : distance;
}

bool MeshQuery::segmentIsFree(const glm::dvec3& from, const glm::dvec3& to) const {
    return isFree(from, to - from, 1.0F);
}

bool MeshQuery::rayIsFree(const glm::dvec3& origin, const glm::dvec3& direction) const {
    return isFree(origin, direction, std::numeric_limits<float>::infinity());
}

bool MeshQuery::isFree(const glm::dvec3& origin, const glm::dvec3& direction, float end) const {
    RTCRay ray{};
    setRay(ray, tree_->toLocal(origin), direction * tree_->scale, end);
    RayQuery().occluded(tree_->scene.get(), ray);
    return ray.tfar >= 0.0F;
}

std::vector<LineGap> MeshQuery::gapsAlong(const glm::dvec3& origin, const glm::dvec3& direction) const {
    std::vector<LineHit> hits;
    hitsAlong(origin, direction, hits);
    struct Crossing {
        double along;
        std::uint32_t body;
        int way;
        std::uint32_t triangle;
    };
    std::vector<Crossing> crossings;
    for (const LineHit& hit : hits) {
        const int way = dot(planeOf(mesh(), hit.triangle).normal, direction) < 0.0 ? -1 : 1;
        const std::uint32_t body = shells_ || bodies_.empty() ? 0 : bodies_[hit.triangle];
        crossings.push_back({hit.at, body, way, hit.triangle});
    }
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
        return std::tie(a.along, a.body, a.way, a.triangle) < std::tie(b.along, b.body, b.way, b.triangle);
    });
    const double tie = 1e-7 * mesh().bounds.longestSide() / length(direction);
    std::vector<LineGap> gaps;
    BodyCounter counter(bodies_);
    const bool winds = shells_ || !bodies_.empty();
    bool odd = false;
    for (std::size_t i = 0; i < crossings.size(); ++i) {
        const Crossing& here = crossings[i];
        // Two triangles of one body that are crossed the same way at the same place share an edge.
        bool again = false;
        for (std::size_t j = i; j > 0 && here.along - crossings[j - 1].along <= tie && !again; --j) {
            again = crossings[j - 1].body == here.body && crossings[j - 1].way == here.way;
        }
        if (!again && winds) {
            counter.cross(here.body, here.way);
        }
        odd = odd != !again;
        const bool free = winds ? !counter.inside() : !odd;
        if (free && i + 1 < crossings.size() && crossings[i + 1].along - here.along > tie) {
            gaps.push_back({here.along, crossings[i + 1].along, here.triangle, crossings[i + 1].triangle});
        }
    }
    return gaps;
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
