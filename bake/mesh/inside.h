// Point-in-mesh by ray parity, without a tree.
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "bake/mesh/prepared_mesh.h"

namespace relief {

/// Directions of the rays; about unit length. No model is built along them.
inline constexpr std::array<glm::dvec3, 7> kParityDirections = {{{0.5773, 0.6137, 0.5386},
                                                                 {-0.7351, 0.3119, 0.6019},
                                                                 {0.2677, -0.8713, 0.4111},
                                                                 {0.4637, 0.3511, -0.8135},
                                                                 {-0.1933, -0.5557, -0.8087},
                                                                 {0.8819, -0.2749, -0.3829},
                                                                 {-0.6131, 0.7717, -0.1693}}};

/// The majority of seven rays from `point`. A ray votes "inside" if it crosses the surface an odd number of times, or for
/// PreparedMesh::woundShells if the shells wind round the point. Tolerates a few holes. Visits all triangles, in double
/// precision, on all cores.
[[nodiscard]] bool insideByParity(const PreparedMesh& prepared, const glm::vec3& point);

}  // namespace relief
