// SPDX-License-Identifier: Apache-2.0
// A bounding volume hierarchy over a triangle mesh, packed for closest-point queries on the GPU
// (shaders/bench/mesh_tree.glsl): an exact rival of depth maps.
//
// Nodes have up to four children, whose boxes take 8 bits per face, rounded outwards. Splits minimise the surface area
// heuristic over bins of centroids. Triangles are stored in leaf order. The pseudonormal of the closest face, edge or
// vertex decides whether a point is inside, without error for closed meshes: Bærentzen and Aanæs, "Signed distance
// computation using the angle weighted pseudonormal", IEEE TVCG 11 (2005).
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

struct MeshTree {
    /// Children per node.
    static constexpr std::size_t kWidth = 4;
    /// Maximum triangles per leaf.
    static constexpr std::uint32_t kLeafMax = 4;
    /// Four-bit code of a child that is a node. The code of a leaf is its number of triangles; 0: an unused child.
    static constexpr std::uint32_t kNodeCode = 15;
    /// Texels per node and per triangle.
    static constexpr std::size_t kTexels = 3;

    Bounds box;
    /// Three texels per node, the root first. Bytes and codes of a word start with child 0 in the lowest bits. Faces of
    /// child boxes are bytes: offsets from the node's lowest corner in box units (a power of 2 for each axis):
    ///     0: lowest corner as float bits; log2 of the box units of x, y, z, plus 127, in 8 bits each
    ///     1: first child node (24 bits) and codes of children 0, 1; first triangle (24 bits) and codes of children 2, 3;
    ///        lower faces x; lower faces y
    ///     2: lower faces z; upper faces x, y, z
    /// Child nodes are consecutive, and so are the triangles of the leaves of a node.
    std::vector<glm::uvec4> nodes;
    /// Three texels per triangle: the corners as float bits, each with the index of the triangle across the edge to the
    /// next corner, or of the triangle itself if there is none.
    std::vector<glm::uvec4> triangles;
    /// Three per triangle: the vertex indices of its corners.
    std::vector<std::uint32_t> vertices;
    /// Per vertex: the angle-weighted pseudonormal, of unit length or zero; w is unused.
    std::vector<glm::vec4> normals;
    std::uint32_t stack = 0;  ///< entries that a depth-first traversal needs
    /// Triangle edges without exactly one opposite edge; 0 for a closed manifold.
    std::size_t open_edges = 0;
    std::size_t dropped = 0;  ///< triangles without area

    [[nodiscard]] std::uint64_t bytes() const {
        return (nodes.size() + triangles.size() + normals.size()) * sizeof(glm::uvec4) +
               vertices.size() * sizeof(std::uint32_t);
    }
};

/// Builds a tree. Equal positions are merged. The result depends only on the mesh.
/// \param positions  finite, object units.
/// \param triangles  valid indices; anticlockwise from outside.
/// Errors: kInvalidInput (no triangle with an area), kLimit (2^24 triangles; a tree deeper than a shader's stack).
[[nodiscard]] Result<MeshTree> buildMeshTree(std::span<const glm::vec3> positions,
                                             std::span<const glm::uvec3> triangles);

}  // namespace relief
