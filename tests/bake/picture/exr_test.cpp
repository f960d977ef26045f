// SPDX-License-Identifier: Apache-2.0
// Exported maps, read back by OpenEXR's own reader.
#include "bake/picture/exr.h"

#include <ImathMatrix.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <cmath>
#include <sstream>
#include <type_traits>

#include "bake/picture/map_image.h"
#include "formats/base/file_io.h"
#include "formats/patch_tree.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

template <class Value = float>
std::vector<Value> readChannel(Imf::InputFile& file, const char* name, int width, int height) {
    std::vector<Value> values(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    Imf::FrameBuffer buffer;
    buffer.insert(name, Imf::Slice(std::is_same_v<Value, float> ? Imf::FLOAT : Imf::UINT,
                                   reinterpret_cast<char*>(values.data()), sizeof(Value),
                                   sizeof(Value) * static_cast<std::size_t>(width)));
    file.setFrameBuffer(buffer);
    file.readPixels(0, height - 1);
    return values;
}

TEST(ExrExport, HoldsTheMapAndItsCamera) {
    const Collider collider = bakeSpecs(makeIcosphere({0.2, 0.1, -0.3}, 0.9, 3),
                                        {"front-back:dir=1/2/3,size=40x30", "cube:size=20", "float:size=16"});
    EXPECT_EQ(mapImageName(collider.maps[2], 2, 0), "map2_float.exr");
    EXPECT_EQ(mapImageName(collider.maps[1], 1, 5), "map1_cube_-z.exr");
    const TemporaryFolder folder;
    for (std::size_t i = 0; i < collider.maps.size(); ++i) {
        const DepthMap& map = collider.maps[i];
        for (std::uint32_t face = 0; face < map.faceCount(); ++face) {
            SCOPED_TRACE(mapImageName(map, i, face));
            const ExrImage image = mapImage(map, face, "m");
            const std::vector<std::byte> bytes = required(encodeExr(image));
            EXPECT_EQ(bytes, *encodeExr(image)) << "the same bytes each time";
            const std::filesystem::path path = folder.path() / mapImageName(map, i, face);
            ASSERT_TRUE(writeFile(path, bytes));

            Imf::InputFile file(path.c_str());
            EXPECT_FALSE(Imf::hasCapDate(file.header()));
            EXPECT_EQ(file.header().compression(), Imf::ZIP_COMPRESSION);
            ASSERT_TRUE(Imf::hasWorldToCamera(file.header()) && Imf::hasWorldToNDC(file.header()));
            EXPECT_EQ(file.header().typedAttribute<Imf::StringAttribute>("relief.format").value(),
                      mapFormatName(map.format));
            EXPECT_EQ(file.header().typedAttribute<Imf::StringAttribute>("relief.compare").value(),
                      compareName(map.compare));
            EXPECT_EQ(file.header().channels().findChannel("ZBack") != nullptr, i == 0);
            const Imath::M44f camera = Imf::worldToCamera(file.header());
            const Imath::M44f ndc = Imf::worldToNDC(file.header());

            const auto width = static_cast<int>(map.width);
            const auto height = static_cast<int>(map.height);
            const std::vector<float> z = readChannel(file, "Z", width, height);
            const std::vector<float> ny = readChannel(file, "N.Y", width, height);
            int hits = 0;
            for (std::uint32_t y = 0; y < map.height; ++y) {
                for (std::uint32_t x = 0; x < map.width; ++x) {
                    const bool cube = map.projection() == Projection::kCube;
                    const std::size_t pixel = std::size_t{cube ? y : map.height - 1 - y} * map.width + x;
                    const Texel texel = decodeTexel(map.format, map.texelAt(face, x, y));
                    if (!texel.front) {
                        ASSERT_TRUE(std::isinf(z[pixel]) && z[pixel] > 0.0F);
                        ASSERT_EQ(ny[pixel], 0.0F);
                        continue;
                    }
                    ++hits;
                    ASSERT_EQ(ny[pixel], texel.front->normal.y);
                    // The surface point of this texel, by the definition of the map …
                    glm::dvec3 in_map;
                    const double s = (x + 0.5) / map.width;
                    const double t = (y + 0.5) / map.height;
                    if (cube) {
                        const glm::dvec3 d =
                            cubeDirection({face, static_cast<float>(s), static_cast<float>(t)});
                        in_map =
                            double{texel.front->depth} * d / std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
                    } else {
                        in_map = {s, t, texel.front->depth};
                    }
                    glm::dvec3 p(0.0);
                    for (int k = 0; k < 3; ++k) {
                        const glm::dvec4 row = map.object_to_map.row[k];
                        const double square = row.x * row.x + row.y * row.y + row.z * row.z;
                        p += (in_map[k] - row.w) / square * glm::dvec3(row);
                    }
                    // … projects onto its own pixel, and lies as far from the camera as Z says.
                    const Imath::V3f world(static_cast<float>(p.x), static_cast<float>(p.y),
                                           static_cast<float>(p.z));
                    Imath::V3f at;
                    ndc.multVecMatrix(world, at);
                    ASSERT_NEAR(at.x * static_cast<float>(width),
                                static_cast<float>(pixel % map.width) + 0.5F, 2e-3);
                    ASSERT_NEAR(at.y * static_cast<float>(height),
                                static_cast<float>(pixel / map.width) + 0.5F, 2e-3);
                    Imath::V3f in_camera;
                    camera.multVecMatrix(world, in_camera);
                    ASSERT_GT(in_camera.z, 0.0F) << "in front of the camera";
                    ASSERT_NEAR(cube ? in_camera.length() : in_camera.z, z[pixel], 1e-4);
                }
            }
            EXPECT_GT(hits, 50);
        }
    }
}

// The words come back as they were: an image of floats, or rows from below, would change the tree.
TEST(ExrExport, HoldsTheTreeOfPatches) {
    const Collider collider = bakeSpecs(makeIcosphere({0.2, 0.1, -0.3}, 0.9, 3), {"patches:bytes=4kB"});
    const DepthMap& map = collider.maps.front();
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / mapImageName(map, 0, 0);
    EXPECT_EQ(path.filename(), "map0_patches.exr");
    const Result<std::vector<std::byte>> bytes = encodeExr(mapImage(map, 0, "m"));
    ASSERT_TRUE(bytes && writeFile(path, *bytes));

    Imf::InputFile file(path.c_str());
    const auto width = static_cast<int>(map.width);
    const auto height = static_cast<int>(map.height);
    ASSERT_EQ(file.header().dataWindow().max.x + 1, width);
    ASSERT_EQ(file.header().dataWindow().max.y + 1, height);
    ASSERT_EQ(file.header().channels().findChannel("low")->type, Imf::UINT);
    const auto low = readChannel<std::uint32_t>(file, "low", width, height);
    const auto high = readChannel<std::uint32_t>(file, "high", width, height);
    std::vector<std::byte> texels;
    for (std::size_t i = 0; i < low.size(); ++i) {
        appendPatchTexel(texels, {low[i], high[i]});
    }
    EXPECT_GT(texels.size(), 1000U);
    EXPECT_EQ(texels, map.texels);

    const auto text = [&](const char* name) {
        return file.header().typedAttribute<Imf::StringAttribute>(name).value();
    };
    EXPECT_EQ(text("relief.format"), "patches");
    const PatchTreeSize size = patchTreeSize(map.texels);
    EXPECT_EQ(text("relief.levels"), std::to_string(size.levels));
    std::istringstream roots(text("relief.roots"));
    std::istringstream place(text("relief.object_to_map"));
    for (int k = 0; k < 3; ++k) {
        std::uint32_t count = 0;
        roots >> count;
        EXPECT_EQ(count, size.roots[k]);
        for (int i = 0; i < 4; ++i) {
            float value = 0.0F;
            place >> value;
            EXPECT_EQ(value, map.object_to_map.row[k][i]);
        }
    }
}

}  // namespace
}  // namespace relief::test
