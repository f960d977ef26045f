// SPDX-License-Identifier: Apache-2.0
// A mesh with its derived data that all stages of a bake share: edges, winding, and the tree for rays.
#pragma once

#include <memory>
#include <vector>

#include "bake/mesh/area_table.h"
#include "bake/mesh/mesh.h"
#include "bake/mesh/mesh_edges.h"
#include "bake/mesh/voids.h"
#include "formats/base/result.h"

namespace relief {

struct EmbreeMesh;

/// A handle on an immutable mesh. Copies are cheap and share the derived data, each of which is computed once, on first
/// use. First uses are not thread-safe: MeshQuery and RayScene trigger all that they need when they are built, and then
/// serve all threads.
class PreparedMesh {
  public:
    /// Implicit, so that a plain mesh can be passed for a single query. Move large meshes in.
    PreparedMesh(TriangleMesh mesh);

    [[nodiscard]] const TriangleMesh& operator*() const;
    [[nodiscard]] const TriangleMesh* operator->() const { return &**this; }

    [[nodiscard]] const MeshEdges& edges() const;
    /// Edges take more memory than the mesh. closed() and woundShells() are kept.
    void freeEdges() const;
    [[nodiscard]] const std::vector<OddEdge>& oddEdges() const;
    /// No odd edge: any ray from a point meets the surface as often, modulo 2, as any other.
    [[nodiscard]] bool closed() const { return oddEdges().empty(); }
    /// isSeveralShells() of a closed mesh after windOutwards: the winding number of a point, not the parity of a ray's
    /// crossings, decides if it is inside.
    [[nodiscard]] bool woundShells() const;
    /// −1 if the mesh is closed and inside out (its triangles are clockwise seen from outside), else 1. Closed means that
    /// the area vectors of the triangles sum to zero; the sign is that of the enclosed volume.
    [[nodiscard]] double orientation() const;
    [[nodiscard]] const AreaTable& areas() const;
    /// Lives as long as a copy of this handle. Errors: those of EmbreeMesh::build.
    [[nodiscard]] Result<const EmbreeMesh*> tree() const;

    /// The mesh as windOutwards leaves it. Derived data that turns cannot change is kept; without a turn, all is.
    /// \param turn  per triangle: swap its second and third corner.
    [[nodiscard]] PreparedMesh woundOutwards(const std::vector<bool>& turn) &&;
    /// As last passed to woundOutwards; empty if it has turned none.
    [[nodiscard]] const std::vector<bool>& turned() const;
    /// Parts that each enclose a volume; the inside is their union.
    /// \param bodies  per triangle: 0 for those, wound outwards, whose winding number decides; else the number of a body
    ///     that decides by the parity of a ray's crossings.
    [[nodiscard]] static PreparedMesh unionOf(TriangleMesh mesh, std::vector<std::uint32_t> bodies);
    /// As passed to unionOf; empty for other meshes.
    [[nodiscard]] const std::vector<std::uint32_t>& bodies() const;

    /// The same mesh, whose voids are inside.
    [[nodiscard]] PreparedMesh withVoids(Voids voids) &&;
    [[nodiscard]] const Voids& voids() const;

    /// Another mesh, with caps, whose winding is as trusted as this one's.
    [[nodiscard]] PreparedMesh capped(TriangleMesh mesh) const;

  private:
    struct State;
    std::shared_ptr<State> state_;
};

}  // namespace relief
