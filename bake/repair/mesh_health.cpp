// SPDX-License-Identifier: Apache-2.0
#include "bake/repair/mesh_health.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "formats/base/text.h"

namespace relief {
namespace {

/// A kind of fault that is counted.
struct FaultKind {
    std::uint64_t MeshHealth::*count;
    const char* one;
    const char* many;
    const char* description;
};
enum Kind : std::size_t { kBoundary, kNonmanifold, kInconsistent, kDuplicate, kVertex };
/// The most severe kind first.
constexpr std::array<FaultKind, 5> kKinds = {{
    {&MeshHealth::boundary_edges, "boundary edge", "boundary edges", "a boundary edge"},
    {&MeshHealth::nonmanifold_edges, "non-manifold edge", "non-manifold edges",
     "an edge of three or more triangles"},
    {&MeshHealth::inconsistent_edges, "edge wound inconsistently", "edges wound inconsistently",
     "an edge that two triangles traverse in the same direction"},
    {&MeshHealth::duplicate_triangles, "duplicate triangle", "duplicate triangles", "a duplicate triangle"},
    {&MeshHealth::nonmanifold_vertices, "non-manifold vertex", "non-manifold vertices",
     "a vertex where surfaces only touch"},
}};

class Inspection {
  public:
    explicit Inspection(const PreparedMesh& mesh)
        : mesh_(*mesh),
          welded_(mesh.edges().welded),
          component_of_(mesh->triangles.size()),
          // Corners of triangles. Corners at a vertex are joined if their triangles share an edge there.
          corners_(3 * mesh->triangles.size()),
          uses_(mesh.edges().uses) {
        health_.inside_out = mesh.orientation() < 0.0;
    }

    MeshHealth run() {
        forEachEdge(uses_, [&](std::size_t begin, std::size_t end) { visitEdge(begin, end); });
        countComponents();
        countVertices();
        countDuplicates();
        health_.triangles = mesh_.sourceTriangles();
        health_.degenerate_triangles = mesh_.dropped_triangles;
        health_.closed = health_.closed_components == health_.components;
        for (std::size_t kind = 0; kind < kKinds.size() && !health_.first_fault; ++kind) {
            if (health_.*kKinds[kind].count > 0) {
                health_.first_fault = MeshFault{kKinds[kind].description, first_[kind]};
            }
        }
        if (!health_.first_fault && health_.inside_out) {
            health_.first_fault = MeshFault{"a triangle that is clockwise seen from outside", middle(0)};
        }
        return health_;
    }

  private:
    void add(Kind kind, const glm::dvec3& at) {
        if ((health_.*kKinds[kind].count)++ == 0) {
            first_[kind] = at;
        }
    }

    [[nodiscard]] glm::dvec3 middle(std::uint32_t triangle) const {
        const auto corners = cornersOf(mesh_, triangle);
        return (glm::dvec3(corners[0]) + glm::dvec3(corners[1]) + glm::dvec3(corners[2])) / 3.0;
    }

    void visitEdge(std::size_t begin, std::size_t end) {
        const EdgeUse& first = uses_[begin];
        const std::size_t count = end - begin;
        const glm::dvec3 at =
            0.5 * (glm::dvec3(mesh_.positions[first.low]) + glm::dvec3(mesh_.positions[first.high]));
        if (count == 1) {
            add(kBoundary, at);
        } else if (count > 2) {
            add(kNonmanifold, at);
        } else if (first.down == uses_[begin + 1].down) {
            add(kInconsistent, at);
        }
        for (std::size_t i = begin + 1; i < end; ++i) {
            component_of_.join(first.triangle, uses_[i].triangle);
            corners_.join(cornerAt(first, first.low), cornerAt(uses_[i], first.low));
            corners_.join(cornerAt(first, first.high), cornerAt(uses_[i], first.high));
        }
        if (count % 2 == 1) {
            odd_.push_back(first.triangle);
        }
    }

    /// Returns the corner of an edge's triangle at one of the edge's vertices.
    static std::uint32_t cornerAt(const EdgeUse& use, std::uint32_t vertex) {
        const bool starts_here = vertex == (use.down ? use.high : use.low);
        return 3 * use.triangle + (use.side + (starts_here ? 0U : 1U)) % 3;
    }

