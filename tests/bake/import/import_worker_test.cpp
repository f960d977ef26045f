// Hostile meshes through the worker: right, or refused with one clear line; and nothing outside the folder is
// opened. What needs real limits of memory is in tests/cli/import.sh: the address sanitizer knows none.
#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "bake/import/mesh_import.h"
#include "formats/base/hash.h"
#include "tests/bake/import/import_meshes.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

/// Tells whether a file was opened by anybody: the kernel's word, not ours.
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

void expectRefused(const Result<TriangleMesh>& mesh, ErrorCode code, const std::string& says) {
    ASSERT_FALSE(mesh) << mesh->name << ": " << says;
    EXPECT_EQ(mesh.error().code, code) << mesh.error().message;
    EXPECT_NE(mesh.error().message.find(says), std::string::npos) << mesh.error().message;
    EXPECT_NE(mesh.error().message.find(';'), std::string::npos) << "no cure: " << mesh.error().message;
    EXPECT_EQ(mesh.error().message.find('\n'), std::string::npos);
}

bool warns(const TriangleMesh& mesh, const std::string& says) {
    for (const std::string& warning : mesh.warnings) {
        if (warning.find(says) != std::string::npos) {
            return true;
        }
    }
    return false;
}

TEST(ImportWorker, GivesTheSameMeshAsTheImporterInThisProcess) {
    const TemporaryFolder folder;
    for (const fs::path& path :
         {fs::path("/usr/share/glmark2/models/bunny.obj"), folder.write("t.gltf", tetrahedronGltf()),
          folder.write("T.DAE", tetrahedronDae("<unit meter=\"0.0254\"/><up_axis>Z_UP</up_axis>"))}) {
        SCOPED_TRACE(path);
        const Result<TriangleMesh> here = importMesh(path, {"", UpAxis::kPlusX});
        const Result<TriangleMesh> there = importMeshInWorker(path, {"", UpAxis::kPlusX});
        ASSERT_TRUE(here && there) << (here ? there : here).error().message;
        EXPECT_EQ(there->positions, here->positions);
        EXPECT_EQ(there->triangles, here->triangles);
        EXPECT_EQ(there->name, here->name);
        EXPECT_EQ(there->content_hash, here->content_hash);
        EXPECT_EQ(there->unit, here->unit);
        EXPECT_EQ(there->warnings, here->warnings);
        EXPECT_EQ(there->dependencies, here->dependencies);
        EXPECT_EQ(there->bounds, here->bounds);
    }
}

TEST(ImportWorker, FilesThatAreNotThereOrNoMeshes) {
    const TemporaryFolder folder;
    const auto codeOf = [](const Result<TriangleMesh>& mesh) { return mesh.error().code; };
    EXPECT_EQ(codeOf(importMeshInWorker(folder.path() / "missing.obj")), ErrorCode::kIo);
    EXPECT_EQ(codeOf(importMeshInWorker(folder.path())), ErrorCode::kIo);
    EXPECT_EQ(codeOf(load(folder, "mesh.xyzzy", "hello")), ErrorCode::kUnsupported);
    EXPECT_EQ(codeOf(load(folder, "empty.obj", "")), ErrorCode::kInvalidInput);
    EXPECT_EQ(codeOf(load(folder, "lines.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n")), ErrorCode::kInvalidInput);
    EXPECT_EQ(codeOf(load(folder, "nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")),
              ErrorCode::kInvalidInput);
}

TEST(ImportWorker, MaterialsBesideAreReadAndRecorded) {
    const TemporaryFolder folder;
    fs::create_directory(folder.path() / "sub");
    folder.write("z.mtl", "newmtl z\n");
    folder.write("sub/a.mtl", "newmtl a\n");
    const Result<TriangleMesh> mesh =
        load(folder, "t.obj", "mtllib z.mtl\nmtllib sub/a.mtl\n" + tetrahedronObj());
    ASSERT_TRUE(mesh) << mesh.error().message;
    const std::vector<std::string> files = {folder.path() / "t.obj", folder.path() / "sub/a.mtl",
                                            folder.path() / "z.mtl"};
    EXPECT_EQ(mesh->dependencies, files);
    ASSERT_EQ(mesh->dependency_hashes.size(), 3U);
    EXPECT_EQ(mesh->dependency_hashes[0], mesh->content_hash);
    constexpr std::string_view kText = "newmtl z\n";
    EXPECT_EQ(mesh->dependency_hashes[2], xxh3_128Hex(std::as_bytes(std::span(kText.data(), kText.size()))));
}

