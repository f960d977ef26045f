// SPDX-License-Identifier: Apache-2.0
// Selects parts of an animated mesh by name: vertex groups (the vertices that a joint moves) and materials.
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "formats/animation/animated_mesh.h"
#include "formats/base/result.h"

namespace relief {

/// Returns the names of nodes whose joints move vertices, in joint order, without duplicates or empty names.
[[nodiscard]] std::vector<std::string> groupNames(const AnimatedMesh& mesh);

/// Returns for each vertex the sum of its weights, 0 … 1, for all joints whose node has this name. Child nodes are
/// included only if they have the same name. Errors: kInvalidInput if no such joint moves a vertex; the message lists
/// up to 20 names of other joints.
[[nodiscard]] Result<std::vector<float>> groupWeights(const AnimatedMesh& mesh, std::string_view name);

/// Returns the triangles of a material. Errors: kInvalidInput if it does not exist; the message lists up to 20 others.
[[nodiscard]] Result<std::vector<glm::uvec3>> materialTriangles(const AnimatedMesh& mesh,
                                                                std::string_view name);

/// Returns "'A', 'B', …" for the first 20 distinct, non-empty names; "" if there are none.
[[nodiscard]] std::string listedNames(const std::vector<std::string>& names);

/// Returns "there is no KIND 'NAME'; the mesh has 'A', 'B', …".
[[nodiscard]] std::string partNotFound(const char* kind, std::string_view name,
                                       const std::vector<std::string>& names);

}  // namespace relief
