// SPDX-License-Identifier: Apache-2.0
// Paths of a scene must stay in its folder, through any links and dots.
#include "formats/config/confined_path.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "tests/results.h"
#include "tests/temporary_folder.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

/// scenes/            the folder of the scene
///     a.relief  sub/b.relief  …links
/// scenes_too/c.relief
class ScenePaths : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(folder_ / "sub");
        fs::create_directories(base_ / "scenes_too");
        for (const char* name : {"scenes/a.relief", "scenes/sub/b.relief", "scenes_too/c.relief"}) {
            std::ofstream(base_ / name) << "x";
        }
    }
    void link(const fs::path& target, const char* name) { fs::create_symlink(target, folder_ / name); }
    void expectInside(const std::string& text) {
        const auto path = resolveInside(folder_, text);
        ASSERT_TRUE(path) << text << ": " << path.error().message;
        EXPECT_EQ(*path, folder_ / text);
    }
    void expectError(const std::string& text, const std::string& part) {
        relief::expectError(resolveInside(folder_, text), ErrorCode::kInvalidInput, part);
    }

    test::TemporaryFolder temporary_;
    fs::path base_ = temporary_.path();
    fs::path folder_ = base_ / "scenes";
};

TEST_F(ScenePaths, AcceptsFilesInTheFolderAndBelow) {
    for (const char* text :
         {"a.relief", "./a.relief", "sub/b.relief", "sub/../a.relief", "sub/./../sub/b.relief",
          "missing.relief", "missing/../a.relief", "..a", "a..", "../scenes/a.relief"}) {
        expectInside(text);
    }
}

TEST_F(ScenePaths, RejectsPathsThatClimbOut) {
    for (const char* text : {"..", "../a", "../scenes_too/c.relief", "sub/../../scenes_too/c.relief",
                             "missing/../../a", "sub/../..", "../../../../../../../../../../etc/passwd"}) {
        expectError(text, "leads out of the scene's folder");
    }
    expectError((folder_ / "a.relief").native(), "absolute");
    expectError("/", "absolute");
    expectError("", "names no file");
    expectError(std::string("a\0b", 3), "zero byte");
    expectError("../a\nb", "\\x0a");
}

TEST_F(ScenePaths, AcceptsLinksThatStayInside) {
    link("a.relief", "to_file");
    link("sub", "to_folder");
    link(folder_ / "sub", "to_folder_absolute");
    link("../scenes/sub", "out_and_in");
    link("missing", "dangling");
    for (const char* text : {"to_file", "to_folder/b.relief", "to_folder_absolute/b.relief",
                             "out_and_in/b.relief", "to_folder/../a.relief", "dangling"}) {
        expectInside(text);
    }
}

TEST_F(ScenePaths, RejectsLinksThatLeadOut) {
    link("../scenes_too/c.relief", "to_file");
    link("/etc/passwd", "to_etc");
    link(base_ / "scenes_too", "to_folder");
    link("to_folder", "to_link");
    fs::create_symlink("../..", folder_ / "sub/up");
    for (const char* text :
         {"to_file", "to_etc", "to_folder/c.relief", "to_link/c.relief", "sub/up/scenes_too/c.relief",
          "to_folder/missing", "to_folder/../scenes_too/c.relief"}) {
        expectError(text, "leads out");
    }
    // After a link to an outside folder, `..` resolves differently than in the text.
    link("/usr/share", "share");
    expectError("share/../a.relief", "leads out");
    // The target of a dangling link may exist by the time the path is opened.
    link(base_ / "scenes_too/missing", "dangling");
    link("dangling", "to_dangling");
    link("../nowhere", "relative");
    for (const char* text : {"dangling", "to_dangling", "relative", "relative/a", "sub/../dangling"}) {
        expectError(text, "leads out");
    }
    link("circle_b", "circle_a");
    link("circle_a", "circle_b");
    EXPECT_FALSE(resolveInside(folder_, "circle_a"));
}

// The folder's name may be a link, have a trailing slash, be empty, or not exist.
TEST_F(ScenePaths, AcceptsEveryNameOfTheFolder) {
    fs::create_directory_symlink(folder_, base_ / "alias");
    for (const fs::path& folder :
         {base_ / "alias", folder_ / "", folder_ / ".", folder_ / "sub/..", base_ / "none/"}) {
        EXPECT_TRUE(resolveInside(folder, "a.relief")) << folder;
        EXPECT_FALSE(resolveInside(folder, "../a.relief")) << folder;
    }
    EXPECT_EQ(*resolveInside("", "a.relief"), fs::path("a.relief"));
    EXPECT_FALSE(resolveInside("", "../a.relief"));
    EXPECT_TRUE(resolveInside("/", "a.relief"));
}

// A root permits one more folder, and no others; the scene's own folder stays permitted.
TEST_F(ScenePaths, ARootPermitsOneMoreFolder) {
    const fs::path root = base_ / "scenes_too";
    const auto resolved = required(resolveInside(folder_, "../scenes_too/c.relief", "scene", root));
    EXPECT_EQ(resolved, folder_ / "../scenes_too/c.relief");
    EXPECT_TRUE(resolveInside(folder_, "a.relief", "scene", root));
    EXPECT_TRUE(resolveInside(folder_, "../scenes/a.relief", "scene", root));
    EXPECT_TRUE(resolveInside(folder_, "../scenes_too/none/d.relief", "scene", base_));
    for (const char* text :
         {"../c.relief", "../scenes_tooth/c.relief", "../../x", "../scenes_too/../c.relief"}) {
        EXPECT_FALSE(resolveInside(folder_, text, "scene", root)) << text;
    }
    EXPECT_FALSE(resolveInside(folder_, root.native() + "/c.relief", "scene", root)) << "absolute";
    fs::create_symlink("../c.relief", root / "out");
    EXPECT_FALSE(resolveInside(folder_, "../scenes_too/out", "scene", root));
    link("../scenes_too/c.relief", "in");
    EXPECT_TRUE(resolveInside(folder_, "in", "scene", root));
    EXPECT_FALSE(resolveInside(folder_, "in"));
}

TEST_F(ScenePaths, RootsAreFoldersAndADashIsAFile) {
    EXPECT_EQ(*resolveInside("", "-"), fs::path("./-"));
    EXPECT_TRUE(checkRoot(folder_));
    for (const fs::path& none : {folder_ / "a.relief", folder_ / "none"}) {
        relief::expectError(checkRoot(none), ErrorCode::kIo);
    }
}

}  // namespace
}  // namespace relief
