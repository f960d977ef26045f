#include "bake/repair/mesh_repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "bake/mesh/mesh_edges.h"

// CGAL's assertions would print; what they check is checked here before or after the calls.
#ifndef CGAL_NDEBUG
#define CGAL_NDEBUG 1
#endif
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Random.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>
#include <CGAL/box_intersection_d.h>

namespace relief {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;
using Corners = std::array<std::size_t, 3>;

/// Distinct points, and triangles, for CGAL: in units of the longest side about the middle of the box, where no product of
/// coordinates leaves the range of a double.
struct Soup {
    glm::dvec3 center{0.0};
    double side = 1.0;
    std::vector<Point> points;
    std::vector<Corners> triangles;

    explicit Soup(const TriangleMesh& mesh)
        : center(0.5 * glm::dvec3(mesh.bounds.min) + 0.5 * glm::dvec3(mesh.bounds.max)),
          // A power of two, so that the conversion back is exact.
          side(std::ldexp(1.0, std::ilogb(mesh.bounds.longestSide()))) {
        const std::vector<std::uint32_t> welded = weldedVertices(mesh);
        std::vector<std::size_t> index(welded.size(), 0);
        for (std::size_t i = 0; i < welded.size(); ++i) {
            if (welded[i] == i) {
                index[i] = points.size();
                const glm::dvec3 p = (glm::dvec3(mesh.positions[i]) - center) / side;
                points.emplace_back(p.x, p.y, p.z);
            }
        }
        for (const glm::uvec3& t : mesh.triangles) {
            triangles.push_back({index[welded[t.x]], index[welded[t.y]], index[welded[t.z]]});
        }
    }

    [[nodiscard]] glm::vec3 toObject(const Point& p) const {
        return center + side * glm::dvec3(p.x(), p.y(), p.z());
    }
};

/// The surface, as another one of the same file.
Result<TriangleMesh> meshOf(const TriangleMesh& source, const Soup& soup, const SurfaceMesh& surface) {
    TriangleMesh mesh;
    mesh.name = source.name;
    mesh.content_hash = source.content_hash;
    mesh.unit = source.unit;
    mesh.dropped_triangles = source.dropped_triangles;
    mesh.dependencies = source.dependencies;
    mesh.dependency_hashes = source.dependency_hashes;
    mesh.warnings = source.warnings;
    std::vector<std::uint32_t> index(surface.number_of_vertices() + surface.number_of_removed_vertices(), 0);
    for (const SurfaceMesh::Vertex_index v : surface.vertices()) {
        index[v] = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back(soup.toObject(surface.point(v)));
    }
    for (const SurfaceMesh::Face_index f : surface.faces()) {
        glm::uvec3& t = mesh.triangles.emplace_back();
        int corner = 0;
        for (const SurfaceMesh::Vertex_index v : surface.vertices_around_face(surface.halfedge(f))) {
            t[corner++] = index[v];
        }
    }
    return finishMesh(std::move(mesh));
}

/// Converts exceptions into errors, and resets CGAL's random numbers.
template <class T>
Result<T> guarded(const TriangleMesh& mesh, const std::string& what, const std::function<Result<T>()>& work) {
    try {
        CGAL::get_default_random() = CGAL::Random(1);
        return work();
    } catch (const std::bad_alloc&) {
        return fail(ErrorCode::kLimit, mesh.name + ": " + what + " ran out of memory; simplify the mesh");
    } catch (const std::exception& e) {
        std::string line = e.what();
        std::replace(line.begin(), line.end(), '\n', ' ');
        return fail(ErrorCode::kFailure,
                    mesh.name + ": " + what + " failed: " + line + "; repair the mesh by hand");
    }
}

struct TooManyCandidates {};

class IntersectionCounter {
  public:
    explicit IntersectionCounter(const Soup& soup) : soup_(soup) {}