TEST(ImportWorker, NoFileOutsideTheFolderIsOpened) {
    const TemporaryFolder folder;
    fs::create_directory(folder.path() / "in");
    const fs::path secret = folder.write("secret.mtl", "newmtl secret\n");
    fs::create_symlink(secret, folder.path() / "in/link.mtl");
    fs::create_directory_symlink(folder.path(), folder.path() / "in/up");
    const OpenWatch watch(secret);
    ASSERT_TRUE(watch.works());
    for (const std::string& name :
         {std::string("../secret.mtl"), secret.string(), std::string("./../secret.mtl"),
          std::string("link.mtl"), std::string("up/secret.mtl"), std::string("..\\secret.mtl")}) {
        SCOPED_TRACE(name);
        const Result<TriangleMesh> mesh =
            load(folder, "in/t.obj", "mtllib " + name + "\nusemtl secret\n" + tetrahedronObj());
        // A material library is of no use here: a warning, and the mesh.
        ASSERT_TRUE(mesh) << mesh.error().message;
        EXPECT_TRUE(warns(*mesh, "left out '"));
        EXPECT_EQ(mesh->dependencies.size(), 1U);
        EXPECT_FALSE(watch.opened());
    }
    // The watch sees what it should.
    folder.write("in/t.obj", "mtllib secret.mtl\n" + tetrahedronObj());
    fs::create_hard_link(secret, folder.path() / "in/secret.mtl");
    EXPECT_TRUE(importMeshInWorker(folder.path() / "in/t.obj"));
    EXPECT_TRUE(watch.opened());
}

TEST(ImportWorker, BuffersOfGltfStayBelowTheFolder) {
    const TemporaryFolder folder;
    fs::create_directory(folder.path() / "in");
    const fs::path outside = folder.write("outside.bin", tetrahedronBuffer());
    folder.write("in/inside.bin", tetrahedronBuffer());
    fs::create_symlink(outside, folder.path() / "in/link.bin");
    ASSERT_EQ(::mkfifo((folder.path() / "in/pipe.bin").c_str(), 0600), 0);
    const auto with = [&](const std::string& uri) {
        GltfParts parts;
        parts.uri = uri;
        return load(folder, "in/t.gltf", tetrahedronGltf(parts));
    };
    const Result<TriangleMesh> mesh = with("inside.bin");
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->dependencies.back(), folder.path() / "in/inside.bin");
    const OpenWatch watch(outside);
    for (const std::string& uri :
         {std::string("../outside.bin"), outside.string(), "file://" + outside.string(),
          std::string("/etc/passwd"), std::string("link.bin"), std::string("pipe.bin"),
          std::string("missing.bin")}) {
        SCOPED_TRACE(uri);
        expectRefused(with(uri), ErrorCode::kInvalidInput, "t.gltf");
    }
    EXPECT_FALSE(watch.opened());
    expectRefused(with("../outside.bin"), ErrorCode::kInvalidInput, "below the mesh's folder");
    expectRefused(with("pipe.bin"), ErrorCode::kInvalidInput, "pipe.bin");
}

