// SPDX-License-Identifier: Apache-2.0
#include "runtime/files/flow_file.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include "formats/base/file_io.h"
#include "formats/base/result.h"

namespace relief {
namespace {

static_assert(std::endian::native == std::endian::little,
              "raw flows are little-endian and are copied without conversion");

Result<void> readNodes(const FlowFile& file, FlowField& flow) {
    const std::string name = quotedPath(file.path);
    if (file.components != 2 && file.components != 3) {
        return fail(ErrorCode::kUsage, name + ": components must be 2 or 3");
    }
    RELIEF_TRY(withPrefix(name, checkFlowSize({file.size[0], file.size[1], file.size[2]})));
    const std::size_t nodes = std::size_t{file.size[0]} * file.size[1] * file.size[2];
    const std::size_t expected = nodes * file.components * sizeof(float);
    const auto bytes = RELIEF_TRY(readFile(file.path, FlowField::kNodesMax * 3 * sizeof(float)));
    if (bytes.size() != expected) {
        return fail(ErrorCode::kInvalidInput, name + " has " + std::to_string(bytes.size()) +
                                                  " bytes, but size and components require " +
                                                  std::to_string(expected));
    }
    flow.size = file.size;
    flow.nodes.assign(nodes, glm::vec3(0.0F));
    for (std::size_t i = 0; i < nodes; ++i) {
        const std::size_t node_bytes = file.components * sizeof(float);
        std::memcpy(&flow.nodes[i].x, bytes.data() + i * node_bytes, node_bytes);
    }
    return {};
}

Result<void> checkSpeeds(const FlowFile& file, const FlowField& flow) {
    const std::size_t slice = std::size_t{flow.size[0]} * flow.size[1];
    for (std::size_t i = 0; i < flow.nodes.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            const float v = flow.nodes[i][axis];
            if (std::abs(v) <= kFlowSpeedMax) {  // false for NaN
                continue;
            }
            return fail(ErrorCode::kInvalidInput,
                        quotedPath(file.path) + ": the velocity at node " + std::to_string(i % flow.size[0]) +
                            ", " + std::to_string(i / flow.size[0] % flow.size[1]) + ", " +
                            std::to_string(i / slice) +
                            (std::isfinite(v) ? " is above 1000000 per second" : " is not finite"));
        }
    }
    return {};
}

Result<FlowField> load(const FlowFile& file) {
    FlowField flow;
    flow.box_min = file.box_min;
    flow.box_max = file.box_max;
    flow.outside = file.outside;
    flow.gain = file.gain;
    RELIEF_TRY(readNodes(file, flow));
    RELIEF_TRY(checkSpeeds(file, flow));
    RELIEF_TRY(withPrefix(quotedPath(file.path), checkFlow(flow)));
    return flow;
}

}  // namespace

Result<FlowField> loadFlow(const FlowFile& file) {
    auto flow = load(file);
    if (!flow && !file.origin.empty()) {
        return fail(flow.error().code, file.origin + flow.error().message);
    }
    return flow;
}

std::optional<FieldFault> check(FlowFile& flow, const GivenFields& /*given*/) {
    flow.origin += ": flow.raw: ";
    if (auto checked = checkFlowSize({flow.size[0], flow.size[1], flow.size[2]}); !checked) {
        return FieldFault{"size", "is invalid: " + checked.error().message};
    }
    for (int i = 0; i < 3; ++i) {
        if (!(flow.box_min[i] < flow.box_max[i])) {
            return FieldFault{"box_min", "is not below flow.box_max on the " + std::string(1, "xyz"[i]) +
                                             " axis; move one of them"};
        }
    }
    return std::nullopt;
}

void fields(FieldVisitor& visit, FlowFile& flow) {
    const FieldPlaced path{flow.path, flow.origin};
    visit("raw", path, {"Little-endian 32-bit floats, x fastest, then y, then z", {}, {}, {}, kRequired});
    visit("size", flow.size,
          {.help = "Nodes along x, y and z, at most 2²⁴ in total",
           .unit = "[nx, ny, nz]",
           .range = {1.0, FlowField::kSideMax},
           .rules = kRequired});
    visit("components", flow.components, {"Floats per node", {}, {2.0, 3.0}});
    visit("box_min", flow.box_min,
          {"Lower corner of the flow's box", "[x, y, z]", kPointRange, {}, kRequired});
    visit("box_max", flow.box_max,
          {"Upper corner of the flow's box", "[x, y, z]", kPointRange, {}, kRequired});
    visit("outside", flow.outside,
          {"Velocity outside the box: zero, or that of the nearest point of the box"});
    visit("gain", flow.gain, {"Factor on all velocities", {}, within(1e6), {}, {.not_zero = true}});
}

}  // namespace relief