    SelfIntersections run() {
        using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;
        std::vector<Box> boxes;
        boxes.reserve(soup_.triangles.size());
        for (std::uint32_t i = 0; i < soup_.triangles.size(); ++i) {
            const Corners& t = soup_.triangles[i];
            boxes.emplace_back(
                soup_.points[t[0]].bbox() + soup_.points[t[1]].bbox() + soup_.points[t[2]].bbox(), i);
        }
        SelfIntersections found;
        std::uint64_t candidates = 0;
        CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
            if (++candidates > kIntersectionCandidateMax) {
                throw TooManyCandidates();
            }
            if (meet(soup_.triangles[a.info()], soup_.triangles[b.info()])) {
                const std::uint32_t lower = std::min(a.info(), b.info());
                found.first_triangle = found.pairs == 0 ? lower : std::min(found.first_triangle, lower);
                ++found.pairs;
            }
        });
        return found;
    }

  private:
    [[nodiscard]] Kernel::Triangle_3 triangle(const Corners& t) const {
        return {soup_.points[t[0]], soup_.points[t[1]], soup_.points[t[2]]};
    }
    [[nodiscard]] Kernel::Segment_3 opposite(const Corners& t, std::size_t corner) const {
        return {soup_.points[t[(corner + 1) % 3]], soup_.points[t[(corner + 2) % 3]]};
    }

    [[nodiscard]] bool meet(const Corners& a, const Corners& b) const {
        std::size_t shared = 0;
        std::size_t at[2] = {0, 0};   // a shared corner
        std::size_t sum[2] = {0, 0};  // of the shared corners
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) {
                if (a[i] == b[j]) {
                    ++shared;
                    at[0] = i;
                    at[1] = j;
                    sum[0] += i;
                    sum[1] += j;
                }
            }
        }
        switch (shared) {
            case 0:
                return CGAL::do_intersect(triangle(a), triangle(b));
            case 1:
                return CGAL::do_intersect(triangle(a), opposite(b, at[1])) ||
                       CGAL::do_intersect(triangle(b), opposite(a, at[0]));
            case 2: {
                // Folded onto each other: coplanar, and on one side of the common edge.
                const std::size_t free[2] = {3 - sum[0], 3 - sum[1]};
                const Point& p = soup_.points[a[(free[0] + 1) % 3]];
                const Point& q = soup_.points[a[(free[0] + 2) % 3]];
                const Point& r = soup_.points[a[free[0]]];
                const Point& s = soup_.points[b[free[1]]];
                return CGAL::orientation(p, q, r, s) == CGAL::COPLANAR &&
                       CGAL::coplanar_orientation(p, q, r, s) == CGAL::POSITIVE;
            }
            default:
                return false;  // duplicates
        }
    }

    const Soup& soup_;
};

}  // namespace

Result<SelfIntersections> selfIntersections(const TriangleMesh& mesh) {
    try {
        return guarded<SelfIntersections>(mesh, "looking for intersections", [&] {
            const Soup soup(mesh);
            return Result<SelfIntersections>(IntersectionCounter(soup).run());
        });
    } catch (const TooManyCandidates&) {
        return fail(ErrorCode::kLimit, mesh.name + ": the boxes of more than " +
                                           std::to_string(kIntersectionCandidateMax) +
                                           " pairs of triangles overlap; simplify the mesh, or leave out "
                                           "--check-intersections");
    }
}

Result<TriangleMesh> wrapMesh(const TriangleMesh& mesh, double alpha) {
    // Written so that NaN fails too.
    if (!(alpha >= kWrapAlphaMin && alpha <= kWrapAlphaMax)) {
        return fail(ErrorCode::kUsage, "alpha must be between 0.001 and 0.5 of the longest side");
    }
    return guarded<TriangleMesh>(mesh, "wrapping it", [&]() -> Result<TriangleMesh> {
        const Soup soup(mesh);
        const double length = alpha * static_cast<double>(mesh.bounds.longestSide()) / soup.side;
        SurfaceMesh wrap;
        CGAL::alpha_wrap_3(soup.points, soup.triangles, length, length / 30.0, wrap);
        if (wrap.number_of_faces() == 0 || !CGAL::is_closed(wrap)) {
            return fail(ErrorCode::kFailure,
                        mesh.name + ": nothing closed came of wrapping it; try another --repair wrap=ALPHA");
        }
        return meshOf(mesh, soup, wrap);
    });
}

}  // namespace relief
