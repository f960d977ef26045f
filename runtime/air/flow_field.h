// SPDX-License-Identifier: Apache-2.0
// Velocities on a grid over a box: for reliefFlow() in shaders/air/air.glsl.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "formats/base/field.h"
#include "formats/base/result.h"

namespace relief {

/// The velocity outside a flow field's box.
enum class FlowOutside : int {
    kZero = 0,  ///< none: the velocity jumps to 0 at the box's faces
    kEdge = 1,  ///< that of the nearest point of the box
};
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<FlowOutside>{"zero", "edge"};

/// Node-centred: the first and last nodes of an axis lie on the faces of the box, and between nodes the
/// velocity is trilinear. An axis with a single node is constant along itself, which is how a 2-D flow, with
/// size[2] = 1, fills its box.
struct FlowField {
    static constexpr std::uint32_t kSideMax = 512;                     ///< nodes along an axis
    static constexpr std::size_t kBytesMax = std::size_t{256} << 20U;  ///< on the GPU
    static constexpr std::size_t kNodeBytes = 16;                      ///< what a GL takes for a node
    static constexpr std::size_t kNodesMax = kBytesMax / kNodeBytes;   ///< 2^24

    std::array<std::uint32_t, 3> size{1, 1, 1};  ///< nodes along x, y, z: 1 … kSideMax each
    glm::vec3 box_min{0.0F};                     ///< object units
    glm::vec3 box_max{1.0F};                     ///< above box_min on every axis
    FlowOutside outside = FlowOutside::kZero;
    float gain = 1.0F;             ///< factor of every velocity
    std::vector<glm::vec3> nodes;  ///< object units a second; x fastest, then y, then z
};

/// Checks the size of a grid. Messages name no file.
/// Errors: kLimit (kSideMax or kNodesMax exceeded), kInvalidInput (an axis without nodes).
[[nodiscard]] Result<void> checkFlowSize(const std::array<std::uint64_t, 3>& size);

/// Checks a whole field.
/// Fails as checkFlowSize does, and with kInvalidInput (too few or too many nodes, an empty box, NaN or
/// infinity: the message names the first such node).
[[nodiscard]] Result<void> checkFlow(const FlowField& flow);

/// Nodes per object unit on every axis, 0 where there is but one: what the shader multiplies with.
[[nodiscard]] glm::vec3 flowNodesPerUnit(const FlowField& flow);

}  // namespace relief
