// SPDX-License-Identifier: Apache-2.0
// Results that a compromised worker could send.
#include "bake/import/import_message.h"

#include <cstring>
#include <limits>
#include <random>

#include "bake/import/import_source.h"
#include "tests/bake/import/import_meshes.h"
#include "tests/bake/meshes.h"
#include "tests/seeds.h"

namespace relief::test {
namespace {

constexpr std::size_t kNames = 2;  // number of requested names

TriangleMesh rawTriangle() {
    TriangleMesh raw;
    raw.unit = "m";
    raw.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    raw.triangles = {{0, 1, 2}};
    raw.marks = {2};
    raw.dependencies = {"b/x.mtl"};
    raw.dependency_hashes = {std::string(32, 'a')};
    raw.warnings = {"something"};
    raw.unused_vertices = 7;
    return raw;
}

std::vector<std::byte> bytesOf(const Result<TriangleMesh>& raw) {
    std::vector<std::byte> bytes(importMessageSize(raw));
    writeImportMessage(raw, bytes);
    return bytes;
}

TEST(ImportMessage, RoundTripsMeshesAndErrors) {
    TriangleMesh raw = rawTriangle();
    for (const bool labelled : {false, true}) {
        if (labelled) {
            raw.marks.clear();
            raw.surface_names = {{0, "hut", "wood"}, {1, "tower", ""}};
            raw.labels = {1};
        }
        const TriangleMesh read = required(readImportMessage(bytesOf(raw)));
        EXPECT_EQ(read.unit, raw.unit);
        EXPECT_EQ(read.positions, raw.positions);
        EXPECT_EQ(read.triangles, raw.triangles);
        EXPECT_EQ(read.marks, raw.marks);
        EXPECT_EQ(read.labels, raw.labels);
        EXPECT_EQ(read.surface_names, raw.surface_names);
        EXPECT_EQ(read.dependencies, raw.dependencies);
        EXPECT_EQ(read.dependency_hashes, raw.dependency_hashes);
        EXPECT_EQ(read.warnings, raw.warnings);
        EXPECT_EQ(read.unused_vertices, raw.unused_vertices);
    }
    expectInvalidRejected(
        raw,
        {
            [](TriangleMesh& lie) { lie.unused_vertices = std::numeric_limits<std::uint64_t>::max(); },
            [](TriangleMesh& lie) { lie.marks.resize(2, 1); },   // a mark without a triangle
            [](TriangleMesh& lie) { lie.labels = {2}; },         // a label without a name
            [](TriangleMesh& lie) { lie.labels.resize(2, 0); },  // a label without a triangle
        },
        [](const TriangleMesh& lie) { return readImportMessage(bytesOf(lie)).has_value(); });
    const Result<TriangleMesh> error = readImportMessage(bytesOf(fail(ErrorCode::kLimit, "two\nlines \x1b")));
    ASSERT_FALSE(error);
    EXPECT_EQ(error.error().code, ErrorCode::kLimit);
    EXPECT_EQ(error.error().message.find_first_of("\n\x1b"), std::string::npos);
}

TEST(ImportMessage, TruncationsAndExtensionsAreRejected) {
    const std::vector<std::byte> whole = bytesOf(rawTriangle());
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const std::vector<std::byte> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
        EXPECT_FALSE(readImportMessage(cut)) << size;
    }
    std::vector<std::byte> longer = whole;
    longer.emplace_back();
    EXPECT_FALSE(readImportMessage(longer));
}

TEST(ImportMessage, FlippedBitsAreSafe) {
    // Every result is a mesh that finishMesh() accepts, or an error. Sanitizers detect memory errors.
    const TemporaryFolder folder;
    const ImportSource source = required(ImportSource::open(folder.write("t.obj", tetrahedronObj())));
    const std::vector<std::byte> whole = bytesOf(rawTriangle());
    std::mt19937 random(seedFrom(5));
    int refused = 0;
    for (int i = 0; i < 20000; ++i) {
        std::vector<std::byte> bytes = whole;
        const std::uint32_t flips = 1 + random() % 4;
        for (std::uint32_t k = 0; k < flips; ++k) {
            bytes[random() % bytes.size()] ^= std::byte{static_cast<unsigned char>(1U << random() % 8)};
        }
        Result<TriangleMesh> raw = readImportMessage(bytes);
        if (raw) {
            raw = source.finish(std::move(*raw), kNames);
        }
        refused += raw ? 0 : 1;
    }
    EXPECT_GT(refused, 1000);
    EXPECT_LT(refused, 20000);
}

TEST(ImportSource, WorkerClaimsAreValidated) {
    const TemporaryFolder folder;
    const ImportSource source = required(ImportSource::open(folder.write("t.obj", tetrahedronObj())));
    expectInvalidRejected(
        rawTriangle(),
        {[](TriangleMesh& raw) { raw.unit = "parsec"; },
         [](TriangleMesh& raw) { raw.dependencies = {"/etc/passwd"}; },
         [](TriangleMesh& raw) { raw.dependencies = {"a/../../x"}; },
         [](TriangleMesh& raw) { raw.dependencies = {""}; },
         [](TriangleMesh& raw) { raw.dependencies = {std::string("a\0b", 3)}; },
         [](TriangleMesh& raw) { raw.dependencies.clear(); },
         [](TriangleMesh& raw) { raw.dependency_hashes = {"short"}; },
         [](TriangleMesh& raw) { raw.triangles[0].z = 3; }, [](TriangleMesh& raw) { raw.triangles.clear(); },
         [](TriangleMesh& raw) { raw.marks = {3}; }, [](TriangleMesh& raw) { raw.marks.clear(); },
         [](TriangleMesh& raw) { raw.positions[1].x = std::numeric_limits<float>::quiet_NaN(); }},
        [&](TriangleMesh raw) {
            const Result<TriangleMesh> mesh = source.finish(std::move(raw), kNames);
            EXPECT_TRUE(mesh || mesh.error().code == ErrorCode::kInvalidInput);
            EXPECT_TRUE(mesh || mesh.error().message.find("t.obj") != std::string::npos);
            return mesh.has_value();
        });
    EXPECT_FALSE(source.finish(rawTriangle())) << "marks that were not requested";
}

TEST(ImportSource, FileNamesAreOpenableAndSorted) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.write("t.obj", tetrahedronObj());
    const ImportSource source = required(ImportSource::open(path));
    TriangleMesh raw = rawTriangle();
    raw.dependencies = {"z.mtl", "a.mtl"};
    raw.dependency_hashes = {std::string(32, 'f'), std::string(32, '0')};
    const TriangleMesh mesh = required(source.finish(std::move(raw), kNames));
    using Words = std::vector<std::string>;
    EXPECT_EQ(mesh.dependencies, Words({path, folder.path() / "a.mtl", folder.path() / "z.mtl"}));
    EXPECT_EQ(mesh.dependency_hashes, Words({mesh.content_hash, std::string(32, '0'), std::string(32, 'f')}));
    EXPECT_EQ(mesh.warnings, std::vector<std::string>{"t.obj: something"});
}

}  // namespace
}  // namespace relief::test
