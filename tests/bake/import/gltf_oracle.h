// SPDX-License-Identifier: Apache-2.0
// Another reader of glTF, as short as the specification allows, for small files with one buffer: what bake/import is compared with.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "tests/bake/import/gltf_cases.h"

namespace relief::test {

using Corners = std::array<glm::dvec3, 3>;

struct GltfMoment {
    std::size_t animation = 0;
    double seconds = 0.0;
};

/// All triangles of the file's scene, in the order in which the file has them, morphed by its weights.
/// \param moment  nullopt: the nodes as the file has them.
/// Throws std::exception for whatever is not as the specification says, as far as triangles hang on it.
[[nodiscard]] std::vector<Corners> readGltfByTheBook(const GltfCase& file,
                                                     const std::optional<GltfMoment>& moment = {});

/// Seconds that each animation lasts.
[[nodiscard]] std::vector<double> gltfLengthsByTheBook(const GltfCase& file);

}  // namespace relief::test
