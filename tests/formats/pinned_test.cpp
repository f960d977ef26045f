// SPDX-License-Identifier: Apache-2.0
// Pinned containers of version 2: each must read exactly as on the day it was written. pinned/CONTENT.txt describes
// VERSION-COMPRESSION-CONTENT.relief: all numbers of its maps, hashes of its texels, the field at points. Never change
// or remove a container; add some for each version that changes the bytes. With RELIEF_PIN=DIR, the test writes the
// texts and the uncompressed containers to DIR.
//
// Also the worked example of formats/README.md: the page is normative, so it must not drift.
#include <gtest/gtest.h>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iomanip>
#include <iterator>
#include <regex>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "formats/base/file_io.h"
#include "formats/base/hash.h"
#include "formats/base/text.h"
#include "formats/container.h"
#include "formats/validate.h"
#include "tests/formats/sample_colliders.h"
#include "tests/results.h"

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

/// "2.0-none-formats.relief": "formats"
std::string contentOf(const fs::path& file) {
    const std::string name = file.stem().string();
    return name.substr(name.rfind('-') + 1);
}

std::string contents(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void addNumbers(std::ostream& text, const char* name, std::initializer_list<glm::vec4> rows, int count) {
    text << name;
    for (const glm::vec4& row : rows) {
        for (int i = 0; i < count; ++i) {
            text << ' ' << row[i];
        }
    }
    text << '\n';
}

/// "name 0123456789abcdef": a hash of many bytes.
void addHash(std::ostream& text, const char* name, std::span<const std::byte> bytes) {
    text << name << ' ' << std::hex << std::setfill('0') << std::setw(16) << xxh3_64(bytes) << std::dec
         << '\n';
}

void addMaterials(std::ostream& text, const Materials& materials) {
    for (const Material& one : materials.list) {
        text << "material '" << one.name << "' " << shortest(one.restitution) << ' ' << shortest(one.friction)
             << ' ' << shortest(one.lifetime_loss) << ' ' << shortest(one.area_fraction) << '\n';
    }
    addNumbers(text, "materials_cube", {{materials.origin, materials.size}}, 4);
    text << "sides";
    for (const MaterialSides& pair : materials.sides) {
        text << ' ' << int{pair.axis} << '/' << int{pair.towards} << '/' << int{pair.against};
    }
    std::ostringstream nodes;
    for (const MaterialNode& node : materials.nodes) {
        nodes << node.head;
        for (const std::uint8_t leaf : node.leaves) {
            nodes << ' ' << int{leaf};
        }
        nodes << '\n';
    }
    addHash(text, "\nnodes", toBytes(nodes.str()));
}

void addMap(std::ostream& text, const DepthMap& map) {
    text << "map format " << static_cast<int>(map.format) << " compare " << compareName(map.compare)
         << " decode " << decodeName(map.decode) << " size " << map.width << ' ' << map.height << " encloses "
         << map.encloses << " empty_is_outside " << map.empty_is_outside;
    addHash(text, " texels", map.texels);
    const auto& row = map.object_to_map.row;
    addNumbers(text, "frame", {row[0], row[1], row[2], glm::vec4(map.object_per_map, 0)}, 4);
}

void addAnswer(std::ostream& text, const Collider& collider, const glm::vec3& p) {
    const FieldSample sample = evaluate(collider, p);
    const InsideSample inside = evaluateInside(collider, p);
    text << "at " << p.x << ' ' << p.y << ' ' << p.z << " map " << sample.map << " distance "
         << (sample.map < 0 ? 0.0F : sample.distance) << " normal " << sample.normal.x << ' '
         << sample.normal.y << ' ' << sample.normal.z << " inside " << inside.inside << " by " << inside.map;
    if (!collider.materials.empty()) {
        text << " material " << materialAt(collider.materials, p, p);
    }
    text << '\n';
}

/// Field samples of a collider at 64 points in and around its bounds: some as text, all as a hash.
void addAnswers(std::ostream& text, const Collider& collider) {
    const Bounds& bounds = collider.bounds;
    std::ostringstream all;
    all << std::setprecision(9);
    std::uint32_t state = 1;
    for (int i = 0; i < 64; ++i) {
        glm::vec3 p{0.0F};
        for (int axis = 0; axis < 3; ++axis) {
            state = state * 1664525U + 1013904223U;
            // Within the bounds enlarged by a quarter on each side; 16 bits are exact in a float.
            const float share = 1.5F * (static_cast<float>(state >> 16U) / 65536.0F) - 0.25F;
            p[axis] = bounds.min[axis] + share * bounds.size()[axis];
        }
        addAnswer(all, collider, p);
        if (i == 3) {
            text << all.str();
        }
    }
    addHash(text, "answers", toBytes(all.str()));
}

/// Every number of a collider, hashes of its texels and material nodes, and its field. Floats have nine digits, enough
/// to read them back exactly.
std::string pinnedText(const Collider& collider) {
    const Provenance& from = collider.provenance;
    std::ostringstream text;
    text << std::setprecision(9) << "unit '" << collider.unit << "'\nmesh '" << from.mesh_name << "' "
         << from.mesh_hash << " of " << from.triangles << " triangles\nby '" << from.tool_version << "' '"
         << from.optionsText() << "'\n";
    addNumbers(text, "bounds", {glm::vec4(collider.bounds.min, 0), glm::vec4(collider.bounds.max, 0)}, 3);
    if (!collider.materials.empty()) {
        addMaterials(text, collider.materials);
    }
    for (const DepthMap& map : collider.maps) {
        addMap(text, map);
    }
    addAnswers(text, collider);
    return text.str();
}

TEST(PinnedContainers, ReadAsBefore) {
    EXPECT_EQ(containers().size(), 8U) << "no pinned container may be removed";
    for (const fs::path& file : containers()) {
        SCOPED_TRACE(file.filename());
        const Collider collider = required(loadCollider(file));
        const std::string text = pinnedText(collider);
        const fs::path pinned = folder() / (contentOf(file) + ".txt");
        if (const char* const target = std::getenv("RELIEF_PIN"); target != nullptr) {
            std::ofstream(fs::path(target) / pinned.filename(), std::ios::binary) << text;
        }
        const std::string expected = contents(pinned);
        ASSERT_FALSE(expected.empty()) << pinned << " is missing";
        EXPECT_EQ(text, expected);
    }
}

// Uncompressed bytes never change; those of zstd depend on the version of zstd.
TEST(PinnedContainers, AreWrittenAsBefore) {
    std::size_t same = 0;
    for (const fs::path& file : containers()) {
        SCOPED_TRACE(file.filename());
        const std::string bytes = contents(file);
        const Collider collider = required(loadCollider(file));
        const std::vector<std::byte> written = required(writeContainer(collider));
        if (const char* const target = std::getenv("RELIEF_PIN"); target != nullptr) {
            ASSERT_TRUE(writeFile(fs::path(target) / ("2.0-none-" + contentOf(file) + ".relief"), written));
        }
        const Collider read = required(readContainer(written));
        EXPECT_EQ(read, collider);
        if (file.filename().string().starts_with("2.0-none-")) {
            EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), written.begin(), written.end(),
                                   [](char a, std::byte b) { return std::byte(a) == b; }));
            ++same;
        }
    }
    EXPECT_EQ(same, 6U);
}

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
}  // namespace relief::test
