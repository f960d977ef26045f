// Views of a whole mesh from outside, from which the planner chooses.
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
    MapSpec
        spec;  ///< of a front-back map of planes, turned so that its rows take up little; its size is of no account
    double width = 0.0;  ///< object units
    double height = 0.0;
    double area = 0.0;  ///< that its rows take up (formats/row_spans.h), object units squared
};

/// Directions spread over the sphere, one of each opposite pair, and the diagonals of the box, which may be among them; of
/// unit length.
[[nodiscard]] std::vector<glm::dvec3> outerDirections(const Bounds& bounds);

/// Along the outer directions, and then the axes of the oriented box, if it is given, by which images are turned, too; but
/// for those that see a flat mesh edge-on.
/// \param blocks  of the mesh's positions.
/// \param points  near the surface and all over it: they show how much rows take up.
/// Errors: those of makeView.
[[nodiscard]] Result<std::vector<OuterView>> outerViews(const TriangleMesh& mesh, const VertexBlocks& blocks,
                                                        const std::vector<glm::dvec3>& points,
                                                        const std::optional<OrientedBox>& box);

}  // namespace relief
