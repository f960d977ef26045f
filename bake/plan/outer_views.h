// Views of a whole mesh from outside, from which the planner chooses.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "bake/mesh/mesh.h"
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

/// Along directions spread over the sphere, the axes of the box and of the oriented box; but for those that see a flat
/// mesh edge-on.
/// \param points  near the surface and all over it: they show how much rows take up.
/// Errors: those of makeView.
[[nodiscard]] Result<std::vector<OuterView>> outerViews(const TriangleMesh& mesh,
                                                        const std::vector<glm::dvec3>& points,
                                                        bool oriented_box);

}  // namespace relief
