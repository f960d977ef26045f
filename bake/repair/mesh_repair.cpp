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
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
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
namespace pmp = CGAL::Polygon_mesh_processing;

/// Larger holes do without the search for the best triangulation, which takes cubic time.
constexpr std::size_t kCubicEdgesMax = 200;

glm::uvec3 cornersOf(const Corners& t) {
    return {static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]),
            static_cast<std::uint32_t>(t[2])};
}

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

    /// Keeps the first triangle of each set of corners.
    void dropDuplicates() {
        std::vector<SortedTriangle> sorted;
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            sorted.emplace_back(cornersOf(triangles[i]), static_cast<std::uint32_t>(i));
        }
        std::ranges::sort(sorted);
        const auto [end, last] = std::ranges::unique(sorted, {}, &SortedTriangle::corners);
        sorted.erase(end, last);
        std::ranges::sort(sorted, {}, &SortedTriangle::index);
        for (std::size_t i = 0; i < sorted.size(); ++i) {
            triangles[i] = triangles[sorted[i].index];
        }
        triangles.resize(sorted.size());
    }

    [[nodiscard]] glm::vec3 toObject(const Point& p) const {
        return center + side * glm::dvec3(p.x(), p.y(), p.z());
    }
};

/// Another surface of the same file.
Result<TriangleMesh> meshOf(const TriangleMesh& source, std::vector<glm::vec3> positions,
                            std::vector<glm::uvec3> triangles) {
    TriangleMesh mesh;
    mesh.name = source.name;
    mesh.content_hash = source.content_hash;
    mesh.unit = source.unit;
    mesh.dropped_triangles = source.dropped_triangles;
    mesh.dependencies = source.dependencies;
    mesh.dependency_hashes = source.dependency_hashes;
    mesh.warnings = source.warnings;
    mesh.positions = std::move(positions);
    mesh.triangles = std::move(triangles);
    return finishMesh(std::move(mesh));
}

Result<TriangleMesh> meshOf(const TriangleMesh& source, const Soup& soup) {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    for (const Point& p : soup.points) {
        positions.push_back(soup.toObject(p));
    }
    for (const Corners& t : soup.triangles) {
        triangles.push_back(cornersOf(t));
    }
    return meshOf(source, std::move(positions), std::move(triangles));
}

Result<TriangleMesh> meshOf(const TriangleMesh& source, const Soup& soup, const SurfaceMesh& surface) {
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> index(surface.number_of_vertices() + surface.number_of_removed_vertices(), 0);
    for (const SurfaceMesh::Vertex_index v : surface.vertices()) {
        index[v] = static_cast<std::uint32_t>(positions.size());
        positions.push_back(soup.toObject(surface.point(v)));
    }
    std::vector<glm::uvec3> triangles;
    for (const SurfaceMesh::Face_index f : surface.faces()) {
        glm::uvec3 t(0);
        int corner = 0;
        for (const SurfaceMesh::Vertex_index v : surface.vertices_around_face(surface.halfedge(f))) {
            t[corner++] = index[v];
        }
        triangles.push_back(t);
    }
    return meshOf(source, std::move(positions), std::move(triangles));
}

tl::unexpected<Error> cgalError(const TriangleMesh& mesh, const std::string& what, const char* words) {
    std::string line = words;
    std::replace(line.begin(), line.end(), '\n', ' ');
    return fail(ErrorCode::kFailure,
                mesh.name + ": " + what + " failed: " + line + "; repair the mesh by hand");
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
        return cgalError(mesh, what, e.what());
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

std::size_t edgesAround(const SurfaceMesh& surface, SurfaceMesh::Halfedge_index border) {
    std::size_t count = 0;
    SurfaceMesh::Halfedge_index at = border;
    do {
        ++count;
        at = surface.next(at);
    } while (at != border);
    return count;
}

/// The soup wound consistently, as a surface.
Result<SurfaceMesh> surfaceOf(const TriangleMesh& mesh, Soup& soup) {
    soup.dropDuplicates();
    pmp::orient_polygon_soup(soup.points, soup.triangles);
    if (!pmp::is_polygon_soup_a_polygon_mesh(soup.triangles)) {
        return fail(ErrorCode::kFailure, mesh.name +
                                             ": its triangles cannot be wound consistently; repair the "
                                             "mesh by hand, or try --repair wrap");
    }
    SurfaceMesh surface;
    pmp::polygon_soup_to_polygon_mesh(soup.points, soup.triangles, surface);
    return surface;
}

bool hasNonManifoldEdge(const Soup& soup) {
    std::vector<std::pair<std::size_t, std::size_t>> edges;
    for (const Corners& t : soup.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            edges.emplace_back(std::minmax({t[i], t[(i + 1) % 3]}));
        }
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 2; i < edges.size(); ++i) {
        if (edges[i] == edges[i - 2]) {
            return true;
        }
    }
    return false;
}

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

Result<TriangleMesh> orientMesh(const TriangleMesh& mesh) {
    return guarded<TriangleMesh>(mesh, "orienting it", [&]() -> Result<TriangleMesh> {
        Soup soup(mesh);
        soup.dropDuplicates();
        pmp::orient_polygon_soup(soup.points, soup.triangles);
        return meshOf(mesh, soup);
    });
}

Result<HoleFill> fillHoles(const TriangleMesh& mesh) {
    return guarded<HoleFill>(mesh, "filling its holes", [&]() -> Result<HoleFill> {
        Soup soup(mesh);
        soup.dropDuplicates();
        if (hasNonManifoldEdge(soup)) {
            return fail(ErrorCode::kInvalidInput,
                        mesh.name +
                            ": three or more triangles share an edge, so that no one can say what a hole "
                            "is; try --repair wrap");
        }
        SurfaceMesh surface = RELIEF_TRY(surfaceOf(mesh, soup));
        std::vector<SurfaceMesh::Halfedge_index> borders;
        pmp::extract_boundary_cycles(surface, std::back_inserter(borders));
        HoleFill fill;
        for (const SurfaceMesh::Halfedge_index border : borders) {
            const std::size_t edges = edgesAround(surface, border);
            std::vector<SurfaceMesh::Face_index> patch;
            if (edges <= kHoleEdgesMax) {
                pmp::triangulate_hole(surface, border, std::back_inserter(patch),
                                      CGAL::parameters::do_not_use_cubic_algorithm(edges > kCubicEdgesMax));
            }
            ++(patch.empty() ? fill.left : fill.filled);
            fill.triangles += patch.size();
        }
        fill.mesh = RELIEF_TRY(meshOf(mesh, soup, surface));
        return fill;
    });
}

}  // namespace relief
