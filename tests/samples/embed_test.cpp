// The sample of embedding: it runs, and the README shows its lines.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

#include "formats/container.h"
#include "tests/runtime/collider/analytic_collider.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

class Embed : public testing::Test {
  protected:
    void SetUp() override {
        std::string pattern = (fs::temp_directory_path() / "relief_embed_XXXXXX").native();
        ASSERT_NE(mkdtemp(pattern.data()), nullptr);
        folder_ = pattern;
    }
    void TearDown() override { fs::remove_all(folder_); }

    /// Output and errors together, and the exit code.
    std::pair<std::string, int> run(const fs::path& collider) {
        const std::string command = "'" RELIEF_EMBED_SAMPLE "' '" + collider.native() + "' 2>&1";
        std::FILE* pipe = popen(command.c_str(), "r");
        std::string output;
        for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
            output.push_back(static_cast<char>(c));
        }
        const int status = pclose(pipe);
        return {output, WEXITSTATUS(status)};
    }

    fs::path folder_;
};

TEST_F(Embed, TheSampleDrawsAndKeepsTheState) {
    const fs::path file = folder_ / "sphere.relief";
    ASSERT_TRUE(saveCollider(file, analytic::frontBackCollider(analytic::sphere({0.0, 0.0, 0.0}, 0.5), 64)));
    const auto [output, code] = run(file);
    EXPECT_EQ(code, 0) << output;
    std::smatch found;
    ASSERT_TRUE(std::regex_match(
        output, found, std::regex("6000 particles after 1\\.00 s, ([0-9]+) colours, GL state as it was\n")))
        << output;
    EXPECT_GT(std::stoi(found[1]), 50) << "fewer colours show nothing";
}

TEST_F(Embed, AMissingColliderIsOneLine) {
    const auto [output, code] = run(folder_ / "missing.relief");
    EXPECT_EQ(code, 1);
    EXPECT_TRUE(output.starts_with("relief-embed-sample: error: cannot read ")) << output;
    EXPECT_EQ(std::count(output.begin(), output.end(), '\n'), 1) << output;
}

std::string read(const char* name) {
    std::ifstream file(fs::path(RELIEF_SOURCE_DIR) / name);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::string between(const std::string& text, const std::string& from, const std::string& to) {
    const std::size_t begin = text.find(from);
    const std::size_t end = begin == std::string::npos ? begin : text.find(to, begin + from.size());
    return end == std::string::npos ? "" : text.substr(begin + from.size(), end - begin - from.size());
}

TEST(EmbedReadme, ShowsTheLinesOfTheSample) {
    const std::string sample = between(read("samples/embed/embed.cpp"), "// [embed]\n", "// [/embed]\n");
    const std::string shown = between(read("runtime/README.md"), "\n```cpp\n", "```\n");
    ASSERT_GT(sample.size(), 500U);
    EXPECT_EQ(shown, sample);
}

}  // namespace
}  // namespace relief
