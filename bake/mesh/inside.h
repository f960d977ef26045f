// Whether a point lies inside a mesh.
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "bake/mesh/mesh.h"

namespace relief {

/// Of the rays whose crossings are counted; about unit length.
inline constexpr std::array<glm::dvec3, 7> kParityDirections = {{{0.5773, 0.6137, 0.5386},
                                                                 {-0.7351, 0.3119, 0.6019},
                                                                 {0.2677, -0.8713, 0.4111},
                                                                 {0.4637, 0.3511, -0.8135},
                                                                 {-0.1933, -0.5557, -0.8087},
                                                                 {0.8819, -0.2749, -0.3829},
                                                                 {-0.6131, 0.7717, -0.1693}}};

/// The majority over seven fixed directions, none of them special to any model, of the parity of the number
/// of surfaces that a ray from `point` crosses; of a mesh that windOutwards has seen to, as
/// MeshQuery::inside, of whether its shells wind round the point. The winding of other meshes does not
/// matter, and a few holes do not either. Cost: all triangles, in double precision, on all cores.
[[nodiscard]] bool insideByParity(const TriangleMesh& mesh, const glm::vec3& point);

}  // namespace relief
