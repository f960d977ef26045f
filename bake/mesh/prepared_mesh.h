// SPDX-License-Identifier: Apache-2.0
// Holds a mesh with the derived data that all stages of a bake share: edges, winding, and the Embree scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "bake/mesh/mesh.h"
#include "bake/mesh/mesh_edges.h"
#include "bake/mesh/surface_sampler.h"
#include "formats/base/result.h"

namespace relief {

struct EmbreeMesh;

/// Classifies the nodes of a grid. A void is free space within a mesh that is unreachable from outside.
struct Voids {
    enum class Place : std::uint8_t { kSolid, kOutside, kVoid };

    glm::dvec3 origin{0.0};  ///< position of node (0, 0, 0), object space
    double step = 0.0;       ///< node spacing, object units
    glm::ivec3 nodes{0};
    std::vector<Place> places;  ///< x fastest; empty: no void. There is no void outside the grid
    std::uint32_t count = 0;    ///< number of voids

    [[nodiscard]] std::size_t at(const glm::ivec3& node) const {
        return (static_cast<std::size_t>(node.z) * static_cast<std::size_t>(nodes.y) +
                static_cast<std::size_t>(node.y)) *
                   static_cast<std::size_t>(nodes.x) +
               static_cast<std::size_t>(node.x);
    }
    [[nodiscard]] glm::dvec3 position(const glm::ivec3& node) const {
        return origin + step * glm::dvec3(node);
    }
    /// Calls visit(node, place) for the nodes in [first, last], clipped to the grid.
    template <class Visit>
    void eachNode(const glm::ivec3& first, const glm::ivec3& last, const Visit& visit) const {
        const glm::ivec3 low = glm::max(first, glm::ivec3(0));
        const glm::ivec3 high = glm::min(last, nodes - 1);
        for (int z = low.z; z <= high.z; ++z) {
            for (int y = low.y; y <= high.y; ++y) {
                for (int x = low.x; x <= high.x; ++x) {
                    visit(glm::ivec3(x, y, z), places[at({x, y, z})]);
                }
            }
        }
    }
    /// Whether a node in [first, last] is in a void.
    [[nodiscard]] bool meet(const glm::ivec3& first, const glm::ivec3& last) const {
        bool found = false;
        eachNode(first, last,
                 [&](const glm::ivec3&, Place place) { found = found || place == Place::kVoid; });
        return found;
    }
};

/// A handle to an immutable mesh. Copies are cheap and share the derived data, which is computed once, on first use.
/// First use is not thread-safe: MeshQuery and RayScene compute the data that they need when they are built, and are
/// thread-safe afterwards.
class PreparedMesh {
  public:
    /// Implicit, so that a plain mesh can be passed for a single query. Move large meshes.
    PreparedMesh(TriangleMesh mesh);

    [[nodiscard]] const TriangleMesh& operator*() const { return state_->mesh; }
    [[nodiscard]] const TriangleMesh* operator->() const { return &**this; }

    [[nodiscard]] const MeshEdges& edges() const;
    /// Frees the edges, which use more memory than the mesh. closed() and woundShells() stay available.
    void freeEdges() const;
    [[nodiscard]] const std::vector<OddEdge>& oddEdges() const;
    /// Whether there is no odd edge. Then all rays from a point have the same crossing parity.
    [[nodiscard]] bool closed() const { return oddEdges().empty(); }
    /// Whether the winding number, not the parity of ray crossings, classifies points. True for a closed mesh after
    /// windOutwards if hasSeveralShells(), and for a union if all bodies are 0.
    [[nodiscard]] bool woundShells() const;
    /// Returns −1 if the mesh is closed and inside out (triangles are clockwise seen from outside), else 1. Here,
    /// closed means that the triangles' area vectors sum to zero; the sign is that of the enclosed volume.
    [[nodiscard]] double orientation() const;
    [[nodiscard]] const AreaTable& areas() const;
    /// Returns the Embree scene, which lives as long as any copy of this handle. Errors: those of EmbreeMesh::build.
    [[nodiscard]] Result<const EmbreeMesh*> tree() const;

    /// Returns the mesh after windOutwards. Keeps derived data that the change cannot affect, and all derived data
    /// if no triangle is flipped.
    /// \param turn  per triangle: swap its second and third corners.
    [[nodiscard]] PreparedMesh woundOutwards(const std::vector<bool>& turn) &&;
    /// The argument of woundOutwards; empty if no triangle was flipped.
    [[nodiscard]] const std::vector<bool>& turned() const { return state_->turned; }
    /// Builds a mesh of parts that each enclose a volume; the inside is their union.
    /// \param bodies  per triangle: 0 if the winding number decides (wound outwards), else the number of a body that
    /// uses the parity of ray crossings.
    [[nodiscard]] static PreparedMesh unionOf(TriangleMesh mesh, std::vector<std::uint32_t> bodies);
    /// The argument of unionOf; empty for other meshes.
    [[nodiscard]] const std::vector<std::uint32_t>& bodies() const { return state_->bodies; }

    /// Returns the same mesh; points in `voids` are inside.
    [[nodiscard]] PreparedMesh withVoids(Voids voids) &&;
    [[nodiscard]] const Voids& voids() const { return state_->voids; }

    /// Wraps `mesh`, which is this mesh with caps. The result is wound outwards if this mesh is.
    [[nodiscard]] PreparedMesh capped(TriangleMesh mesh) const;

  private:
    struct State {
        TriangleMesh mesh;
        bool wound_outwards = false;
        std::vector<bool> turned;
        std::optional<MeshEdges> edges;
        std::optional<std::vector<OddEdge>> odd_edges;
        std::optional<bool> several_shells;
        std::optional<double> orientation;
        std::optional<AreaTable> areas;
        std::shared_ptr<EmbreeMesh> tree;
        std::vector<std::uint32_t> bodies;
        Voids voids;

        /// Computes everything that depends on the edges. If the edges are not stored, computes them temporarily.
        void computeFromEdges();
    };
    std::shared_ptr<State> state_;
};

}  // namespace relief
