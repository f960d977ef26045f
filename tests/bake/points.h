// SPDX-License-Identifier: Apache-2.0
// Random points in a box, the same for every compiler.
#pragma once

#include <vector>

#include "bake/mesh/surface_sampler.h"
#include "formats/collider.h"

namespace relief::test {

/// Uniform points in a box of 1.2 times these bounds.
[[nodiscard]] inline std::vector<glm::vec3> pointsIn(const Bounds& bounds, int count) {
    MersenneRandom random(7);
    std::vector<glm::vec3> points;
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 fraction{random.uniform(), random.uniform(), random.uniform()};
        points.emplace_back(glm::dvec3(bounds.center()) + 1.2 * glm::dvec3(bounds.size()) * (fraction - 0.5));
    }
    return points;
}

/// Each coordinate in [−1, 1).
[[nodiscard]] inline glm::dvec3 inCube(MersenneRandom& random) {
    return {2.0 * random.uniform() - 1.0, 2.0 * random.uniform() - 1.0, 2.0 * random.uniform() - 1.0};
}

}  // namespace relief::test
