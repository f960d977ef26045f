// SPDX-License-Identifier: Apache-2.0
// Triangles selected by area fraction, compared with a running sum.
#include "bake/mesh/area_table.h"

#include <algorithm>
#include <random>
#include <vector>

#include "bake/mesh/triangle_plane.h"
#include "tests/bake/meshes.h"
#include "tests/seeds.h"

namespace relief::test {
namespace {

TEST(AreaTable, FindsTrianglesByAreaFraction) {
    std::mt19937_64 random(seedFrom(1));
    for (const TriangleMesh& mesh : {makeBoxMesh({0, 0, 0}, {1, 2, 3}), makeTorusMesh(1.0, 0.3, 60, 41)}) {
        const AreaTable areas(mesh);
        std::vector<double> up_to;
        double sum = 0.0;
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            const glm::dvec3 normal = planeOf(mesh, i).normal;
            up_to.push_back(sum += std::sqrt(dot(normal, normal)));
        }
        for (int repeat = 0; repeat < 3000; ++repeat) {
            const double share = repeat == 0   ? 0.0
                                 : repeat == 1 ? 1.0
                                               : std::uniform_real_distribution(0.0, 1.0)(random);
            std::uint32_t expected = 0;
            while (expected + 1 < up_to.size() && !(up_to[expected] > share * sum)) {
                ++expected;
            }
            ASSERT_EQ(areas.triangleAt(share), expected) << share;
        }
    }
}

}  // namespace
}  // namespace relief::test
