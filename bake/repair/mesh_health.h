// SPDX-License-Identifier: Apache-2.0
// Counts of the faults that keep a mesh from bounding a solid. Equal positions are one vertex throughout, as importers
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

/// The first fault of a kind: of the lowest vertex or triangle.
struct MeshFault {
    std::string what;    ///< "a boundary edge": with its article
    glm::vec3 at{0.0F};  ///< object space: the middle of the edge or triangle, or the vertex
};

void fields(FieldVisitor& visit, const MeshFault& fault);

struct MeshHealth {
    std::uint64_t triangles = 0;
    std::uint64_t degenerate_triangles = 0;  ///< without area; dropped by the importer
    std::uint64_t duplicate_triangles = 0;   ///< of the three vertices of an earlier triangle, in any order
    std::uint64_t boundary_edges = 0;        ///< of one triangle
    std::uint64_t nonmanifold_edges = 0;     ///< of three triangles or more
    std::uint64_t inconsistent_edges = 0;    ///< of two triangles that run along it in the same direction
    std::uint64_t nonmanifold_vertices = 0;  ///< whose triangles fall into groups that share no edge there
    std::uint64_t components = 0;            ///< of triangles connected by edges
    std::uint64_t closed_components = 0;
    bool closed = false;                   ///< no edge has an odd number of triangles: the mesh has an inside
    bool inside_out = false;               ///< PreparedMesh::orientation is −1
    std::optional<MeshFault> first_fault;  ///< of the gravest kind; none for a closed solid

    /// Closed, manifold, wound outwards, without duplicates. Degenerate triangles do not count.
    [[nodiscard]] bool isSolid() const { return !first_fault.has_value(); }
};

void fields(FieldVisitor& visit, const MeshHealth& health);

/// The result does not depend on the number of threads.
[[nodiscard]] MeshHealth inspectMesh(const PreparedMesh& mesh);

/// "12 boundary edges, 3 non-manifold vertices, inside out"
[[nodiscard]] std::string faultsText(const MeshHealth& health);

/// Errors: kInvalidInput, with the counts and the first place, if the mesh is not a solid.
[[nodiscard]] Result<void> requireSolid(const MeshHealth& health, const std::string& mesh_name);

}  // namespace relief
