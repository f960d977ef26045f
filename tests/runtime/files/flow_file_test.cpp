// Flows from files: EXR images and slices written by OpenEXR's own writer, raw volumes, and what hostile
// files are refused with.
#include "runtime/files/flow_file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>

#include "formats/base/file_io.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

class FlowFileTest : public testing::Test {
  protected:
    void SetUp() override {
        folder_ =
            fs::path(testing::TempDir()) /
            (std::string("relief_flow_") + testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    using Value = std::function<float(char channel, int x, int y)>;

    /// An image whose data window begins at `corner`; x and y count from its top left pixel.
    fs::path image(const std::string& name, int width, int height, const std::string& channels,
                   const Value& value, Imath::V2i corner = {0, 0}) const {
        const Imath::Box2i window(corner, {corner.x + width - 1, corner.y + height - 1});
        Imf::Header header(window, window);
        Imf::FrameBuffer frame;
        std::vector<std::vector<float>> planes;
        planes.reserve(channels.size());
        for (const char channel : channels) {
            header.channels().insert(std::string(1, channel), Imf::Channel(Imf::FLOAT));
            std::vector<float>& plane = planes.emplace_back();
            for (int y = 0; y < height; ++y) {
                for (int x = 0; x < width; ++x) {
                    plane.push_back(value(channel, x, y));
                }
            }
            const auto stride = static_cast<std::size_t>(width) * sizeof(float);
            frame.insert(std::string(1, channel),
                         Imf::Slice::Make(Imf::FLOAT, plane.data(), window, sizeof(float), stride));
        }
        const fs::path path = folder_ / name;
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(frame);
        file.writePixels(height);
        return path;
    }
    fs::path bytes(const std::string& name, const void* data, std::size_t size) const {
        const fs::path path = folder_ / name;
        std::ofstream(path, std::ios::binary)
            .write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
        return path;
    }
    [[nodiscard]] FlowFile file(FlowFileKind kind, const fs::path& path) const {
        FlowFile flow;
        flow.kind = kind;
        flow.path = path;
        flow.origin = "scene.toml:3:8: flow.x: ";
        return flow;
    }
    void expectError(const FlowFile& flow, ErrorCode code, const std::string& name,
                     const std::string& part) const {
        const auto loaded = loadFlow(flow);
        ASSERT_FALSE(loaded) << part;
        const std::string& message = loaded.error().message;
        EXPECT_EQ(loaded.error().code, code) << message;
        EXPECT_TRUE(message.starts_with(flow.origin)) << message;
        EXPECT_NE(message.find(name), std::string::npos) << "names no file: " << message;
        EXPECT_NE(message.find(part), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }

    fs::path folder_;
};

float pixel(char channel, int x, int y) {
    return static_cast<float>(100 * y + x) + (channel == 'R' ? 0.25F : (channel == 'G' ? 0.5F : 0.75F));
}

TEST_F(FlowFileTest, AnImageIsAFlowInXAndYWithItsBottomRowLowest) {
    for (const Imath::V2i& corner : {Imath::V2i(0, 0), Imath::V2i(-7, 1000)}) {
        for (const std::string channels : {"RG", "RGB", "ABGRZ"}) {
            FlowFile from = file(FlowFileKind::kImage, image("a.exr", 5, 3, channels, pixel, corner));
            from.gain = 2.0F;
            from.outside = FlowOutside::kEdge;
            const auto flow = loadFlow(from);
            ASSERT_TRUE(flow) << flow.error().message;
            EXPECT_EQ(flow->size, (std::array<std::uint32_t, 3>{5, 3, 1}));
            EXPECT_EQ(flow->gain, 2.0F);
            EXPECT_EQ(flow->outside, FlowOutside::kEdge);
            const bool blue = channels.find('B') != std::string::npos;
            for (int y = 0; y < 3; ++y) {
                for (int x = 0; x < 5; ++x) {
                    const glm::vec3 expected(pixel('R', x, 2 - y), pixel('G', x, 2 - y),
                                             blue ? pixel('B', x, 2 - y) : 0.0F);
                    ASSERT_EQ(flow->nodes[static_cast<std::size_t>(y * 5 + x)], expected) << x << " " << y;
                }
            }
            // The lowest corner of the box is the bottom left pixel, at any z.
            EXPECT_EQ(flowVelocity(*flow, {0.0F, 0.0F, 0.3F}), 2.0F * flow->nodes[0]);
        }
    }
}

TEST_F(FlowFileTest, SlicesAreStackedFromZeroOrOneUpAndNoneMayBeLost) {
    for (const int first : {0, 1}) {
        fs::remove_all(folder_);
        fs::create_directories(folder_);
        for (int z = 0; z < 12; ++z) {
            const std::string number = std::to_string(z + first);
            image("flow_" + std::string(3 - number.size(), '0') + number + ".exr", 4, 2, "RGB",
                  [&](char, int, int) { return static_cast<float>(z); });
        }
        const FlowFile from = file(FlowFileKind::kSlices, folder_ / "flow_%03d.exr");
        const auto flow = loadFlow(from);
        ASSERT_TRUE(flow) << flow.error().message;
        ASSERT_EQ(flow->size, (std::array<std::uint32_t, 3>{4, 2, 12}));
        const std::vector<fs::path> paths = flowPaths(from);
        ASSERT_EQ(paths.size(), 12U);
        EXPECT_EQ(paths.back(), folder_ / (first == 0 ? "flow_011.exr" : "flow_012.exr"));
        for (std::size_t i = 0; i < flow->nodes.size(); ++i) {
            ASSERT_EQ(flow->nodes[i], glm::vec3(static_cast<float>(i / 8)));
        }
        image("flow_005.exr", 4, 3, "RGB", pixel);
        expectError(from, ErrorCode::kInvalidInput, "flow_005.exr", "4x3 pixels");
        fs::remove(folder_ / "flow_005.exr");
        expectError(from, ErrorCode::kInvalidInput, "flow_005.exr", "missing");
    }
    expectError(file(FlowFileKind::kSlices, folder_ / "none_%d.exr"), ErrorCode::kIo, "none_1.exr",
                "neither");
    expectError(file(FlowFileKind::kSlices, folder_ / "none_%s.exr"), ErrorCode::kInvalidInput, "none_%s.exr",
                "number");
}

TEST_F(FlowFileTest, ANameHoldsOneNumberAndNothingElseOfPrintf) {
    for (const char* good : {"a%d", "%3d.exr", "a_%04d.exr", "%0d"}) {
        EXPECT_TRUE(hasSliceNumber(good)) << good;
    }
    for (const char* bad : {"a", "%s", "%n", "%d%d", "%d%s", "%12d", "%", "%0", "%%d%", "%-3d", "%ld"}) {
        EXPECT_FALSE(hasSliceNumber(bad)) << bad;
    }
}

TEST_F(FlowFileTest, ARawVolumeRunsAlongXFirst) {
    for (const std::uint32_t components : {2U, 3U}) {
        std::vector<float> values;
        for (std::uint32_t i = 0; i < 4 * 3 * 2 * components; ++i) {
            values.push_back(0.5F * static_cast<float>(i));
        }
        FlowFile from =
            file(FlowFileKind::kRaw, bytes("a.raw", values.data(), values.size() * sizeof(float)));
        from.size = {4, 3, 2};
        from.components = components;
        const auto flow = loadFlow(from);
        ASSERT_TRUE(flow) << flow.error().message;
        const std::uint32_t node = 1 + 4 * (2 + 3 * 1);
        EXPECT_EQ(flow->nodes.at(node), glm::vec3(values[node * components], values[node * components + 1],
                                                  components == 3 ? values[node * components + 2] : 0.0F));

        // A byte more, a byte less.
        values.push_back(0.0F);
        for (const std::size_t size :
             {values.size() * sizeof(float) - 3, values.size() * sizeof(float) - 5}) {
            from.path = bytes("b.raw", values.data(), size);
            expectError(from, ErrorCode::kInvalidInput, "b.raw", std::to_string(size) + " bytes");
        }
    }
}

TEST_F(FlowFileTest, VelocitiesMustBeFiniteAndNotAbsurd) {
    for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity(), -1.1e6F}) {
        float values[12] = {};
        values[10] = bad;  // y of node 3: x = 1, y = 1
        FlowFile from = file(FlowFileKind::kRaw, bytes("a.raw", values, sizeof(values)));
        from.size = {2, 2, 1};
        expectError(from, ErrorCode::kInvalidInput, "a.raw", "node 1, 1, 0");
        expectError(file(FlowFileKind::kImage, image("a.exr", 2, 2, "RG",
                                                     [&](char c, int x, int y) {
                                                         return c == 'G' && x == 1 && y == 1 ? bad : 0.0F;
                                                     })),
                    ErrorCode::kInvalidInput, "a.exr", "node 1, 0, 0");
    }
}

TEST_F(FlowFileTest, WrongAndHostileImagesAreRefused) {
    expectError(file(FlowFileKind::kImage, folder_ / "none.exr"), ErrorCode::kIo, "none.exr", "");
    const fs::path good = image("good.exr", 40, 30, "RGB", pixel);
    expectError(file(FlowFileKind::kImage, image("z.exr", 4, 4, "YZ", pixel)), ErrorCode::kInvalidInput,
                "z.exr", "channels R and G");
    expectError(file(FlowFileKind::kImage, image("wide.exr", 513, 2, "RG", pixel)), ErrorCode::kInvalidInput,
                "wide.exr", "512x512");
    const auto whole = readFile(good);
    ASSERT_TRUE(whole);
    // Cut anywhere: an error or, where only the tail of OpenEXR's padding is gone, the same flow; never a
    // crash.
    std::size_t refused = 0;
    for (std::size_t size = 0; size < whole->size(); size += 1 + size / 40) {
        refused += loadFlow(file(FlowFileKind::kImage, bytes("cut.exr", whole->data(), size))) ? 0U : 1U;
    }
    EXPECT_GT(refused, 100U);
    expectError(file(FlowFileKind::kImage, bytes("half.exr", whole->data(), whole->size() / 2)),
                ErrorCode::kInvalidInput, "half.exr", "no EXR image");
    // Any byte of the header turned over. Whatever comes of it is an answer.
    for (std::size_t at = 0; at < 400; ++at) {
        std::vector<std::byte> turned = *whole;
        turned[at] ^= std::byte{0xFF};
        static_cast<void>(
            loadFlow(file(FlowFileKind::kImage, bytes("turned.exr", turned.data(), turned.size()))));
    }
    EXPECT_TRUE(loadFlow(file(FlowFileKind::kImage, good)));
}

}  // namespace
}  // namespace relief
