// SPDX-License-Identifier: Apache-2.0
// Views of a whole mesh from outside: candidates for the planner.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "bake/mesh/mesh.h"
#include "bake/mesh/oriented_box.h"
#include "bake/mesh/vertex_blocks.h"
#include "bake/plan/map_spec.h"
#include "formats/base/result.h"

namespace relief {

struct OuterView {
    MapSpec spec;  ///< of a front-back map of planes, turned for the shortest rows; its size is meaningless
    double width = 0.0;  ///< object units
    double height = 0.0;
    double area = 0.0;  ///< of its row spans (formats/row_spans.h), object units squared
};

/// Unit vectors spread over the sphere, one of each opposite pair, and the diagonals of the box, which may be among them.
[[nodiscard]] std::vector<glm::dvec3> outerDirections(const Bounds& bounds);

/// Along the outer directions, then the axes of the oriented box if there is one, but for views of a flat mesh edge-on. The
/// axes of that box also turn the images.
/// \param blocks  of the mesh's positions.
/// \param points  all over the surface: an estimate of the rows.
/// Errors: those of makeView.
[[nodiscard]] Result<std::vector<OuterView>> outerViews(const TriangleMesh& mesh, const VertexBlocks& blocks,
                                                        const std::vector<glm::dvec3>& points,
                                                        const std::optional<OrientedBox>& box);

}  // namespace relief
