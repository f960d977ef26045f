// SPDX-License-Identifier: Apache-2.0
// What rows will take is known before a ray is traced: never less than what the baked maps have, and hardly more.
#include "bake/plan/silhouette.h"

#include "bake/pipeline/bake.h"
#include "formats/row_spans.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

/// Checks it against a bake of this view.
void expectTold(const TriangleMesh& mesh, const std::string& text) {
    const MapSpec spec = required(parseMapSpec(text));
    const DepthMap map = bakeMaps(mesh, {spec}).maps[0];
    const Silhouette silhouette(mesh, *makeView(spec, mesh));
    EXPECT_LE(gpuBytes(map), silhouette.gpuBytes(map.width, map.height)) << text;
    // Two texels a row at most: where an edge touches one that no ray meets.
    EXPECT_GE(gpuBytes(map) + 2 * texelSize(map.format) * map.height,
              silhouette.gpuBytes(map.width, map.height))
        << text;
}

TEST(Silhouette, TellsWhatTheRowsOfABakedMapTake) {
    const std::vector<TriangleMesh> meshes = {makeTorusMesh(1.0, 0.4, 64, 32),
                                              makeIcosphere({0.1, 0.2, 0.3}, 1.0, 3),
                                              makeBoxMesh({0, 0, 0}, {1, 2, 3})};
    for (const TriangleMesh& mesh : meshes) {
        for (const char* direction : {"-z", "1/2/3"}) {
            for (const char* size : {"3x3", "5x40", "40x40", "101x37"}) {
                expectTold(mesh, std::string("front-back:dir=") + direction + ",size=" + size);
            }
        }
    }
    expectTold(meshes[0], "front-back:dir=1/2/3,size=5x1100");
}

}  // namespace
}  // namespace relief::test
