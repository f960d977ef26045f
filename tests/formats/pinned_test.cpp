// SPDX-License-Identifier: Apache-2.0
// Containers of every version that has been written, as bytes: each must be read as on the day that it was written.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iomanip>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "formats/base/text.h"
#include "formats/container.h"

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

/// "name 1 2 3"
void addLine(std::ostream& text, const char* name, std::initializer_list<float> values) {
    text << name;
    for (const float value : values) {
        text << ' ' << value;
    }
    text << '\n';
}

void addMaterials(std::ostream& text, const Materials& materials) {
    for (const Material& one : materials.list) {
        text << "material '" << one.name << "' " << shortest(one.restitution) << ' ' << shortest(one.friction)
             << ' ' << shortest(one.lifetime_loss) << ' ' << shortest(one.area_share) << '\n';
    }
    const glm::vec3& origin = materials.origin;
    addLine(text, "materials_origin", {origin.x, origin.y, origin.z});
    text << "materials_size " << shortest(materials.size) << '\n';
    for (const MaterialSides& pair : materials.sides) {
        text << "sides " << int{pair.axis} << ' ' << int{pair.towards} << ' ' << int{pair.against} << '\n';
    }
    for (const MaterialNode& node : materials.nodes) {
        text << "node " << node.head;
        for (const std::uint8_t leaf : node.leaves) {
            text << ' ' << int{leaf};
        }
        text << '\n';
    }
}

void addMap(std::ostream& text, const DepthMap& map) {
    text << "map format " << static_cast<int>(map.format) << " compare " << compareName(map.compare)
         << " decode " << decodeName(map.decode) << " size " << map.width << ' ' << map.height << " encloses "
         << map.encloses << " empty_is_outside " << map.empty_is_outside << '\n';
    for (const glm::vec4& row : map.object_to_map.row) {
        addLine(text, "object_to_map", {row.x, row.y, row.z, row.w});
    }
    addLine(text, "object_per_map", {map.object_per_map.x, map.object_per_map.y, map.object_per_map.z});
    for (std::uint32_t row = 0; row < map.faceCount() * map.height; ++row) {
        const std::uint32_t face = row / map.height;
        text << "texels " << face << ' ' << row % map.height << std::hex << std::setfill('0');
        for (std::uint32_t x = 0; x < map.width; ++x) {
            text << ' ';
            for (const std::byte byte : map.texelAt(face, x, row % map.height)) {
                text << std::setw(2) << std::to_integer<unsigned>(byte);
            }
        }
        text << std::dec << '\n';
    }
}

void addAnswer(std::ostream& text, const Collider& collider, const glm::vec3& p) {
    const FieldSample sample = evaluate(collider, p);
    const InsideSample inside = evaluateInside(collider, p);
    text << "at " << p.x << ' ' << p.y << ' ' << p.z << " map " << sample.map << " distance "
         << (sample.map < 0 ? 0.0F : sample.distance) << " normal " << sample.normal.x << ' '
         << sample.normal.y << ' ' << sample.normal.z << " inside " << inside.inside << " by " << inside.map
         << '\n';
    if (!collider.materials.empty()) {
        text << "material " << materialAt(collider.materials, p, p) << '\n';
    }
}

/// Every number of a collider, its texels in hexadecimal, row by row; and what it says of points in and about its bounds.
/// Floats have nine digits, by which they are read back exactly.
std::string pinnedText(const Collider& collider) {
    const Provenance& from = collider.provenance;
    const Bounds& bounds = collider.bounds;
    std::ostringstream text;
    text << std::setprecision(9) << "unit '" << collider.unit << "'\nmesh '" << from.mesh_name << "' "
         << from.mesh_hash << " of " << from.triangles << " triangles\nby '" << from.tool_version << "' '"
         << from.optionsText() << "'\n";
    addLine(text, "bounds_min", {bounds.min.x, bounds.min.y, bounds.min.z});
    addLine(text, "bounds_max", {bounds.max.x, bounds.max.y, bounds.max.z});
    if (!collider.materials.empty()) {
        addMaterials(text, collider.materials);
    }
    for (const DepthMap& map : collider.maps) {
        addMap(text, map);
    }
    std::uint32_t state = 1;
    for (int i = 0; i < 64; ++i) {
        glm::vec3 p{0.0F};
        for (int axis = 0; axis < 3; ++axis) {
            state = state * 1664525U + 1013904223U;
            // In the bounds, made larger by a quarter on every side; 16 bits are exact in a float.
            const float share = 1.5F * (static_cast<float>(state >> 16U) / 65536.0F) - 0.25F;
            p[axis] = bounds.min[axis] + share * bounds.size()[axis];
        }
        addAnswer(text, collider, p);
    }
    return text.str();
}

TEST(PinnedContainers, SayWhatTheySaid) {
    EXPECT_EQ(containers().size(), 16U) << "none is removed";
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
