// SPDX-License-Identifier: Apache-2.0
// Depth planes: leaves inside a mesh whose plane, or that of the split cell above, does not belong to the nearest face get planes
// of their own, as do leaves beside a flat face if the plane of the split cell above is turned from it.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <vector>

#include "bake/mesh/flat_faces.h"
#include "bake/mesh/mesh_query.h"
#include "bake/patches/patch_node.h"
#include "formats/patch_tree.h"

namespace relief {

/// The plane of a split cell, for octants without a record.
[[nodiscard]] CellPlane planeOfSplit(const MeshQuery& query, const PatchNode& node);

/// Depth planes that replace those that a leaf has so far, their cost and their gain.
struct DepthGain {
    PatchNode* node = nullptr;
    DepthPlanes from = DepthPlanes::kNone;
    DepthPlanes to = DepthPlanes::kNone;
    std::array<PatchRecord, 2> records{};  ///< PatchNode::depth
    double bytes = 0.0;                    ///< more than `from` takes
    double volume = 0.0;                   ///< misclassified volume that weighs as much, object units cubed

    [[nodiscard]] double worth() const { return volume / bytes; }
};

/// Chooses depth planes for the leaves of a planned tree. The same for any number of threads.
class DepthPlaneChoice {
  public:
    /// \param query, faces  borrowed; faces are those of its mesh, one per triangle.
    DepthPlaneChoice(const MeshQuery& query, std::span<const FlatFace> faces)
        : query_(query), faces_(faces) {}

    /// Finds the planes of a tree. Later calls reuse those of leaves that are as before.
    /// \param roots  borrowed as long as this object is used; their leaves have no depth planes yet.
    /// \param byte  misclassified volume, object units cubed: planes that gain less per byte are not chosen.
    /// \param progress  called often, from any thread; what it throws ends the search.
    void find(std::span<PatchNode> roots, double byte, const std::function<void()>& progress);

    /// Bytes of all planes found that gain more than `byte` per byte.
    /// \param byte  misclassified volume, object units cubed.
    [[nodiscard]] double bytesWorth(double byte) const;
    /// Sets PatchNode::planes and PatchNode::depth of those with the largest gain per byte, in at most `bytes` bytes.
    void take(double bytes) const;

  private:
    struct Known {
        std::uint64_t state = 0;  // of the leaves that the gains are of
        std::vector<DepthGain> gains;
    };

    const MeshQuery& query_;
    std::span<const FlatFace> faces_;
    std::map<const PatchNode*, Known> known_;  // by the cell that is split, or the root
    std::vector<DepthGain> gains_;             // sorted by gain per byte
};

}  // namespace relief
