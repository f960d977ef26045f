// SPDX-License-Identifier: Apache-2.0
// Compares the worked example of formats/README.md with the code: the page is normative, so it must not drift.
#include <gtest/gtest.h>

#include <cstdio>
#include <regex>
#include <sstream>
#include <string>

#include "formats/base/file_io.h"
#include "formats/container.h"
#include "formats/validate.h"
#include "tests/formats/sample_colliders.h"
#include "tests/results.h"

namespace relief {
namespace {

std::string readme() {
    const Result<std::vector<std::byte>> bytes = readFile(RELIEF_SOURCE_DIR "/formats/README.md");
    EXPECT_TRUE(bytes) << bytes.error().message;
    return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : std::string();
}

/// The bytes of all lines "offset  bytes  | words". Checks that the offsets are consecutive.
std::vector<std::byte> parseDump(const std::string& text) {
    const std::regex line_pattern("([0-9a-f]{4})  ((?:[0-9a-f]{2} ){1,32}) *\\| .*");
    std::vector<std::byte> bytes;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::smatch match;
        if (!std::regex_match(line, match, line_pattern)) {
            continue;
        }
        EXPECT_EQ(std::stoul(match[1], nullptr, 16), bytes.size()) << line;
        std::istringstream codes(match[2]);
        for (std::string code; codes >> code;) {
            bytes.push_back(static_cast<std::byte>(std::stoul(code, nullptr, 16)));
        }
    }
    return bytes;
}

TEST(Readme, HexdumpIsTheExampleContainer) {
    const std::vector<std::byte> bytes = parseDump(readme());
    EXPECT_EQ(bytes, test::written(test::readmeExample()));
    const Collider read = required(readContainer(bytes));
    EXPECT_EQ(read, test::readmeExample());
}

TEST(Readme, ExampleVotesAreRight) {
    // "| (x, y, z) | … | distance |"; the last cell is "far outside" or a number.
    const std::regex row("\\| `\\(([-0-9.]+), ([-0-9.]+), ([-0-9.]+)\\)` \\|.*\\| ([^|]+) \\|");
    const std::string text = readme();
    int rows = 0;
    for (std::sregex_iterator match(text.begin(), text.end(), row), end; match != end; ++match) {
        const glm::vec3 p(std::stof((*match)[1]), std::stof((*match)[2]), std::stof((*match)[3]));
        const FieldSample sample = evaluate(test::readmeExample(), p);
        const std::string expected = (*match)[4];
        if (expected == "far outside") {
            EXPECT_EQ(sample.distance, kFarOutside) << match->str();
        } else {
            char got[32];
            std::snprintf(got, sizeof(got), "%.6f", static_cast<double>(sample.distance));
            EXPECT_EQ(got, expected) << match->str();
        }
        ++rows;
    }
    EXPECT_GE(rows, 4);
}

TEST(Readme, StatesTheLimits) {
    const std::string text = readme();
    const ContainerLimits limits;
    for (const std::string& words :
         {std::to_string(limits.maps) + " maps", std::to_string(limits.texel_bytes >> 30) + " GiB",
          std::to_string(kMapSizeMax) + " texels", std::to_string(kMeshNameMax) + " bytes"}) {
        EXPECT_NE(text.find(words), std::string::npos)
            << "formats/README.md does not contain \"" << words << "\"";
    }
}

}  // namespace
}  // namespace relief
