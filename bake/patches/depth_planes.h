// SPDX-License-Identifier: Apache-2.0
// Depth planes: planes that a leaf stores for points deep inside the mesh. A leaf gets depth planes if its own plane,
// or the plane of the split cell above, does not belong to the face nearest to these points. A leaf beside a flat face
// gets depth planes if the plane of the split cell above is tilted relative to that face.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <span>
#include <vector>

#include "bake/mesh/flat_faces.h"
#include "bake/mesh/mesh_query.h"
#include "bake/patches/patch_node.h"
#include "formats/patch_tree.h"

namespace relief {

/// Returns the plane of a split cell, used by octants without a record.
[[nodiscard]] CellPlane planeOfSplit(const MeshQuery& query, const PatchNode& node);

/// Depth planes that replace the current ones of a leaf, with their cost and gain.
struct DepthGain {
    static constexpr double kBytesMin = kPatchTexelBytes;

    PatchNode* node = nullptr;
    DepthPlanes from = DepthPlanes::kNone;
    DepthPlanes to = DepthPlanes::kNone;
    std::array<PatchRecord, 2> records{};  ///< PatchNode::depth
    double bytes = 0.0;                    ///< in addition to the bytes of `from`
    double volume = 0.0;                   ///< the equivalent misclassified volume, object units cubed

    [[nodiscard]] double worth() const { return volume / bytes; }
};

/// The depth planes of the leaves directly below one split cell, or of one unsplit root.
struct FamilyGains {
    std::vector<DepthGain> gains;
    double rest = 0.0;  ///< upper bound of DepthGain::worth() of all planes not in `gains`
};

/// Chooses depth planes for the leaves of a planned tree. The result does not depend on the number of threads.
class DepthPlaneChoice {
  public:
    /// \param query, faces  borrowed; `faces` has one element per triangle of the mesh of `query`.
    DepthPlaneChoice(const MeshQuery& query, std::span<const FlatFace> faces)
        : query_(query), faces_(faces) {}

    /// Finds the planes of a tree. Later calls reuse the planes of unchanged leaves. Does not depend on the planes that
    /// take() has set.
    /// \param roots  borrowed for the lifetime of this object.
    /// \param byte  minimum gain per byte of the planes: misclassified volume, object units cubed.
    /// \param least_byte  the lowest `byte` of later calls for the same tree.
    /// \param progress  called often, from any thread; its exceptions end the search and propagate.
    void find(std::span<PatchNode> roots, double byte, double least_byte,
              const std::function<void()>& progress);

    /// Returns the total size in bytes of the planes whose gain per byte exceeds `byte`.
    /// \param byte  misclassified volume, object units cubed.
    [[nodiscard]] double bytesWorth(double byte) const;
    /// Sets PatchNode::planes and PatchNode::depth for the planes with the largest gain per byte, up to `bytes` bytes
    /// in total. Skips planes that earlier calls for the same tree have set.
    /// \return the bytes left.
    double take(double bytes) const;

  private:
    struct Known {
        std::uint64_t state = 0;  // hash of the leaves that the gains belong to
        double least_byte = 0.0;
        FamilyGains found{.gains = {}, .rest = std::numeric_limits<double>::infinity()};
    };

    const MeshQuery& query_;
    std::span<const FlatFace> faces_;
    std::map<const PatchNode*, Known> known_;  // by the split cell, or the root
    std::vector<DepthGain> gains_;             // sorted by gain per byte
};

}  // namespace relief
