// Depth planes: leaves inside a mesh whose plane, or that of the split cell above, does not belong to the nearest face get planes
// of their own.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "bake/mesh/mesh_query.h"
#include "bake/patches/patch_node.h"
#include "formats/patch_tree.h"

namespace relief {

/// The plane of a split cell, for octants without a record.
[[nodiscard]] CellPlane planeOfSplit(const MeshQuery& query, const PatchNode& node);
/// The planes of a leaf without a surface that has DepthPlanes::kTwo.
/// \return nullopt if a plane cuts the cell or its heights are out of range: not for leaves that DepthPlaneChoice chose.
[[nodiscard]] std::optional<std::array<PatchRecord, 2>> planesOfEmpty(const MeshQuery& query,
                                                                      const PatchNode& node);
/// The second plane of a leaf with a single surface that has DepthPlanes::kTwo: of a face outside the cell.
/// \return as planesOfEmpty().
[[nodiscard]] std::optional<PatchRecord> planeBeyond(const MeshQuery& query, const PatchNode& node);

/// The depth planes of a leaf, their cost and their gain.
struct DepthGain {
    PatchNode* node = nullptr;
    DepthPlanes planes = DepthPlanes::kNone;
    double bytes = 0.0;
    double volume = 0.0;  ///< misclassified volume that weighs as much, object units cubed

    [[nodiscard]] double worth() const { return volume / bytes; }
};

/// Chooses depth planes for the leaves of a planned tree, sorted by gain per byte. The same for any number of threads.
class DepthPlaneChoice {
  public:
    /// \param roots  borrowed; their leaves have no depth planes yet.
    DepthPlaneChoice(const MeshQuery& query, std::span<PatchNode> roots);

    /// Bytes of all planes that gain more than `byte` per byte.
    /// \param byte  misclassified volume, object units cubed.
    [[nodiscard]] double bytesWorth(double byte) const;
    /// Sets PatchNode::planes for these, in at most `bytes` bytes.
    void take(double bytes, double byte) const;

  private:
    std::vector<DepthGain> gains_;
};

}  // namespace relief
