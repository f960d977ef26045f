// SPDX-License-Identifier: Apache-2.0
// Reads flow fields from files.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string>

#include "formats/base/field.h"
#include "formats/base/result.h"
#include "formats/base/scene_limits.h"
#include "runtime/air/flow_field.h"

namespace relief {

/// The [flow] of a scene: a volume of little-endian 32-bit floats, x fastest, then y, then z.
struct FlowFile {
    std::filesystem::path path;
    std::string origin;                   ///< prefix of messages: "scene.toml:3:7: flow.raw: "; may be empty
    std::array<std::uint32_t, 3> size{};  ///< nodes along x, y, z
    std::uint32_t components = 3;         ///< floats per node: 3, or 2 (z is 0)
    glm::vec3 box_min{0.0F};
    glm::vec3 box_max{1.0F};
    FlowOutside outside = FlowOutside::kZero;
    float gain = 1.0F;
};
void fields(FieldVisitor& visit, FlowFile& flow);
[[nodiscard]] std::optional<FieldFault> check(FlowFile& flow, const GivenFields& given);

/// Maximum absolute value of each velocity component, object units/s.
inline constexpr float kFlowSpeedMax = 1e6F;

/// Reads a flow from an untrusted file.
/// Errors, with the file name: kIo; kUsage (components other than 2 or 3; those of checkFlow()); kInvalidInput (wrong
/// file size; a velocity that is not finite or above kFlowSpeedMax); kLimit (see FlowField).
[[nodiscard]] Result<FlowField> loadFlow(const FlowFile& file);

}  // namespace relief
