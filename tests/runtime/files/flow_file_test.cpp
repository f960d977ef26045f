// SPDX-License-Identifier: Apache-2.0
// Flow files, and the errors of hostile ones.
#include "runtime/files/flow_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/results.h"
#include "tests/temporary_folder.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

class FlowFileTest : public testing::Test {
  protected:
    fs::path bytes(const std::string& name, const void* data, std::size_t size) const {
        return folder_.write(name, {static_cast<const char*>(data), size});
    }
    [[nodiscard]] FlowFile file(const fs::path& path) const {
        FlowFile flow;
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
        EXPECT_NE(message.find(name), std::string::npos) << "does not name the file: " << message;
        EXPECT_NE(message.find(part), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }

    const test::TemporaryFolder folder_;
};

TEST_F(FlowFileTest, RawVolumesRunAlongXFirst) {
    for (const std::uint32_t components : {2U, 3U}) {
        std::vector<float> values;
        for (std::uint32_t i = 0; i < 4 * 3 * 2 * components; ++i) {
            values.push_back(0.5F * static_cast<float>(i));
        }
        FlowFile from = file(bytes("a.raw", values.data(), values.size() * sizeof(float)));
        from.size = {4, 3, 2};
        from.components = components;
        const auto flow = required(loadFlow(from));
        const std::uint32_t node = 1 + 4 * (2 + 3 * 1);
        EXPECT_EQ(flow.nodes.at(node), glm::vec3(values[node * components], values[node * components + 1],
                                                 components == 3 ? values[node * components + 2] : 0.0F));

        // One byte too many, one too few.
        values.push_back(0.0F);
        for (const std::size_t size :
             {values.size() * sizeof(float) - 3, values.size() * sizeof(float) - 5}) {
            from.path = bytes("b.raw", values.data(), size);
            expectError(from, ErrorCode::kInvalidInput, "b.raw", std::to_string(size) + " bytes");
        }
    }
}

TEST_F(FlowFileTest, MissingFilesAreNamed) {
    FlowFile from = file(folder_.path() / "none.raw");
    from.size = {1, 1, 1};
    expectError(from, ErrorCode::kIo, "none.raw", "");
}

TEST_F(FlowFileTest, VelocitiesMustBeFiniteAndBounded) {
    for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity(), -1.1e6F}) {
        float values[12] = {};
        values[10] = bad;  // y of node 3: x = 1, y = 1
        FlowFile from = file(bytes("a.raw", values, sizeof(values)));
        from.size = {2, 2, 1};
        expectError(from, ErrorCode::kInvalidInput, "a.raw", "node 1, 1, 0");
    }
}

}  // namespace
}  // namespace relief
