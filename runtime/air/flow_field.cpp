// SPDX-License-Identifier: Apache-2.0
#include "runtime/air/flow_field.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "formats/base/finite.h"

namespace relief {
namespace {

std::string sizeText(const std::array<std::uint64_t, 3>& size) {
    return std::to_string(size[0]) + "x" + std::to_string(size[1]) + "x" + std::to_string(size[2]);
}

}  // namespace

Result<void> checkFlowSize(const std::array<std::uint64_t, 3>& size) {
    std::uint64_t nodes = 1;
    for (const std::uint64_t side : size) {
        if (side == 0) {
            return fail(ErrorCode::kInvalidInput, "a flow of " + sizeText(size) + " nodes is empty");
        }
        if (side > FlowField::kSideMax) {
            return fail(ErrorCode::kLimit, "a flow of " + sizeText(size) + " nodes has more than " +
                                               std::to_string(FlowField::kSideMax) +
                                               " along an axis; resample it");
        }
        nodes *= side;
    }
    if (nodes > FlowField::kNodesMax) {
        return fail(ErrorCode::kLimit, "a flow of " + sizeText(size) + " nodes takes " +
                                           std::to_string(nodes * FlowField::kNodeBytes) +
                                           " bytes, more than " + std::to_string(FlowField::kBytesMax) +
                                           "; resample it, for example to 256x256x256");
    }
    return {};
}

Result<void> checkFlow(const FlowField& flow) {
    const std::array<std::uint64_t, 3> size{flow.size[0], flow.size[1], flow.size[2]};
    RELIEF_TRY(checkFlowSize(size));
    if (flow.nodes.size() != size[0] * size[1] * size[2]) {
        return fail(ErrorCode::kInvalidInput, "a flow of " + sizeText(size) + " nodes has " +
                                                  std::to_string(flow.nodes.size()) + " velocities");
    }
    if (!isFinite(flow.box_min) || !isFinite(flow.box_max) || !isFinite(flow.box_max - flow.box_min) ||
        !std::isfinite(flow.gain)) {
        return fail(ErrorCode::kInvalidInput, "a flow's box and gain must be finite");
    }
    for (int axis = 0; axis < 3; ++axis) {
        if (!(flow.box_min[axis] < flow.box_max[axis]) || !std::isfinite(flowNodesPerUnit(flow)[axis])) {
            return fail(ErrorCode::kInvalidInput,
                        "a flow's box is empty on the " + std::string(1, "xyz"[axis]) + " axis");
        }
    }
    const auto bad = std::find_if_not(flow.nodes.begin(), flow.nodes.end(), isFinite);
    if (bad != flow.nodes.end()) {
        const auto index = static_cast<std::size_t>(bad - flow.nodes.begin());
        return fail(ErrorCode::kInvalidInput, "the velocity at node " + std::to_string(index % size[0]) +
                                                  ", " + std::to_string(index / size[0] % size[1]) + ", " +
                                                  std::to_string(index / (size[0] * size[1])) +
                                                  " is not finite");
    }
    return {};
}

glm::vec3 flowNodesPerUnit(const FlowField& flow) {
    glm::vec3 scale;
    for (int axis = 0; axis < 3; ++axis) {
        scale[axis] = static_cast<float>(flow.size[static_cast<std::size_t>(axis)] - 1) /
                      (flow.box_max[axis] - flow.box_min[axis]);
    }
    return scale;
}

}  // namespace relief
