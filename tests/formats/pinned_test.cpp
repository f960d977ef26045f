// Containers of every version that has been written, as bytes: each must be read as on the day that it was written.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "formats/base/file_io.h"
#include "formats/container.h"
#include "tests/formats/pinned_text.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

fs::path folder() {
    return fs::path(RELIEF_SOURCE_DIR) / "tests/formats/pinned";
}

std::vector<fs::path> containers() {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder())) {
        if (entry.path().extension() == ".relief") {
            files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

/// "1.0-none-formats.relief": "formats"
std::string contentOf(const fs::path& file) {
    const std::string name = file.stem().string();
    return name.substr(name.rfind('-') + 1);
}

std::string contents(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(PinnedContainers, SayWhatTheySaid) {
    for (const fs::path& file : containers()) {
        SCOPED_TRACE(file.filename());
        const Result<Collider> collider = loadCollider(file);
        ASSERT_TRUE(collider) << collider.error().message;
        const std::string text = pinnedText(*collider);
        const fs::path pinned = folder() / (contentOf(file) + ".txt");
        if (const char* const target = std::getenv("RELIEF_PIN"); target != nullptr) {
            std::ofstream(fs::path(target) / pinned.filename(), std::ios::binary) << text;
        }
        const std::string expected = contents(pinned);
        ASSERT_FALSE(expected.empty()) << pinned << " is missing";
        // Line by line: a difference is then one line and not a page.
        std::size_t at = 0;
        std::size_t other = 0;
        while (at < text.size() && other < expected.size()) {
            const std::string line = text.substr(at, text.find('\n', at) - at);
            ASSERT_EQ(line, expected.substr(other, expected.find('\n', other) - other));
            at += line.size() + 1;
            other += line.size() + 1;
        }
        EXPECT_EQ(text.size(), expected.size());
    }
}

// Whoever removes one notices: every format with either decode, by every compression, in either version.
TEST(PinnedContainers, AreOfEveryKind) {
    std::map<std::string, std::set<std::string>> kinds;  // by version and compression
    for (const fs::path& file : containers()) {
        const Result<std::vector<std::byte>> bytes = readFile(file);
        ASSERT_TRUE(bytes);
        const Result<ContainerInfo> info = readContainerInfo(*bytes);
        const Result<Collider> collider = readContainer(*bytes);
        ASSERT_TRUE(info && collider);
        const std::string version = std::to_string(info->major) + "." + std::to_string(info->minor);
        EXPECT_TRUE(file.filename().string().starts_with(version + "-")) << file;
        for (std::size_t i = 0; i < collider->maps.size(); ++i) {
            const DepthMap& map = collider->maps[i];
            kinds[version + " " + packingName(info->payloads[i].packing)].insert(
                std::to_string(static_cast<int>(map.format)) + " " + decodeName(map.decode));
        }
    }
    EXPECT_EQ(kinds["1.0 none"].size(), 10U);
    EXPECT_EQ(kinds["1.0 zstd"].size(), 10U);
    EXPECT_EQ(kinds["1.1 rows"].size(), 4U);
    EXPECT_EQ(kinds["1.1 none"].size(), 6U);
    EXPECT_EQ(kinds["1.3 rows"].size(), 4U);
    EXPECT_EQ(kinds["1.3 none"].size(), 6U);
    EXPECT_EQ(kinds["1.6 rows"].size(), 1U);
    EXPECT_EQ(kinds.size(), 7U);
}

// What this version writes, it writes as ever: zstd's bytes depend on its own version.
TEST(PinnedContainers, AreWrittenAgainAsTheyWere) {
    std::size_t same = 0;
    for (const fs::path& file : containers()) {
        SCOPED_TRACE(file.filename());
        const std::string bytes = contents(file);
        const Result<Collider> collider = loadCollider(file);
        ASSERT_TRUE(collider);
        const Result<std::vector<std::byte>> written = writeContainer(*collider);
        ASSERT_TRUE(written);
        const Result<Collider> read = readContainer(*written);
        ASSERT_TRUE(read);
        EXPECT_EQ(*read, *collider);
        if (file.filename().string().starts_with("1.3-")) {
            EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), written->begin(), written->end(),
                                   [](char a, std::byte b) { return std::byte(a) == b; }));
            ++same;
        }
    }
    EXPECT_GE(same, 3U);
}

}  // namespace
}  // namespace relief::test
