// SPDX-License-Identifier: Apache-2.0
// Velocities on a grid over a box, sampled by reliefFlow() in shaders/air/air.glsl.
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
    kZero = 0,  ///< zero: the velocity jumps at the faces of the box
    kEdge = 1,  ///< the velocity at the nearest point of the box
};
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<FlowOutside>{"zero", "edge"};

/// A node-centred grid: the first and last nodes of an axis lie on the faces of the box, and velocities are
/// interpolated trilinearly. Along an axis with a single node the velocity is constant, so a 2-D flow has
/// size[2] = 1.
struct FlowField {
    static constexpr std::uint32_t kSideMax = 512;                     ///< nodes along an axis
    static constexpr std::size_t kBytesMax = std::size_t{256} << 20U;  ///< on the GPU
    static constexpr std::size_t kNodeBytes = 16;                      ///< bytes of a node on the GPU
    static constexpr std::size_t kNodesMax = kBytesMax / kNodeBytes;   ///< 2^24

    std::array<std::uint32_t, 3> size{1, 1, 1};  ///< nodes along x, y, z: 1 … kSideMax each
    glm::vec3 box_min{0.0F};                     ///< object units
    glm::vec3 box_max{1.0F};                     ///< above box_min on every axis
    FlowOutside outside = FlowOutside::kZero;
    float gain = 1.0F;             ///< multiplies every velocity
    std::vector<glm::vec3> nodes;  ///< object units/s; x fastest, then y, then z
};

/// Checks the size of a grid. Messages do not name a file.
/// Errors: kLimit (kSideMax or kNodesMax exceeded), kInvalidInput (an axis without nodes).
[[nodiscard]] Result<void> checkFlowSize(const std::array<std::uint64_t, 3>& size);

/// Checks a whole field.
/// Errors: those of checkFlowSize; kInvalidInput (wrong number of nodes, an empty box, NaN or infinity; the message
/// names the first such node).
[[nodiscard]] Result<void> checkFlow(const FlowField& flow);

/// Returns nodes per object unit for each axis, for the shader; 0 for axes with a single node.
[[nodiscard]] glm::vec3 flowNodesPerUnit(const FlowField& flow);

}  // namespace relief
