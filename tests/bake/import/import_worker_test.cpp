// SPDX-License-Identifier: Apache-2.0
// The worker imports hostile meshes correctly or rejects them with one clear message, and opens no file outside the
// folder. Tests of memory limits are in tests/cli/import.sh, because the address sanitizer has none. Also results that
// a compromised worker could send.
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>
#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <set>

#include "bake/import/import_protocol.h"
#include "bake/import/import_source.h"
#include "bake/import/mesh_import.h"
#include "formats/base/hash.h"
#include "tests/bake/import/import_meshes.h"
#include "tests/bake/meshes.h"
#include "tests/seeds.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

/// Reports whether any process opened a file, according to the kernel.
class OpenWatch {
  public:
    explicit OpenWatch(const fs::path& file)
        : watch_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)),
          added_(::inotify_add_watch(watch_, file.c_str(), IN_OPEN | IN_ACCESS)) {}
    OpenWatch(const OpenWatch&) = delete;
    OpenWatch& operator=(const OpenWatch&) = delete;
    ~OpenWatch() { ::close(watch_); }

    [[nodiscard]] bool works() const { return added_ >= 0; }
    [[nodiscard]] bool opened() const {
        std::array<char, 4096> events{};
        return ::read(watch_, events.data(), events.size()) > 0;
    }

  private:
    int watch_;
    int added_;
};

Result<TriangleMesh> load(const TemporaryFolder& folder, const std::string& name, std::string_view contents) {
    return importMeshInWorker(folder.write(name, contents));
}

TEST(ImportWorker, MatchesTheInProcessImporter) {
    const TemporaryFolder folder;
    for (const fs::path& path :
         {fs::path("/usr/share/glmark2/models/bunny.obj"), folder.write("t.gltf", tetrahedronGltf()),
          folder.write("T.DAE", tetrahedronDae("<unit meter=\"0.0254\"/><up_axis>Z_UP</up_axis>"))}) {
        SCOPED_TRACE(path);
        const TriangleMesh here = required(importMesh(path, {"", UpAxis::kPlusX}));
        const TriangleMesh there = required(importMeshInWorker(path, {"", UpAxis::kPlusX}));
        EXPECT_EQ(there.positions, here.positions);
        EXPECT_EQ(there.triangles, here.triangles);
        EXPECT_EQ(there.name, here.name);
        EXPECT_EQ(there.content_hash, here.content_hash);
        EXPECT_EQ(there.unit, here.unit);
        EXPECT_EQ(there.warnings, here.warnings);
        EXPECT_EQ(there.dependencies, here.dependencies);
        EXPECT_EQ(there.bounds, here.bounds);
    }
}

TEST(ImportWorker, MaterialLibrariesAreReadAndRecorded) {
    const TemporaryFolder folder;
    fs::create_directory(folder.path() / "sub");
    constexpr std::string_view kText = "newmtl z\n";
    folder.write("z.mtl", kText);
    folder.write("sub/a.mtl", "newmtl a\n");
    const TriangleMesh mesh =
        required(load(folder, "t.obj", "mtllib z.mtl\nmtllib sub/a.mtl\n" + tetrahedronObj()));
    ASSERT_EQ(mesh.dependencies.size(), 3U);
    EXPECT_EQ(mesh.dependencies[1], folder.path() / "sub/a.mtl");
    EXPECT_EQ(mesh.dependency_hashes[2], xxh3_128Hex(std::as_bytes(std::span(kText.data(), kText.size()))));
}

TEST(ImportWorker, NoFileOutsideTheFolderIsOpened) {
    const TemporaryFolder folder;
    fs::create_directory(folder.path() / "in");
    const fs::path secret = folder.write("secret.mtl", "newmtl secret\n");
    const fs::path buffer = folder.write("secret.bin", tetrahedronBuffer());
    fs::create_symlink(secret, folder.path() / "in/link.mtl");
    fs::create_symlink(buffer, folder.path() / "in/link.bin");
    fs::create_directory_symlink(folder.path(), folder.path() / "in/up");
    ASSERT_EQ(::mkfifo((folder.path() / "in/pipe.bin").c_str(), 0600), 0);
    const OpenWatch watch(secret);
    const OpenWatch watch_buffer(buffer);
    ASSERT_TRUE(watch.works() && watch_buffer.works());
    for (const std::string& name :
         {std::string("../secret.mtl"), secret.string(), std::string("./../secret.mtl"),
          std::string("link.mtl"), std::string("up/secret.mtl"), std::string("..\\secret.mtl")}) {
        SCOPED_TRACE(name);
        const TriangleMesh mesh =
            required(load(folder, "in/t.obj", "mtllib " + name + "\nusemtl secret\n" + tetrahedronObj()));
        // A material library is optional: the mesh is imported with a warning.
        EXPECT_TRUE(warns(mesh, "left out '"));
        EXPECT_EQ(mesh.dependencies.size(), 1U);
        EXPECT_FALSE(watch.opened());
    }
    for (const auto& [uri, words] :
         {std::pair<std::string, std::string>{"../secret.bin", "below the mesh's folder"},
          {buffer.string(), "below the mesh's folder"},
          {"file://" + buffer.string(), "t.gltf"},
          {"/dev/zero", "t.gltf"},
          {"link.bin", "t.gltf"},
          {"pipe.bin", "pipe.bin"},
          {"missing.bin", "missing.bin"}}) {
        SCOPED_TRACE(uri);
        expectRejected(load(folder, "in/t.gltf", tetrahedronGltf({.uri = uri})), words);
        EXPECT_FALSE(watch_buffer.opened());
    }
    // Check the watch itself.
    folder.write("in/t.obj", "mtllib secret.mtl\n" + tetrahedronObj());
    fs::create_hard_link(secret, folder.path() / "in/secret.mtl");
    EXPECT_TRUE(importMeshInWorker(folder.path() / "in/t.obj"));
    EXPECT_TRUE(watch.opened());
}

