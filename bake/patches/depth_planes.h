// Planes for points deep inside: leaves whose own plane, or that of the split cell above, belongs to a face that is not the
// nearest one.
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
/// The plane of the surface point nearest to the middle of a cell without a patch.
[[nodiscard]] CellPlane planeOfMiddle(const MeshQuery& query, const PatchNode& node);

/// The planes that decide in a leaf with DepthPlanes::kTwo: of one without a surface both, of one with a surface the second,
/// which no part of the cell is in front of.
/// \return nullopt where two planes hold no more than one does.
[[nodiscard]] std::optional<std::array<PatchRecord, 2>> depthPlanesOf(const MeshQuery& query,
                                                                      const PatchNode& node);

/// What planes a leaf would gain by, and for how many bytes.
struct DepthGain {
    PatchNode* node = nullptr;
    DepthPlanes planes = DepthPlanes::kNone;
    double bytes = 0.0;
    double volume =
        0.0;  ///< of the cell, object units cubed, times the error in cells that the planes correct

    [[nodiscard]] double worth() const { return volume / bytes; }
};

/// The leaves of a planned tree that need planes, those first that gain most for their bytes. The same for any number of threads.
class DepthPlaneChoice {
  public:
    /// \param roots  borrowed; their leaves have no planes yet.
    DepthPlaneChoice(const MeshQuery& query, std::span<PatchNode> roots);

    /// Bytes of planes that gain more than the surface does where a byte is worth so much wrong volume.
    [[nodiscard]] double bytesWorth(double byte) const;
    /// Sets PatchNode::planes of those, within so many bytes.
    void take(double bytes, double byte) const;

  private:
    std::vector<DepthGain> gains_;
};

}  // namespace relief
