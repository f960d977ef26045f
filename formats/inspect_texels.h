// What is suspicious about maps whose texels are valid: inspect.h's warnings 22xx.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "formats/collider.h"
#include "formats/issue.h"

namespace relief {

struct TexelInspection {
    double coverage = 0.0;            ///< share of texels with a surface, 0…1
    std::vector<Issue> issues;        ///< their map left at −1
    std::vector<glm::dvec3> surface;  ///< surface points of some texels, object space
};

/// \param map     valid, with its texels.
/// \param bounds  of the collider; nullptr where they are not valid.
[[nodiscard]] TexelInspection inspectTexels(const DepthMap& map, const Bounds* bounds);

/// How many of the points lie outside of the map's volume by more than the spread of a texel: none does where
/// `encloses` is true.
[[nodiscard]] std::size_t countOutsideVolume(const DepthMap& map, const std::vector<glm::dvec3>& points);

}  // namespace relief