    void countComponents() {
        std::vector<bool> open(mesh_.triangles.size(), false);
        for (const std::uint32_t triangle : odd_) {
            open[component_of_.find(triangle)] = true;
        }
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
            if (component_of_.find(i) == i) {
                ++health_.components;
                health_.closed_components += open[i] ? 0U : 1U;
            }
        }
    }

    void countVertices() {
        std::vector<std::uint8_t> fans(mesh_.positions.size(), 0);
        for (std::uint32_t i = 0; i < 3 * mesh_.triangles.size(); ++i) {
            if (corners_.find(i) == i) {
                std::uint8_t& fan = fans[welded_[mesh_.triangles[i / 3][static_cast<int>(i % 3)]]];
                fan = static_cast<std::uint8_t>(std::min(fan + 1, 2));
            }
        }
        for (std::size_t i = 0; i < fans.size(); ++i) {
            if (fans[i] > 1) {
                add(kVertex, mesh_.positions[i]);
            }
        }
    }

    void countDuplicates() {
        std::vector<std::uint32_t> all(mesh_.triangles.size());
        std::iota(all.begin(), all.end(), 0U);
        const std::vector<SortedTriangle> sorted = sortedTriangles(mesh_, welded_, all);
        for (std::size_t i = 1; i < sorted.size(); ++i) {
            if (sorted[i].corners == sorted[i - 1].corners) {
                add(kDuplicate, middle(sorted[i].index));
            }
        }
    }

    const TriangleMesh& mesh_;
    const std::vector<std::uint32_t>& welded_;
    DisjointSets component_of_;
    DisjointSets corners_;
    const std::vector<EdgeUse>& uses_;
    std::vector<std::uint32_t> odd_;  // triangles with an odd edge
    MeshHealth health_;
    std::array<glm::vec3, kKinds.size()> first_{};  // places, by kind
};

}  // namespace

MeshHealth inspectMesh(const PreparedMesh& mesh) {
    return Inspection(mesh).run();
}

std::string faultsText(const MeshHealth& health) {
    std::string text;
    for (const FaultKind& kind : kKinds) {
        if (const std::uint64_t count = health.*kind.count; count > 0) {
            text += (text.empty() ? "" : ", ") + std::to_string(count) + " " +
                    (count == 1 ? kind.one : kind.many);
        }
    }
    if (health.inside_out) {
        text += text.empty() ? "inside out" : ", inside out";
    }
    return text;
}

Result<void> requireSolid(const MeshHealth& health, const std::string& mesh_name) {
    if (health.isSolid()) {
        return {};
    }
    return invalidInput(mesh_name + ": not a closed solid: " + faultsText(health) + "; the first is " +
                        health.first_fault->description + " at " + shortest(health.first_fault->position) +
                        "; repair the mesh, try --repair, or leave out --strict");
}

void fields(FieldVisitor& visit, const MeshFault& fault) {
    visit("description", fault.description, {"Description"});
    visit("position", fault.position, {"Middle of the edge or triangle, or the vertex", "object units"});
}

void fields(FieldVisitor& visit, const MeshHealth& health) {
    visit("solid", health.isSolid(),
          {"The mesh is closed, manifold, wound outwards, and free of duplicates"});
    visit("closed", health.closed, {"No edge belongs to an odd number of triangles"});
    visit("inside_out", health.inside_out, {"The mesh as a whole is wound inwards"});
    visit("triangles", health.triangles, {"Triangles with area"});
    visit("degenerate_triangles", health.degenerate_triangles, {"Triangles without area, which are dropped"});
    visit("duplicate_triangles", health.duplicate_triangles,
          {"Triangles with the same three corners as an earlier one"});
    visit("boundary_edges", health.boundary_edges, {"Edges of one triangle"});
    visit("nonmanifold_edges", health.nonmanifold_edges, {"Edges of three or more triangles"});
    visit("nonmanifold_vertices", health.nonmanifold_vertices,
          {"Vertices whose triangles form several groups that share no edge there"});
    visit("inconsistent_edges", health.inconsistent_edges,
          {"Edges that two triangles traverse in the same direction"});
    visit("components", health.components, {"Groups of triangles connected by edges"});
    visit("closed_components", health.closed_components, {"Components that are closed"});
    visit("first_fault", health.first_fault,
          {"First fault of the most severe kind; null if the mesh is a solid"});
}

}  // namespace relief
