// SPDX-License-Identifier: Apache-2.0
// Defines the directions of rays that classify points as inside or outside.
#pragma once

#include <array>
#include <glm/vec3.hpp>

namespace relief {

/// About unit length. Modelled edges and faces are unlikely to be parallel to them.
inline constexpr std::array<glm::dvec3, 7> kParityDirections = {{{0.5773, 0.6137, 0.5386},
                                                                 {-0.7351, 0.3119, 0.6019},
                                                                 {0.2677, -0.8713, 0.4111},
                                                                 {0.4637, 0.3511, -0.8135},
                                                                 {-0.1933, -0.5557, -0.8087},
                                                                 {0.8819, -0.2749, -0.3829},
                                                                 {-0.6131, 0.7717, -0.1693}}};

}  // namespace relief
