// A mesh, and what all stages of a bake want to know of it: how its edges meet, which way it is wound, and the
// tree that rays search.
#pragma once

#include <memory>
#include <vector>

#include "bake/mesh/area_table.h"
#include "bake/mesh/mesh.h"
#include "bake/mesh/mesh_edges.h"
#include "bake/mesh/vertex_blocks.h"
#include "formats/base/result.h"

namespace relief {

struct EmbreeMesh;

/// A handle on a mesh that does not change any more. Copies are cheap and share what has been worked out.
/// Each answer is worked out when it is first asked for, and only once. One thread at a time may ask for the
/// first time: MeshQuery and RayScene ask for all that they need when they are made, and then serve all
/// threads.
class PreparedMesh {
  public:
    /// Implicit, so that a mesh alone can be passed where one question is asked of it. Move large meshes in.
    PreparedMesh(TriangleMesh mesh);

    [[nodiscard]] const TriangleMesh& operator*() const;
    [[nodiscard]] const TriangleMesh* operator->() const { return &**this; }

    [[nodiscard]] const MeshEdges& edges() const;
    /// Edges take more memory than the mesh. What they say of closed() and woundShells() is kept.
    void freeEdges() const;
    [[nodiscard]] const std::vector<OddEdge>& oddEdges() const;
    /// No odd edge: any ray from a point meets the surface as often, modulo 2, as any other.
    [[nodiscard]] bool closed() const { return oddEdges().empty(); }
    /// isSeveralShells() of a closed mesh that windOutwards has seen to: how often the surface winds round a
    /// point, not the parity of a ray's crossings, says whether the point is inside.
    [[nodiscard]] bool woundShells() const;
    /// −1 if the mesh is closed and its triangles are clockwise seen from outside (it is inside out), else 1.
    /// Closed is judged by the triangles' areas, which sum up to zero as vectors, and the side by the sign of
    /// the enclosed volume.
    [[nodiscard]] double orientation() const;
    [[nodiscard]] const AreaTable& areas() const;
    /// Of its positions. Lives as long as a copy of this handle.
    [[nodiscard]] const VertexBlocks& vertexBlocks() const;
    /// Lives as long as a copy of this handle. Errors: those of EmbreeMesh::build.
    [[nodiscard]] Result<const EmbreeMesh*> tree() const;

    /// The mesh as windOutwards leaves it. What no turn can change is kept; without a turn, all is.
    /// \param turn  for each triangle, whether its second and third corner change places.
    [[nodiscard]] PreparedMesh woundOutwards(const std::vector<bool>& turn) &&;
    /// Parts that each enclose something; inside is what lies in any of them.
    /// \param bodies  for each triangle: 0 if how often those of body 0 wind round a point decides, outwards all; else
    ///     a number whose triangles decide by the parity of a ray's crossings.
    [[nodiscard]] static PreparedMesh unionOf(TriangleMesh mesh, std::vector<std::uint32_t> bodies);
    /// As unionOf has them; empty for other meshes.
    [[nodiscard]] const std::vector<std::uint32_t>& bodies() const;

    /// Another mesh, with caps, that is wound as this one is.
    [[nodiscard]] PreparedMesh capped(TriangleMesh mesh) const;

  private:
    struct State;
    std::shared_ptr<State> state_;
};

}  // namespace relief
