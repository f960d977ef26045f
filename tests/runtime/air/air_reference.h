// What shaders/air/air.glsl and curl_noise.glsl compute on the GPU, on the CPU.
#pragma once

#include "runtime/air/air.h"

namespace relief {

/// Wind, flow and noise together at point p, object units a second.
/// \param t  seconds, as airTime() gives them.
[[nodiscard]] glm::vec3 airVelocity(const AirSettings& air, const glm::vec3& p, float t);

/// The acceleration of a particle at p by attractors and vortices, object units a second squared. `v` and `t` are for
/// fields to come: none yet depends on them.
[[nodiscard]] glm::vec3 fieldAcceleration(const AirSettings& air, const glm::vec3& p, const glm::vec3& v,
                                          float t);

/// The velocity at p and time t, object units a second. No speed exceeds 4.4 · √2 · 15/√85 · amplitude (all
/// numbers of all corners at their worst); in practice none exceeds 4 · amplitude.
/// \param t  seconds, as curlTime() gives them.
[[nodiscard]] glm::vec3 curlVelocity(const CurlNoise& noise, const glm::vec3& p, float t);

/// The velocity at p, object units a second, by the operations of the shader in their order.
/// \param flow  as checkFlow has it.
[[nodiscard]] glm::vec3 flowVelocity(const FlowField& flow, const glm::vec3& p);

}  // namespace relief
