// What is wrong with a mesh, in numbers: how far it is from the boundary of a solid. Equal positions are one
// vertex throughout, as importers repeat positions along seams.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "bake/mesh/prepared_mesh.h"
#include "formats/base/result.h"

namespace relief {

/// The first place of one kind of damage: of the lowest vertex, or the lowest triangle.
struct MeshFault {
    std::string what;    ///< "a boundary edge": with its article
    glm::vec3 at{0.0F};  ///< object space: the middle of the edge or triangle, or the vertex
};

struct MeshHealth {
    std::uint64_t triangles = 0;
    std::uint64_t degenerate_triangles = 0;  ///< without area; left out by the importer
    /// They have the same three vertices as an earlier triangle, in any order.
    std::uint64_t duplicate_triangles = 0;
    std::uint64_t boundary_edges = 0;      ///< of one triangle
    std::uint64_t nonmanifold_edges = 0;   ///< of three triangles or more
    std::uint64_t inconsistent_edges = 0;  ///< of two triangles that run along it in the same direction
    /// Whose triangles fall into several groups that share no edge there.
    std::uint64_t nonmanifold_vertices = 0;
    std::uint64_t components = 0;  ///< of triangles that hang together by edges
    /// Components that are closed() by themselves.
    std::uint64_t closed_components = 0;
    /// No edge belongs to an odd number of triangles: the mesh has an inside.
    bool closed = false;
    /// orientation() is −1: closed, and its triangles are clockwise seen from outside.
    bool inside_out = false;
    /// Pairs of triangles that meet elsewhere than in their common vertices and edges; only if asked for.
    std::optional<std::uint64_t> self_intersections;
    /// The first fault of the kind that the mesh has least right to; none if it is a closed solid.
    std::optional<MeshFault> first_fault;

    /// Closed, manifold, wound outwards throughout, without duplicates, and as far as it is known without
    /// intersections. Triangles without area do not count: they are left out.
    [[nodiscard]] bool isSolid() const { return !first_fault.has_value(); }
};

struct MeshHealthOptions {
    bool intersections = false;  ///< look for them too: some seconds for a million triangles
};

/// The same for any number of threads.
/// Errors: those of selfIntersections (mesh_repair.h); none without options.intersections.
[[nodiscard]] Result<MeshHealth> inspectMesh(const PreparedMesh& mesh, const MeshHealthOptions& options = {});

/// "closed" or "12 boundary edges, 3 non-manifold vertices, inside out": what keeps it from being a solid.
[[nodiscard]] std::string faultsText(const MeshHealth& health);

/// Errors: kInvalidInput, with the counts and the first place, if the mesh is not a solid.
[[nodiscard]] Result<void> requireSolid(const MeshHealth& health, const std::string& mesh_name);

}  // namespace relief
