#include "bake/cli/preflight.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

int codeOf(const Result<void>& result) {
    return result ? 0 : static_cast<int>(result.error().code);
}

TEST(Preflight, FindsOutputsThatCannotBeWritten) {
    const TemporaryFolder folder;
    EXPECT_EQ(codeOf(preflightFile(folder.path() / "new.relief")), 0);
    EXPECT_EQ(codeOf(preflightFile(folder.write("old.relief", "old"))), 0);
    EXPECT_EQ(codeOf(preflightFile("-")), 0);
    EXPECT_EQ(codeOf(preflightFile("/dev/null")), 0);
    EXPECT_EQ(codeOf(preflightFile("plain_name")), 0);
    EXPECT_EQ(codeOf(preflightFile("")), 2);
    EXPECT_EQ(codeOf(preflightFile(folder.path())), 2);
    EXPECT_EQ(codeOf(preflightFile(folder.path() / "missing" / "out.relief")), 2);
    EXPECT_EQ(codeOf(preflightFile(folder.path() / "old.relief" / "out.relief")), 2);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "new.relief")) << "it only looks";
    if (::geteuid() != 0) {  // root may write anywhere
        ASSERT_EQ(::chmod(folder.path().c_str(), 0500), 0);
        EXPECT_EQ(codeOf(preflightFile(folder.path() / "new.relief")), 2);
        ASSERT_EQ(::chmod(folder.path().c_str(), 0700), 0);
    }
}

TEST(Preflight, MakesFolders) {
    const TemporaryFolder folder;
    EXPECT_EQ(codeOf(preflightFolder(folder.path() / "a" / "b")), 0);
    EXPECT_TRUE(std::filesystem::is_directory(folder.path() / "a" / "b"));
    EXPECT_EQ(codeOf(preflightFolder(folder.path() / "a")), 0);
    EXPECT_EQ(codeOf(preflightFolder(folder.write("file", "x"))), 2);
}

TEST(Preflight, KeepsTheInput) {
    const TemporaryFolder folder;
    const std::filesystem::path mesh = folder.write("mesh.obj", "v 0 0 0");
    std::filesystem::create_symlink(mesh, folder.path() / "link.obj");
    EXPECT_EQ(codeOf(preflightDistinct(mesh, folder.path() / "." / "mesh.obj")), 1);
    EXPECT_EQ(codeOf(preflightDistinct(mesh, folder.path() / "link.obj")), 1);
    EXPECT_EQ(codeOf(preflightDistinct(mesh, folder.path() / "out.relief")), 0);
    EXPECT_EQ(codeOf(preflightDistinct("-", "-")), 0);
    EXPECT_EQ(codeOf(preflightDistinct("/dev/null", "/dev/null")), 0);
}

TEST(Preflight, KeepsOutputsApart) {
    const TemporaryFolder folder;
    const std::filesystem::path old = folder.write("old", "x");
    std::filesystem::create_symlink(old, folder.path() / "link");
    EXPECT_EQ(codeOf(preflightTwoOutputs(old, folder.path() / "link")), 1);
    EXPECT_EQ(codeOf(preflightTwoOutputs(folder.path() / "new", folder.path() / "." / "new")), 1);
    EXPECT_EQ(codeOf(preflightTwoOutputs("new", "./new")), 1);
    EXPECT_EQ(codeOf(preflightTwoOutputs(folder.path() / "new", folder.path() / "other")), 0);
    EXPECT_EQ(codeOf(preflightTwoOutputs("-", folder.path() / "new")), 0);
}

}  // namespace
}  // namespace relief::test
