// SPDX-License-Identifier: Apache-2.0
#include "bake/repair/repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <string>
#include <vector>

#include "bake/mesh/mesh_edges.h"

// CGAL's assertions would print. The code below checks their conditions before or after the calls.
#ifndef CGAL_NDEBUG
#define CGAL_NDEBUG 1
#endif
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Random.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

namespace relief {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;

/// Distinct points and triangles for CGAL. Coordinates are relative to the center of the box, in units of its longest
/// side rounded down to a power of two, so that no product of coordinates overflows a double.
struct Soup {
    glm::dvec3 center{0.0};
    double side = 1.0;
    std::vector<Point> points;
    std::vector<std::array<std::size_t, 3>> triangles;

    explicit Soup(const TriangleMesh& mesh)
        : center(0.5 * glm::dvec3(mesh.bounds.min) + 0.5 * glm::dvec3(mesh.bounds.max)),
          // A power of two makes the conversion back exact.
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

/// Converts the surface to a mesh with the source's name and hash.
Result<TriangleMesh> meshOf(const TriangleMesh& source, const Soup& soup, const SurfaceMesh& surface) {
    TriangleMesh mesh = meshOfSource(source);
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

}  // namespace

Result<TriangleMesh> wrapMesh(const TriangleMesh& mesh, double alpha) {
    // Written to reject NaN.
    if (!(alpha >= kWrapAlphaMin && alpha <= kWrapAlphaMax)) {
        return fail(ErrorCode::kUsage, "alpha must be between 0.001 and 0.5 of the longest side");
    }
    try {
        CGAL::get_default_random() = CGAL::Random(1);
        const Soup soup(mesh);
        const double length = alpha * static_cast<double>(mesh.bounds.longestSide()) / soup.side;
        SurfaceMesh wrap;
        CGAL::alpha_wrap_3(soup.points, soup.triangles, length, length / 30.0, wrap);
        if (wrap.number_of_faces() == 0 || !CGAL::is_closed(wrap)) {
            return fail(
                ErrorCode::kFailure,
                mesh.name + ": wrapping it produced no closed surface; try another --repair wrap=ALPHA");
        }
        return meshOf(mesh, soup, wrap);
    } catch (const std::bad_alloc&) {
        return fail(ErrorCode::kLimit, mesh.name + ": out of memory while wrapping; simplify the mesh");
    } catch (const std::exception& e) {
        std::string line = e.what();
        std::replace(line.begin(), line.end(), '\n', ' ');
        return fail(ErrorCode::kFailure,
                    mesh.name + ": wrapping failed: " + line + "; repair the mesh by hand");
    }
}

}  // namespace relief
