// SPDX-License-Identifier: Apache-2.0
// A minimal glTF reader for small files with one buffer, written from the specification. Tests compare bake/import with
// it.
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

/// All triangles of the default scene in file order, with morph weights applied.
/// \param moment  nullopt: the nodes' own transforms
/// Throws std::exception if anything that the triangles depend on violates the specification.
[[nodiscard]] std::vector<Corners> readGltfReference(const GltfCase& file,
                                                     const std::optional<GltfMoment>& moment = {});

/// Duration of each animation in seconds.
[[nodiscard]] std::vector<double> referenceClipLengths(const GltfCase& file);

}  // namespace relief::test
