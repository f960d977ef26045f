// SPDX-License-Identifier: Apache-2.0
// Encoded texels compared with encodeTexel() of formats/texel.h, which has its own tests.
#include "bake/named_maps/encode.h"

#include "bake/mesh/triangle_plane.h"
#include "bake/named_maps/scan_convert.h"
#include "bake/views/view.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

TEST(Encode, MatchesEncodeTexel) {
    const TriangleMesh mesh = makeIcosphere({0.1, 0.2, 0.3}, 0.7, 3);
    const RayScene scene = required(RayScene::build(mesh));
    for (const std::string text :
         {"float:size=40", "fixed8:size=40", "front-back:size=40,dir=1/1/1,depth=half",
          "front-back:size=40,dir=1/1/1,depth=unorm16", "cube:size=20"}) {
        const Result<MapSpec> spec = completeSpec(*parseMapSpec(text), mesh, 40);
        const View view = required(makeView(*spec, mesh));
        // The table of normals does not change a byte.
        for (const std::uint64_t texels : {std::uint64_t{0}, std::uint64_t{1} << 30}) {
            const NormalTable normals(mesh, scene.winding(), texels);
            DepthMap map = view.emptyMap();
            std::uint64_t covered = 0;
            std::uint64_t expected_covered = 0;
            for (std::uint32_t face = 0; face < view.faceCount(); ++face) {
                const RowRange rows{face, 0, view.height};
                std::vector<Hit> hits[2];
                for (const RayEnd end : {RayEnd::kNear, RayEnd::kFar}) {
                    if (view.keeps(end)) {
                        hits[static_cast<std::size_t>(end)].resize(std::size_t{view.width} * view.height);
                    }
                }
                ScanConverter(scene, view).scan(rows, hits[0], hits[1]);
                covered += encodeRows(scene, normals, view, rows, hits[0], hits[1], map);
                for (std::uint32_t y = 0; y < view.height; ++y) {
                    for (std::uint32_t x = 0; x < view.width; ++x) {
                        const auto surface = [&](const std::vector<Hit>& end) -> std::optional<Surface> {
                            if (end.empty() || end[std::size_t{y} * view.width + x].empty()) {
                                return std::nullopt;
                            }
                            const Hit& hit = end[std::size_t{y} * view.width + x];
                            const glm::dvec3 n = planeOf(mesh, hit.triangle()).normal;
                            const glm::vec3 unit = n / std::sqrt(dot(n, n));
                            return Surface{hit.depth(), (hit.fromBehind() ? -unit : unit) + 0.0F};
                        };
                        Texel texel{surface(hits[0]), surface(hits[1])};
                        if (view.compare == Compare::kGreater) {
                            texel.front = texel.back;
                        }
                        expected_covered += texel.front || texel.back ? 1 : 0;
                        std::vector<std::byte> expected(texelSize(view.format));
                        encodeTexel(view.format, texel, expected);
                        const std::span<const std::byte> written = map.texelAt(face, x, y);
                        ASSERT_TRUE(std::equal(written.begin(), written.end(), expected.begin()))
                            << text << " " << x << ", " << y;
                    }
                }
            }
            EXPECT_EQ(covered, expected_covered);
            EXPECT_GT(covered, 500U);
        }
    }
}

}  // namespace
}  // namespace relief::test
