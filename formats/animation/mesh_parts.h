// SPDX-License-Identifier: Apache-2.0
// Parts of an animated mesh by name: vertex groups, which are what a joint carries, and materials.
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "formats/animation/animated_mesh.h"
#include "formats/base/result.h"

namespace relief {

/// Of nodes whose joints move vertices, in the order of the joints, each once; those without a name are left out.
[[nodiscard]] std::vector<std::string> groupNames(const AnimatedMesh& mesh);

/// For each vertex the weight, 0 … 1, of all joints whose node has that name; of those below it only where they have it, too.
/// Errors: kInvalidInput (no such joint moves a vertex; the message lists those that do, or 20 of them).
[[nodiscard]] Result<std::vector<float>> groupWeights(const AnimatedMesh& mesh, std::string_view name);

/// The triangles of a material. Errors: kInvalidInput (there is none; the message lists those there are, or 20 of them).
[[nodiscard]] Result<std::vector<glm::uvec3>> materialTriangles(const AnimatedMesh& mesh,
                                                                std::string_view name);

/// "'A', 'B', …", the first 20; "" if there is none. \param names  empty ones, and those that come again, are left out.
[[nodiscard]] std::string listedNames(const std::vector<std::string>& names);

/// "there is no KIND 'NAME'; it has 'A', 'B', …".
[[nodiscard]] std::string noSuchPart(const char* kind, std::string_view name,
                                     const std::vector<std::string>& names);

}  // namespace relief