TEST(ImportWorker, GltfThatIsNotReadIsRefused) {
    const TemporaryFolder folder;
    const auto refused = [&](const GltfParts& parts, ErrorCode code, const std::string& says) {
        SCOPED_TRACE(says);
        expectRefused(load(folder, "t.gltf", tetrahedronGltf(parts)), code, says);
    };
    constexpr ErrorCode kUnread = ErrorCode::kUnsupported;
    constexpr ErrorCode kWrong = ErrorCode::kInvalidInput;
    for (const char* name : {"KHR_meshopt_compression", "KHR_draco_mesh_compression", "VENDOR_unheard_of"}) {
        refused({.more = std::string(R"("extensionsRequired":[")") + name + "\"],"}, kUnread, name);
    }
    refused({.position = R"("bufferView":0,"componentType":5125,"count":4,"type":"VEC3")"}, kUnread, "5125");
    refused(
        {.position = R"("bufferView":0,"componentType":5126,"count":4,"type":"VEC3","sparse":{"count":1})"},
        kWrong, "accessors[0].sparse");
    refused({.position = R"("componentType":5126,"count":4,"type":"VEC3")"}, kUnread, "no data");
    refused({.position = R"("bufferView":0,"componentType":5126,"count":4,"type":"VEC2")"}, kWrong, "VEC3");
    refused({.position = R"("bufferView":0,"componentType":5126,"count":5,"type":"VEC3")"}, kWrong,
            "ends behind");
    refused({.position = R"("bufferView":0,"componentType":5126,"count":9007199254740991,"type":"VEC3")"},
            kWrong, "ends behind");
    refused({.position = R"("bufferView":0,"componentType":5126,"count":-4,"type":"VEC3")"}, kWrong, "count");
    refused({.position = R"("bufferView":9,"componentType":5126,"count":4,"type":"VEC3")"}, kWrong,
            "bufferViews[9]");
    refused({.indices = R"("bufferView":1,"componentType":5125,"count":12,"type":"SCALAR")"}, kWrong,
            "ends behind");
    refused({.primitive = R"("attributes":{"POSITION":7})"}, kWrong, "accessors[7]");
    refused({.nodes = R"({"mesh":0,"children":[0]})"}, kWrong, "");
    refused({.nodes = R"({"children":[1]},{"children":[2]},{"children":[1],"mesh":0})"}, kWrong,
            "two parents");
    refused({.nodes = R"({"mesh":0},{"children":[2]},{"children":[1]})"}, kWrong, "own parents");
    refused({.nodes = R"({"mesh":0,"children":[5]})"}, kWrong, "child");
    refused({.roots = "0,0"}, kWrong, "twice");
    refused({.nodes = R"({"children":[1]},{"mesh":0})", .roots = "0,1"}, kWrong, "parent");
    // What is only used, and not required, does not stop it.
    EXPECT_TRUE(
        load(folder, "t.gltf", tetrahedronGltf({.more = R"("extensionsUsed":["KHR_mesh_quantization"],)"})));
    EXPECT_TRUE(load(folder, "t.gltf",
                     tetrahedronGltf({.more = R"("extensionsRequired":["KHR_materials_unlit"],)"})));
}

TEST(ImportWorker, AGraphOfNodesThatUnfoldsExponentiallyIsRefused) {
    const TemporaryFolder folder;
    GltfParts parts;
    parts.nodes.clear();
    for (int i = 0; i < 40; ++i) {  // a kilobyte; 2⁴⁰ instances
        const std::string next = std::to_string(i + 1);
        parts.nodes += R"({"children":[)" + next + "," + next + "]},";
    }
    parts.nodes += R"({"mesh":0})";
    expectRefused(load(folder, "dag.gltf", tetrahedronGltf(parts)), ErrorCode::kInvalidInput, "two parents");
}

TEST(ImportWorker, DeepJsonIsRefused) {
    const TemporaryFolder folder;
    for (const char* bracket : {"[", "{\"a\":"}) {
        std::string deep;
        for (int i = 0; i < 100000; ++i) {
            deep += bracket;
        }
        expectRefused(load(folder, "deep.gltf", deep), ErrorCode::kLimit, "deep");
    }
    // Brackets in strings are no depth.
    EXPECT_TRUE(load(folder, "t.gltf",
                     tetrahedronGltf({.more = "\"extras\":\"\\\"" + std::string(1000, '[') + "\","})));
}

TEST(ImportWorker, IndicesAndCountsOfOtherFormats) {
    const TemporaryFolder folder;
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
    for (const char* face : {"3 0 1 3\n", "3 0 1 -1\n", "3 0 1 2147483647\n", "4 0 1 2 99\n"}) {
        SCOPED_TRACE(face);
        expectRefused(load(folder, "index.ply", head + face), ErrorCode::kInvalidInput, "index.ply");
    }
    expectRefused(load(folder, "index.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"),
                  ErrorCode::kInvalidInput, "index.off");
}

