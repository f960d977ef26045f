// SPDX-License-Identifier: Apache-2.0
// Counts the faults that prevent a mesh from bounding a solid. Equal positions count as one vertex, because importers
// repeat positions along seams.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "bake/mesh/prepared_mesh.h"
#include "formats/base/result.h"
#include "formats/fields/field.h"

namespace relief {

/// The first fault of a kind, by lowest vertex or triangle index.
struct MeshFault {
    std::string description;   ///< with its article: "a boundary edge"
    glm::vec3 position{0.0F};  ///< object space: the vertex, or the middle of the edge or triangle
};

void fields(FieldVisitor& visit, const MeshFault& fault);

struct MeshHealth {
    std::uint64_t triangles = 0;
    std::uint64_t degenerate_triangles = 0;  ///< without area; dropped by the importer
    /// With the same three vertices as an earlier triangle, in any order.
    std::uint64_t duplicate_triangles = 0;
    std::uint64_t boundary_edges = 0;        ///< with one triangle
    std::uint64_t nonmanifold_edges = 0;     ///< with three or more triangles
    std::uint64_t inconsistent_edges = 0;    ///< traversed by two triangles in the same direction
    std::uint64_t nonmanifold_vertices = 0;  ///< whose triangles form groups that share no edge there
    std::uint64_t components = 0;            ///< sets of triangles connected by edges
    std::uint64_t closed_components = 0;
    /// No edge has an odd number of triangles, so the mesh has an inside.
    bool closed = false;
    bool inside_out = false;               ///< PreparedMesh::orientation() is −1
    std::optional<MeshFault> first_fault;  ///< of the most severe kind; nullopt for a solid

    /// Whether the mesh is closed, manifold, wound outwards, and free of duplicates. Degenerate triangles are ignored.
    [[nodiscard]] bool isSolid() const { return !first_fault.has_value(); }
};

void fields(FieldVisitor& visit, const MeshHealth& health);

/// Inspects a mesh. The result does not depend on the number of threads.
[[nodiscard]] MeshHealth inspectMesh(const PreparedMesh& mesh);

/// Lists the faults: "12 boundary edges, 3 non-manifold vertices, inside out".
[[nodiscard]] std::string faultsText(const MeshHealth& health);

/// Fails if the mesh is not a solid. Errors: kInvalidInput, with the counts and the first fault.
[[nodiscard]] Result<void> requireSolid(const MeshHealth& health, const std::string& mesh_name);

}  // namespace relief