TEST(ImportWorker, DeepJsonIsRejected) {
    for (const char* bracket : {"[", "{\"a\":"}) {
        std::string deep;
        for (int i = 0; i < 100000; ++i) {
            deep += bracket;
        }
        expectRejected(importTextInWorker("deep.gltf", deep), "deep", ErrorCode::kLimit);
    }
    // Brackets in strings do not count as depth.
    EXPECT_TRUE(importTextInWorker(
        "t.gltf", tetrahedronGltf({.more = "\"extras\":\"\\\"" + std::string(1000, '[') + "\","})));
}

TEST(ImportWorker, LeaksNoDescriptorsOrChildren) {
    const TemporaryFolder folder;
    const auto open = [] {
        return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator());
    };
    const fs::path good = folder.write("t.obj", tetrahedronObj());
    const fs::path bad = folder.write("bad.ply", "ply\n");
    ASSERT_TRUE(importMeshInWorker(good));
    const auto before = open();
    for (int i = 0; i < 5; ++i) {
        EXPECT_TRUE(importMeshInWorker(good));
        EXPECT_FALSE(importMeshInWorker(bad));
    }
    EXPECT_EQ(open(), before);
    const fs::path children = "/proc/self/task/" + std::to_string(::getpid()) + "/children";
    std::string list;
    std::ifstream(children) >> list;
    EXPECT_EQ(list, "");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 2);
}

TEST(ImportWorker, EveryModelOfThePackageIsReadOrRejected) {
    // Every seventh model and all invalid ones; scripts/nightly.sh import tests all. The worker must not crash.
    const bool all = std::getenv("RELIEF_SOAK") != nullptr;
    std::set<fs::path> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator("/usr/share/assimp/models")) {
        if (entry.is_regular_file()) {
            files.insert(entry.path());
        }
    }
    ASSERT_GT(files.size(), 400U) << "the package assimp-testmodels is not installed";
    std::size_t tried = 0;
    std::size_t read = 0;
    std::size_t number = 0;
    for (const fs::path& file : files) {
        const bool invalid = file.parent_path().filename() == "invalid";
#ifdef RELIEF_SANITIZED
        // The address sanitizer kills processes that allocate too much.
        if (file.filename() == "OutOfMemory.off") {
            continue;
        }
#endif
        if (number++ % 7 != 0 && !all && !invalid) {
            continue;
        }
        const Result<TriangleMesh> mesh = importMeshInWorker(file, {}, {2'000'000'000, 60});
        ++tried;
        if (mesh) {
            ++read;
            continue;
        }
        const Error& error = mesh.error();
        EXPECT_TRUE(error.code == ErrorCode::kUnsupported || error.code == ErrorCode::kLimit ||
                    error.code == ErrorCode::kInvalidInput);
        expectFault(error, "", error.code);
        for (const char* words : {"crashed", "exit code"}) {
            EXPECT_EQ(error.message.find(words), std::string::npos) << error.message;
        }
    }
    RecordProperty("tried", static_cast<int>(tried));
    RecordProperty("read", static_cast<int>(read));
    EXPECT_GT(tried, all ? 400U : 60U);
    EXPECT_GT(4 * read, tried) << "too few models are read";
}

TEST(ImportWorker, TrianglesAreCountedBeforeAllocation) {
    const TemporaryFolder folder;
    const fs::path gltf = folder.write("i.gltf", manyNodes(100));
    const fs::path dae = folder.write("t.dae", tetrahedronDae(""));
    const auto with = [](const fs::path& file, std::uint64_t triangles) {
        return importMeshInWorker(file, {}, {.triangles = triangles});
    };
    EXPECT_TRUE(with(gltf, 400));
    expectRejected(with(gltf, 399), "more than 399 triangles", ErrorCode::kLimit);
    expectRejected(with(dae, 3), "more than 3 triangles", ErrorCode::kLimit);
    EXPECT_EQ(with(dae, 0).error().code, ErrorCode::kUsage);
    for (const ImportLimits& limits : {ImportLimits{0, 60}, ImportLimits{1000000, 0}}) {
        EXPECT_EQ(importMeshInWorker(dae, {}, limits).error().code, ErrorCode::kUsage);
    }
}

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

std::vector<std::byte> messageOf(const Result<TriangleMesh>& raw) {
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
        const TriangleMesh read = required(readImportMessage(messageOf(raw)));
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
        [](const TriangleMesh& lie) { return readImportMessage(messageOf(lie)).has_value(); });
    const Result<TriangleMesh> error =
        readImportMessage(messageOf(fail(ErrorCode::kLimit, "two\nlines \x1b")));
    ASSERT_FALSE(error);
    EXPECT_EQ(error.error().code, ErrorCode::kLimit);
    EXPECT_EQ(error.error().message.find_first_of("\n\x1b"), std::string::npos);
}

TEST(ImportMessage, TruncationsAndExtensionsAreRejected) {
    const std::vector<std::byte> whole = messageOf(rawTriangle());
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
    const std::vector<std::byte> whole = messageOf(rawTriangle());
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