TEST(ImportWorker, MirroredFlatSkinnedAndMorphed) {
    const TemporaryFolder folder;
    const Result<TriangleMesh> mirrored =
        load(folder, "m.gltf", tetrahedronGltf({.nodes = R"({"mesh":0,"scale":[-1,1,1]})"}));
    ASSERT_TRUE(mirrored);
    EXPECT_EQ(mirrored->bounds.min, glm::vec3(-1, 0, 0));
    EXPECT_TRUE(mirrored->warnings.empty());
    const Result<TriangleMesh> flat =
        load(folder, "f.gltf",
             tetrahedronGltf({.nodes = R"({"mesh":0},{"mesh":0,"scale":[1,0,1]},{"mesh":0,"scale":[0,0,0]})",
                              .roots = "0,1,2"}));
    ASSERT_TRUE(flat);
    EXPECT_TRUE(warns(*flat, "2 of its parts are scaled to nothing"));
    expectRefused(load(folder, "z.gltf", tetrahedronGltf({.nodes = R"({"mesh":0,"scale":[0,0,0]})"})),
                  ErrorCode::kInvalidInput, "z.gltf");
    const Result<TriangleMesh> morphed =
        load(folder, "t.gltf",
             tetrahedronGltf(
                 {.primitive = R"("attributes":{"POSITION":0},"indices":1,"targets":[{"POSITION":0}])"}));
    ASSERT_TRUE(morphed) << morphed.error().message;
    EXPECT_TRUE(warns(*morphed, "morphed"));
    EXPECT_EQ(morphed->bounds.max, glm::vec3(1, 2, 3));
}

TEST(ImportWorker, StripsAndFansAreTriangles) {
    const TemporaryFolder folder;
    const auto count = [&](int mode) {
        const Result<TriangleMesh> mesh = load(
            folder, "t.gltf",
            tetrahedronGltf({.primitive = R"("attributes":{"POSITION":0},"mode":)" + std::to_string(mode)}));
        return mesh ? mesh->triangles.size() : 0;
    };
    EXPECT_EQ(count(5), 2U);
    EXPECT_EQ(count(6), 2U);
    EXPECT_EQ(count(0), 0U);
}

TEST(ImportWorker, LeavesNoDescriptorsAndNoChildren) {
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

TEST(ImportWorker, EveryModelOfThePackageIsReadOrRefused) {
    // Every seventh, and all invalid ones; scripts/nightly.sh import takes all. Nothing may crash the worker.
    const bool all = std::getenv("RELIEF_SOAK") != nullptr;
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator("/usr/share/assimp/models")) {
        if (entry.is_regular_file()) {
            files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    ASSERT_GT(files.size(), 400U) << "the package assimp-testmodels is not there";
    std::size_t tried = 0;
    std::size_t read = 0;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const bool invalid = files[i].parent_path().filename() == "invalid";
#ifdef RELIEF_SANITIZED
        // The address sanitizer ends a process that asks for too much.
        if (files[i].filename() == "OutOfMemory.off") {
            continue;
        }
#endif
        if (!all && !invalid && i % 7 != 0) {
            continue;
        }
        const Result<TriangleMesh> mesh = importMeshInWorker(files[i], {}, {2'000'000'000, 60});
        ++tried;
        if (mesh) {
            ++read;
            continue;
        }
        const Error& error = mesh.error();
        const bool clean = error.code == ErrorCode::kInvalidInput || error.code == ErrorCode::kUnsupported ||
                           error.code == ErrorCode::kLimit;
        EXPECT_TRUE(clean) << error.message;
        EXPECT_EQ(error.message.find("crashed"), std::string::npos) << error.message;
        EXPECT_EQ(error.message.find("exit code"), std::string::npos) << error.message;
        EXPECT_EQ(error.message.find('\n'), std::string::npos) << error.message;
        EXPECT_NE(error.message.find(';'), std::string::npos) << "no cure: " << error.message;
    }
    RecordProperty("tried", static_cast<int>(tried));
    RecordProperty("read", static_cast<int>(read));
    EXPECT_GT(tried, all ? 400U : 60U);
    EXPECT_GT(4 * read, tried) << "hardly any is read";
}

TEST(ImportWorker, LimitsMustBeLimits) {
    const TemporaryFolder folder;
    const fs::path path = folder.write("t.obj", tetrahedronObj());
    for (const ImportLimits& limits : {ImportLimits{0, 60}, ImportLimits{1000000, 0}}) {
        const Result<TriangleMesh> mesh = importMeshInWorker(path, {}, limits);
        ASSERT_FALSE(mesh);
        EXPECT_EQ(mesh.error().code, ErrorCode::kUsage);
    }
}

}  // namespace
}  // namespace relief::test
