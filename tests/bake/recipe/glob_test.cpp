// SPDX-License-Identifier: Apache-2.0
// Patterns of file names against what they should and should not match, and no way to make them slow.
#include "bake/recipe/glob.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

bool matches(const std::string& pattern, const std::string& path) {
    const Result<GlobPattern> parsed = GlobPattern::parse(pattern);
    EXPECT_TRUE(parsed) << pattern << ": " << parsed.error().message;
    return parsed && parsed->matches(path);
}

TEST(Glob, MatchesPartByPart) {
    for (const auto& [pattern, path] : {std::pair{"a.obj", "a.obj"},
                                        {"./a.obj", "a.obj"},
                                        {"*.obj", "a.obj"},
                                        {".*.obj", ".a.obj"},
                                        {"x/?.o*j", "x/a.obj"},
                                        {"[a-c].obj", "b.obj"},
                                        {"\\[a\\].obj", "[a].obj"},
                                        // Two stars are any number of folders.
                                        {"**/*.obj", "a.obj"},
                                        {"**/*.obj", "x/y/a.obj"},
                                        {"x/**/a.obj", "x/a.obj"},
                                        {"x/**/y/**/a.obj", "x/1/y/2/3/a.obj"},
                                        {"**/**/a.obj", "a.obj"}}) {
        EXPECT_TRUE(matches(pattern, path)) << pattern << " " << path;
    }
    for (const auto& [pattern, path] : {std::pair{"a.obj", "b/a.obj"},
                                        {"a.obj", "A.obj"},
                                        {"*.obj", "x/a.obj"},  // * crosses no folder
                                        {"*.obj", ".a.obj"},   // hidden
                                        {"[!a-c].obj", "b.obj"},
                                        {"[a].obj", "[a].obj"},
                                        {"x/*", "x"},
                                        {"x", "x/y"},
                                        {"x/**/y/**/a.obj", "x/1/2/3/a.obj"},
                                        {"**/a.obj", ".git/a.obj"},     // hidden
                                        {"x**/a.obj", "x/y/a.obj"}}) {  // within a part they are one *
        EXPECT_FALSE(matches(pattern, path)) << pattern << " " << path;
    }
}

// 64 times ** against 2,000 folders: by trying one way after the other this would never end.
TEST(Glob, NoPatternTakesForEver) {
    std::string pattern;
    std::string path;
    for (int i = 0; i < 31; ++i) {
        pattern += "**/a*a*a*a*/";
    }
    for (int i = 0; i < 2000; ++i) {
        path += "aaaaaaaaaaaa/";
    }
    EXPECT_FALSE(matches(pattern + "b", path + "c"));
    EXPECT_TRUE(matches(pattern + "b", path + "b"));
}

TEST(Glob, SaysWhatIsNoPattern) {
    for (const auto& [text, says] :
         std::vector<std::pair<std::string, const char*>>{{"", "names no file"},
                                                          {"./", "names no file"},
                                                          {"x/**/", "ends with **"},
                                                          {"x/**", "ends with **"},
                                                          {"/x", "absolute"},
                                                          {"x/../y", "upwards"},
                                                          {{"a\0b", 3}, "zero byte"}}) {
        const Result<GlobPattern> pattern = GlobPattern::parse(text);
        ASSERT_FALSE(pattern) << text;
        EXPECT_EQ(pattern.error().code, ErrorCode::kInvalidInput);
        EXPECT_NE(pattern.error().message.find(says), std::string::npos) << pattern.error().message;
    }
    std::string deep;
    for (int i = 0; i < 65; ++i) {
        deep += "a/";
    }
    EXPECT_EQ(GlobPattern::parse(deep + "b").error().code, ErrorCode::kLimit);
}

TEST(Glob, WalksFoldersOnceAndSorted) {
    const TemporaryFolder temporary;
    const fs::path& folder = temporary.path();
    for (const char* file : {"b.obj", "a.obj", "x/a.obj", "x/y/a.obj", "x.obj/no", ".h/a.obj", "x-/a.obj"}) {
        fs::create_directories((folder / file).parent_path());
        temporary.write(file, "x");
    }
    fs::create_symlink("a.obj", folder / "link.obj");
    fs::create_symlink("gone.obj", folder / "dangling.obj");
    fs::create_symlink("..", folder / "x/up.d");  // a circle for whoever follows it
    const Result<GlobResult> found = globFiles(folder, *GlobPattern::parse("**/*.obj"));
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(found->files,
              (std::vector<std::string>{"a.obj", "b.obj", "link.obj", "x-/a.obj", "x/a.obj", "x/y/a.obj"}));
    EXPECT_EQ(found->folders, (std::vector<std::string>{"", "x", "x-", "x.obj", "x/y"}));
    const Result<GlobResult> through = globFiles(folder, *GlobPattern::parse("x/up.d/*.obj"));
    ASSERT_TRUE(through);
    EXPECT_EQ(through->files.size(), 3U) << "a link that is named is followed";
    const Result<GlobResult> folders = globFiles(folder, *GlobPattern::parse("**/x*/"));
    ASSERT_TRUE(folders);
    EXPECT_EQ(folders->files, (std::vector<std::string>{"x", "x-", "x.obj"})) << "a slash at the end";
    EXPECT_TRUE(globFiles(folder, *GlobPattern::parse("a.obj/"))->files.empty());
    EXPECT_EQ(globFiles(folder / "gone", *GlobPattern::parse("*")).error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace relief::test
