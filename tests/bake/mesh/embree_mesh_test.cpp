// SPDX-License-Identifier: Apache-2.0
// As many meshes at once as a level can have. With one Embree device per mesh, the thousandth would fail.

#include <vector>

#include "bake/mesh/mesh_query.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

TEST(EmbreeMesh, ThousandsCoexist) {
    std::vector<MeshQuery> queries;
    for (int i = 0; i < 2500; ++i) {
        MeshQuery query =
            required(MeshQuery::build(PreparedMesh(makeIcosphere(glm::dvec3(double(i), 0.0, 0.0), 1.0, 0))));
        queries.push_back(std::move(query));
    }
    EXPECT_TRUE(queries[0].inside(glm::vec3(0.0F)));
    EXPECT_TRUE(queries[2499].inside(glm::vec3(2499.0F, 0.0F, 0.0F)));
    EXPECT_FALSE(queries[2499].inside(glm::vec3(0.0F)));
}

}  // namespace
}  // namespace relief::test
